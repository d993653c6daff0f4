// The registry of optimizers of binary trees, its text form, and the entry that runs one.
#include <new>

#include "base/method_text.h"
#include "boxwood/optimizers.h"

namespace boxwood::optimizers {
namespace {

constexpr OptimizerInfo kNone = {
    .id = "none",
    .summary = "the tree as its builder made it",
    .paper = "",
    .options = {},
    .apply = nullptr,
};

Result<tree::BinaryTree> run_reinsertion(tree::BinaryTree&& tree, const Optimizer& optimizer, Executor& executor) {
  ReinsertionOptions options;
  options.passes = static_cast<int>(optimizer.value("passes"));
  options.share = static_cast<float>(optimizer.value("share"));
  options.least_gain = static_cast<float>(optimizer.value("gain"));
  ReinsertionReport report;
  auto result = reinsert(std::move(tree), options, executor, &report);
  if (!result) return result;
  result->notes.emplace_back("reinsertion: passes", report.passes);
  result->notes.emplace_back("reinsertion: moves", static_cast<double>(report.moves));
  result->notes.emplace_back("reinsertion: area of inner nodes after over before",
                             report.price_before > 0 ? report.price_after / report.price_before : 1);
  return result;
}

constexpr OptimizerOption kReinsertionOptions[] = {
    {"passes", "passes, at most", 16, 0, kMostReinsertionPasses, true},
    {"share", "part of the nodes, those of the largest boxes, that a pass looks for better places of", 0.25, 0.001, 1,
     false},
    {"gain", "passes end after one that takes less than this part off the area of all inner nodes", 0.005, 0, 1,
     false}};

constexpr OptimizerInfo kReinsertion = {
    .id = "reinsertion",
    .summary = "puts subtrees where the tree costs less, again and again; best for trees that are traced for long",
    .paper = "bittner2013, meister2018",
    .options = kReinsertionOptions,
    .apply = &run_reinsertion,
};

}  // namespace

std::span<const OptimizerInfo> optimizer_registry() {
  static constexpr OptimizerInfo rows[] = {kNone, kReinsertion};
  return rows;
}

Optimizer::Optimizer() : info(&optimizer_registry()[0]) {}

double Optimizer::value(std::string_view key) const {
  return method_value(*info, values, key);
}

std::string Optimizer::text() const {
  return method_text(*info, values);
}

Result<Optimizer> parse_optimizer(std::string_view text) {
  try {
    auto parsed = MethodParser<OptimizerInfo>("optimizer", optimizer_registry()).parse(text);
    if (!parsed) return parsed.error();
    Optimizer optimizer;
    optimizer.info = parsed->row;
    optimizer.values = std::move(parsed->values);
    return optimizer;
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory, "out of memory while reading an optimizer"};
  }
}

Result<tree::BinaryTree> apply_optimizer(tree::BinaryTree&& tree, const Optimizer& optimizer, Executor& executor) {
  if (optimizer.is_none()) return std::move(tree);
  return optimizer.info->apply(std::move(tree), optimizer, executor);
}

}  // namespace boxwood::optimizers
