// From a mesh to something to query, step by step with the time of each: what Accel::build does in one call.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "boxwood/accel.h"
#include "boxwood/tree.h"
#include "input.h"
#include "session.h"

namespace boxwood::program {

/// --presplit, --builder, --set and --layout.
struct PipelineOptions {
  std::string builder = builders::BuildOptions{}.builder;
  std::vector<std::string> settings;  ///< key=value
  std::string layout = AccelOptions{}.layout;
  std::string presplit = AccelOptions{}.presplit;

  void add_to(CLI::App& command);
  Result<builders::BuildOptions> build_options() const;
};

/// --presplit; refuses what can't be read as wrong usage, before anything runs.
void add_presplit_option(CLI::App& command, std::string& presplit);

/// Makes --set take one key=value each time it is given.
void add_settings_option(CLI::App& command, std::vector<std::string>& settings);

struct BuiltTree {
  tree::BinaryTree tree;
  std::size_t excluded = 0;
  refs::PresplitReport presplit;
  double reference_seconds = 0, presplit_seconds = 0, tree_seconds = 0;

  double seconds() const { return reference_seconds + presplit_seconds + tree_seconds; }
};

/// References, their pre-split, then the tree. `split`, if any, gets a 1 for each primitive that now has several
/// references, by the pre-split or by the builder, and a 0 for the others.
Result<BuiltTree> build_tree(const MeshView& mesh, const refs::Presplit& presplit,
                             const builders::BuildOptions& options, Executor& executor,
                             const std::function<void(double)>& progress = {},
                             std::vector<std::uint8_t>* split = nullptr);

struct BuiltAccel {
  Accel accel;
  double encode_seconds = 0;
};
Result<BuiltAccel> encode_tree(const MeshView& mesh, const tree::BinaryTree& tree, const std::string& layout,
                               const std::shared_ptr<Executor>& executor);

/// Everything a sub-command that only wants to ask rays needs.
struct Pipeline {
  Accel accel;
  std::size_t excluded = 0;
  refs::PresplitReport presplit;
  double build_seconds = 0;
  std::vector<std::pair<std::string, std::string>> echo;  ///< resolved options, builder and layout first
};
/// Builds with a progress bar; warns about excluded triangles; notes what it did. `split` as for build_tree.
Result<Pipeline> run_pipeline(const Input& input, const PipelineOptions& options, const Session& session,
                              std::vector<std::uint8_t>* split = nullptr);

/// The resolved options with builder, pre-split and layout in front: what reports echo.
Result<std::vector<std::pair<std::string, std::string>>> echo_options(const builders::BuildOptions& options,
                                                                      const refs::Presplit& presplit,
                                                                      const std::string& layout);

}  // namespace boxwood::program
