// From a mesh to something to query, with the time of each step: what Accel::build does in one call.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "boxwood/accel.h"
#include "boxwood/tree.h"
#include "input.h"
#include "session.h"

namespace boxwood::program {

using Echo = std::vector<std::pair<std::string, std::string>>;

/// --builder, --set, --presplit, --optimizer and --layout.
struct PipelineOptions {
  std::string builder = AccelOptions{}.build.builder;
  std::vector<std::string> settings;  ///< key=value
  std::string layout = AccelOptions{}.layout;
  std::string presplit, optimizer;  ///< empty: the quality level's

  void add_to(CLI::App& command);
  Result<TreePlan> plan() const;
};

/// --presplit; refuses what can't be read as wrong usage, before anything runs.
void add_presplit_option(CLI::App& command, std::string& presplit);
/// The same for several, one each time it is given.
void add_presplit_option(CLI::App& command, std::vector<std::string>& presplits);

/// The same for --optimizer.
void add_optimizer_option(CLI::App& command, std::string& optimizer);
void add_optimizer_option(CLI::App& command, std::vector<std::string>& optimizers);

/// Makes --set take one key=value each time it is given.
void add_settings_option(CLI::App& command, std::vector<std::string>& settings);

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
  Echo echo;              ///< resolved options, builder and layout first
  tree::BinaryTree tree;  ///< what the accel was made of
};
/// Builds with a progress bar; warns about excluded triangles; notes what it did. `split` as for
/// boxwood::build_tree.
Result<Pipeline> run_pipeline(const Input& input, const PipelineOptions& options, const Session& session,
                              std::vector<std::uint32_t>* split = nullptr);

/// The resolved options with level, builder, pre-split, optimizer and layout in front: what reports echo.
Echo echo_options(const TreePlan& plan, const std::string& layout);

}  // namespace boxwood::program
