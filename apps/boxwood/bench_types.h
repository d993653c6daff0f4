// The words of boxwood bench: what runs (contestants), over what (ray sets), and what came out (rows).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "boxwood/accel.h"
#include "boxwood/render.h"
#include "camera.h"
#include "embree/embree_rival.h"
#include "input.h"
#include "session.h"
#include "tree_measures.h"

namespace boxwood::program {

/// Median, smallest and largest of repeated measurements.
struct Spread {
  double median = 0, lowest = 0, highest = 0;
};
Spread spread_of(std::vector<double> values);

enum class RayKind { primary, random, diffuse, occlusion, lines };
const char* name(RayKind kind);
/// Occlusion rays ask for any hit, all others for the closest.
inline bool asks_any(RayKind kind) {
  return kind == RayKind::occlusion;
}

struct RivalChoice {
  rivals::EmbreeQuality quality;
};

/// The checked options of one run.
struct BenchPlan {
  std::vector<builders::BuildOptions> builders;    ///< or quality levels
  std::vector<std::string> presplits, optimizers;  ///< each with every builder; empty: the quality level's
  std::vector<std::string> layouts;
  std::vector<queries::Mode> modes;
  std::vector<queries::TraversalOptions> traversals;  ///< each for the layouts that have it; terminating ones first
  std::vector<RayKind> kinds;
  std::vector<RivalChoice> rivals;
  std::string rival_version;  ///< "Embree 3.13.5"; empty without rivals
  std::optional<Camera> camera;
  int width = 0, height = 0;
  std::size_t random_rays = 0;
  std::uint64_t seed = 1;
  int repeat = 3;
  bool measures_trees = false;     ///< fill in BuildFigures::measures
  std::vector<int> thread_counts;  ///< 1, and all when that is more
};

/// Runs on whichever executor is set: one Accel can so be measured with one thread and with all.
class SwitchedExecutor final : public Executor {
 public:
  explicit SwitchedExecutor(std::shared_ptr<Executor> executor) : executor_(std::move(executor)) {}
  /// Not while something runs.
  void set(std::shared_ptr<Executor> executor) { executor_ = std::move(executor); }

  void for_chunks(std::size_t count, std::size_t chunk_size,
                  FunctionRef<void(std::size_t, std::size_t, std::size_t)> f) override {
    executor_->for_chunks(count, chunk_size, f);
  }
  void invoke(FunctionRef<void()> a, FunctionRef<void()> b) override { executor_->invoke(a, b); }
  int threads() const noexcept override { return executor_->threads(); }

 private:
  std::shared_ptr<Executor> executor_;
};

/// What building gave, for one builder and layout or one rival.
struct BuildFigures {
  std::vector<std::vector<double>> milliseconds;  ///< per thread count of the plan, one value per repeat
  std::size_t bytes = 0;
  // Not known of rivals:
  std::optional<double> surface_area_cost;
  std::size_t nodes = 0, leaves = 0, references = 0, max_depth = 0, max_leaf = 0;
  std::uint64_t hash = 0;
  tree::CostModel cost;  ///< that surface_area_cost is in
  std::optional<TreeMeasures> measures;
};

/// One thing that traces: ours (accel) or a rival's (embree).
struct Contestant {
  std::string builder, presplit, optimizer, layout;  ///< the builder or level as it was named
  queries::Mode mode = queries::Mode::robust;
  std::shared_ptr<BuildFigures> build;
  std::shared_ptr<const Accel> accel;
  std::shared_ptr<const rivals::EmbreeRival> embree;
  queries::TraversalOptions traversal;

  /// Rays that go through the tree together.
  std::size_t packet_size() const;
  bool is_rival() const { return embree != nullptr; }
};

struct RaySet {
  RayKind kind;
  std::vector<Ray> rays;
  std::uint64_t hash = 0;
};

/// One measured line: a contestant, a ray kind and a number of threads.
struct Row {
  const Contestant* contestant = nullptr;
  RayKind kind = RayKind::primary;
  std::size_t thread_index = 0;  ///< into the plan's thread counts
  std::size_t rays = 0, hits = 0;
  Spread mrays;
  std::optional<double> nodes_per_ray, packet_nodes_per_ray, primitives_per_ray;
  std::size_t disagreements = 0;
  std::string first_disagreement;
  std::optional<double> ratio;  ///< Mrays/s over that of the first rival of the same mode
};

/// Everything measured over one input.
struct BenchResult {
  const Input* input = nullptr;
  View view;
  std::vector<Contestant> contestants;
  std::vector<RaySet> ray_sets;
  std::vector<Row> rows;
};

}  // namespace boxwood::program
