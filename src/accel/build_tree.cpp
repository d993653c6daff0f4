// References, their pre-split, the builder, the optimizer: the way to a binary tree, with the time of each step.
#include <chrono>

#include "boxwood/accel.h"

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

Result<tree::BinaryTree> build_steps(const MeshView& mesh, const TreePlan& plan, const builders::BuildContext& context,
                                     TreeReport& report, std::vector<std::uint32_t>* split) {
  Clock clock;
  auto references = refs::make_references(mesh, context.executor);
  if (!references) return references.error();
  report.excluded = references->excluded;
  report.reference_seconds = clock.lap();
  references = refs::apply_presplit(std::move(*references), mesh, plan.presplit, context.executor, &report.presplit);
  if (!references) return references.error();
  report.presplit_seconds = clock.lap();
  RepeatMarks marks(split ? references->primitive_count : 0);
  if (split)
    for (const refs::Reference& reference : references->references) marks.add(reference.primitive);
  auto tree = builders::build(std::move(*references), plan.build, context);
  if (!tree) return tree;
  report.builder_seconds = clock.lap();
  if (split) {
    marks.begin_list();
    for (const std::uint32_t primitive : tree->references) marks.add(primitive);
    *split = marks.take();
  }
  tree = optimizers::apply_optimizer(std::move(*tree), plan.optimizer, context.executor);
  report.optimizer_seconds = clock.lap();
  return tree;
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
