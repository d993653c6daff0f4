// What the tables are made of: trees and what rays cost on them. Results are kept, so that tables share them.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "boxwood/accel.h"
#include "boxwood/refs.h"
#include "input.h"
#include "session.h"

namespace boxwood::program::reproduce {

/// A way to build a tree: a builder with settings over what a pre-split makes of the mesh.
struct Method {
  std::string builder;
  std::map<std::string, std::string> settings = {};
  std::string presplit = "none";
  std::string layout = "linear";

  /// Text that tells it from others.
  std::string key() const;
};

/// A mesh to measure on, and what the tables call it.
struct Subject {
  std::shared_ptr<const Input> input;
  std::string label;
  std::string paper_scene;  ///< the paper's scene that it is or stands in for; empty: none
};

enum class Rays { primary, random, lines };

struct BuildResult {
  double milliseconds = 0;  ///< references, pre-split and tree, all threads; median
  double surface_area_cost = 0;
  std::size_t references = 0, primitives = 0;
  std::size_t bytes = 0;  ///< of the layout
  std::size_t max_depth = 0;
};

struct TraceResult {
  double nodes = 0, primitives = 0;  ///< per ray
  double mrays = 0;                  ///< median, one thread

  /// The paper's cost of a ray: visits and tests at C_T = 2, C_I = 3 in units of C_T.
  double cost() const { return nodes + 1.5 * primitives; }
};

/// Settings of the whole run.
struct Effort {
  bool slow = false;              ///< also what takes longer than kSlowSeconds
  int width = 512, height = 512;  ///< of the pictures whose primary rays are traced
  std::size_t random_rays = 1u << 18;
  int repeat = 3;
  std::uint64_t seed = 1;
};

/// Cells that would take longer are left out unless asked for.
inline constexpr double kSlowSeconds = 300;

/// A subject turned about its centre by degrees around x, y, z, with the view.
Subject rotated(const Subject& subject, Vec3 degrees, Executor& executor);

class Laboratory {
 public:
  Laboratory(const Session& session, const Effort& effort) : session_(session), effort_(effort) {}

  const Effort& effort() const { return effort_; }
  const Session& session() const { return session_; }
  /// Not empty: why this build is left out, with what it would take.
  std::string left_out(const Subject& subject, const Method& method) const;
  Result<BuildResult> build(const Subject& subject, const Method& method);
  /// Builds the short ones of the methods again, in turns, so that what slows the machine for a while slows all of
  /// them: `build` gives the medians of these from then on. At least the effort's `repeat` rounds, more of short ones.
  Status time_builds_in_turns(const Subject& subject, const std::vector<Method>& methods);
  Result<TraceResult> trace(const Subject& subject, const Method& method, Rays rays,
                            const queries::TraversalOptions& traversal = {});
  /// End-point overlap of the tree (Aila, Karras and Laine 2013).
  Result<double> end_point_overlap(const Subject& subject, const Method& method);

 private:
  struct Tree {
    std::string key;
    tree::BinaryTree tree;
    std::optional<Accel> accel;
  };
  /// From the latest ones, or built now.
  Result<const Tree*> tree(const Subject& subject, const Method& method);
  Result<std::vector<Ray>> make_rays(const Subject& subject, Rays rays) const;

  const Session& session_;
  Effort effort_;
  std::map<std::string, BuildResult> builds_;
  std::map<std::string, TraceResult> traces_;
  std::map<std::string, double> overlaps_;
  std::vector<std::unique_ptr<Tree>> trees_;  ///< the latest ones
  std::string rays_key_;
  std::vector<Ray> rays_;
};

}  // namespace boxwood::program::reproduce
