// References, their pre-split, the builder, the optimizer: the way to a binary tree, with the time of each step.
#include <chrono>

#include "boxwood/accel.h"
#include "boxwood/metrics.h"

namespace boxwood {
namespace {

class Clock {
 public:
  /// Seconds since the last call.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Which primitives occur more than once, in one list or another.
class RepeatMarks {
 public:
  explicit RepeatMarks(std::size_t primitives) : seen_(primitives), repeated_(primitives) {}
  void begin_list() { seen_.assign(seen_.size(), 0); }
  void add(std::uint32_t primitive) { (seen_[primitive] ? repeated_ : seen_)[primitive] = 1; }
  std::vector<std::uint32_t> take() { return std::move(repeated_); }

 private:
  std::vector<std::uint32_t> seen_, repeated_;
};

/// From references to an optimized tree.
class Steps {
 public:
  Steps(const MeshView& mesh, const TreePlan& plan, const builders::BuildContext& context, TreeReport& report)
      : mesh_(mesh), plan_(plan), context_(context), report_(report) {}

  Result<refs::ReferenceSet> references() {
    auto references = refs::make_references(mesh_, context_.executor);
    if (!references) return references;
    report_.excluded = references->excluded;
    report_.reference_seconds += clock_.lap();
    references =
        refs::apply_presplit(std::move(*references), mesh_, plan_.presplit, context_.executor, &report_.presplit);
    report_.presplit_seconds += clock_.lap();
    return references;
  }

  /// `split` as for build_tree.
  Result<tree::BinaryTree> tree(refs::ReferenceSet&& references, const builders::BuildOptions& build,
                                const builders::BuildContext& context, std::vector<std::uint32_t>* split) {
    RepeatMarks marks(split ? references.primitive_count : 0);
    if (split)
      for (const refs::Reference& reference : references.references) marks.add(reference.primitive);
    clock_.lap();
    auto tree = builders::build(std::move(references), build, context);
    if (!tree) return tree;
    report_.builder_seconds += clock_.lap();
    if (split) {
      marks.begin_list();
      for (const std::uint32_t primitive : tree->references) marks.add(primitive);
      *split = marks.take();
    }
    tree = optimizers::apply_optimizer(std::move(*tree), plan_.optimizer, context.executor);
    report_.optimizer_seconds += clock_.lap();
    return tree;
  }

 private:
  const MeshView& mesh_;
  const TreePlan& plan_;
  const builders::BuildContext& context_;
  TreeReport& report_;
  Clock clock_;
};

/// The part of a build from `from` on, `share` of the whole.
builders::BuildContext part_of(const builders::BuildContext& context, double from, double share) {
  builders::BuildContext part{context.executor, {}, context.cancel};
  if (context.progress) part.progress = [&context, from, share](double done) { context.progress(from + share * done); };
  return part;
}

Result<tree::BinaryTree> build_steps(const MeshView& mesh, const TreePlan& plan, const builders::BuildContext& context,
                                     TreeReport& report, std::vector<std::uint32_t>* split) {
  Steps steps(mesh, plan, context, report);
  auto references = steps.references();
  if (!references) return references.error();
  if (plan.second.builder.empty()) return steps.tree(std::move(*references), plan.build, context, split);

  // The trees are one after the other in memory, and references are made again rather than kept: they are cheap.
  auto first = steps.tree(std::move(*references), plan.build, part_of(context, 0, 0.7), split);
  if (!first || first->nodes.empty()) return first;
  references = steps.references();
  if (!references) return references.error();
  std::vector<std::uint32_t> second_split;
  auto second =
      steps.tree(std::move(*references), plan.second, part_of(context, 0.7, 0.3), split ? &second_split : nullptr);
  if (!second) return second;
  const double cost = metrics::surface_area_cost(*first, plan.cost);
  if (cost > 0) report.second_tree_cost = metrics::surface_area_cost(*second, plan.cost) / cost;
  if (report.kept_second_tree() && split) *split = std::move(second_split);
  auto& kept = report.kept_second_tree() ? *second : *first;
  kept.notes.emplace_back("cost of whole triangles by that of split ones", report.second_tree_cost);
  return std::move(kept);
}

}  // namespace

Result<tree::BinaryTree> build_tree(const MeshView& mesh, const TreePlan& plan, const builders::BuildContext& context,
                                    TreeReport* report, std::vector<std::uint32_t>* split) {
  try {
    TreeReport own;
    TreeReport& filled = report ? *report : own;
    filled = {};
    return build_steps(mesh, plan, context, filled, split);
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory,
            "not enough memory to build over " + std::to_string(mesh.triangle_count) + " triangles"};
  }
}

}  // namespace boxwood
