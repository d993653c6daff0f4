// The entry of all builds: checks what the builders rely on, then runs one.
#include "builders/build.h"

#include <algorithm>
#include <cassert>

#include "builders/parts/box4.h"
#include "builders/parts/merged_runs.h"
#include "builders/parts/option_specs.h"

namespace boxwood::builders {
namespace {

constexpr std::size_t kChunk = 1 << 14;

/// All bits in lanes 0 to 2 where the box holds something and can be calculated with.
Float4 is_usable(const Box4& box) {
  return at_most(Float4::fill(-kLargestCoordinate), box.lower) & at_most(box.lower, box.upper) &
         at_most(box.upper, Float4::fill(kLargestCoordinate));
}

bool is_usable(const refs::Reference& reference, std::size_t primitive_count) {
  return reference.primitive < primitive_count && all_set(is_usable(Box4::of(reference)));
}

struct Checked {
  std::size_t first_bad = SIZE_MAX;  ///< reference that can't be used
  bool increasing = true;            ///< primitive ids grow from each reference to the next
};

Checked check_references(const refs::ReferenceSet& set, Executor& executor) {
  const std::span<const refs::Reference> references = set.references.span();
  std::vector<Checked> chunks((references.size() + kChunk - 1) / kChunk);
  executor.for_chunks(references.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    Checked checked;
    Float4 usable = Float4::fill_bits(~0u);
    std::uint32_t largest = 0;
    std::int64_t previous = begin == 0 ? -1 : std::int64_t(references[begin - 1].primitive);
    for (std::size_t i = begin; i < end; ++i) {
      usable = usable & is_usable(Box4::of(references[i]));
      const std::uint32_t primitive = references[i].primitive;
      largest = std::max(largest, primitive);
      checked.increasing &= previous < std::int64_t(primitive);
      previous = primitive;
    }
    if (!all_set(usable) || largest >= set.primitive_count)
      for (checked.first_bad = begin; is_usable(references[checked.first_bad], set.primitive_count);)
        ++checked.first_bad;
    chunks[chunk] = checked;
  });
  Checked all;
  for (const Checked& checked : chunks) {
    all.first_bad = std::min(all.first_bad, checked.first_bad);
    all.increasing &= checked.increasing;
  }
  return all;
}

Error bad_reference(const refs::ReferenceSet& set, std::size_t bad) {
  const std::string where = "reference " + std::to_string(bad);
  const std::uint32_t primitive = set.references[bad].primitive;
  if (primitive >= set.primitive_count)
    return {ErrorCode::malformed, where + " names primitive " + std::to_string(primitive) + " of only " +
                                      std::to_string(set.primitive_count)};
  return {ErrorCode::malformed, where + " (primitive " + std::to_string(primitive) +
                                    ") has a box that is empty, not finite or beyond +-1e18"};
}

/// Is a primitive named more than once, as the parts that a pre-split makes are?
bool has_repeats(const refs::ReferenceSet& set) {
  std::vector<bool> seen(set.primitive_count);
  for (const refs::Reference& reference : set.references) {
    if (seen[reference.primitive]) return true;
    seen[reference.primitive] = true;
  }
  return false;
}

/// How many references may be taken as one: no more than a leaf may have, and just one where that saves too few.
std::uint32_t merge_most(const OptionValues& options, std::span<const refs::Reference> references) {
  if (!options.has(kMergeMost)) return 1;
  const std::uint32_t leaf_max = options.integer(kLeafMax), wanted = options.integer(kMergeMost);
  const std::uint32_t most = leaf_max == 0 ? wanted : std::min(wanted, leaf_max);
  const double least = options.number(kMergeLeast);
  if (most > 1 && least > 0 && sampled_saving(references, most, options.number(kMergeGrowth)) < least) return 1;
  return most;
}

/// Builds over runs of references, each at the price and size of the references in it.
Result<tree::BinaryTree> build_over_runs(const BuilderInfo& info, refs::ReferenceSet&& references, bool numbered,
                                         OptionValues options, std::uint32_t most, const BuildContext& context) {
  MergedRuns runs(std::move(references), numbered, most, options.number(kMergeGrowth), context.executor);
  options.set("cost.intersection", options.number("cost.intersection") * runs.references_per_run());
  options.set(kLeafMax, options.integer(kLeafMax) / most);
  auto tree = info.build(runs.take_set(), options, context);
  if (!tree) return tree;
  runs.expand(*tree, context.executor);
  tree->notes.emplace_back("references after merging", double(runs.size()));
  return tree;
}

#ifndef NDEBUG
std::vector<Box> boxes_by_primitive(const refs::ReferenceSet& set) {
  std::vector<Box> boxes(set.primitive_count);
  for (const refs::Reference& reference : set.references) boxes[reference.primitive].grow(reference.box());
  return boxes;
}
#endif

Result<tree::BinaryTree> build_checked(refs::ReferenceSet&& references, const BuildOptions& options,
                                       const BuildContext& context) {
  const Result<OptionValues> values = resolve_options(options.builder, options.settings);
  if (!values) return values.error();
  const BuilderInfo& info = *find(options.builder);
  if (const Status status = check_size(info, references); !status) return status.error();
  if (references.references.empty()) {
    tree::BinaryTree empty;
    empty.primitive_count = references.primitive_count;
    empty.splits_references = info.splits_references;
    return empty;
  }
  const Checked checked = check_references(references, context.executor);
  if (checked.first_bad != SIZE_MAX) return bad_reference(references, checked.first_bad);
  const bool repeats = !checked.increasing && has_repeats(references);
#ifndef NDEBUG
  const std::vector<Box> boxes = boxes_by_primitive(references);
#endif
  if (!references.primitives) references.primitives = refs::box_primitives();
  const std::uint32_t most = merge_most(*values, references.references.span());
  const bool numbered = checked.increasing && references.references[references.references.size() - 1].primitive + 1 ==
                                                  references.references.size();
  Result<tree::BinaryTree> tree = most > 1
                                      ? build_over_runs(info, std::move(references), numbered, *values, most, context)
                                      : info.build(std::move(references), *values, context);
  if (tree) {
    tree->splits_references |= repeats;
    if (tree->splits_references) tree::remove_duplicates(*tree);
    assert(repeats || tree::validate(*tree, {.primitive_boxes = boxes}));
  }
  return tree;
}

}  // namespace

Status check_size(const BuilderInfo& info, const refs::ReferenceSet& set) {
  const std::size_t count = set.references.size();
  if (count > info.largest_sensible)
    return {ErrorCode::too_large, "builder '" + std::string(info.id) + "' takes at most " +
                                      std::to_string(info.largest_sensible) + " references, not " +
                                      std::to_string(count)};
  if (set.primitive_count > kMostReferences)
    return {ErrorCode::too_large, "a set of references is over at most " + std::to_string(kMostReferences) +
                                      " primitives, not " + std::to_string(set.primitive_count)};
  return {};
}

Result<tree::BinaryTree> build(refs::ReferenceSet&& references, const BuildOptions& options,
                               const BuildContext& context) {
  try {
    return build_checked(std::move(references), options, context);
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory, "out of memory while builder '" + options.builder + "' was at work"};
  }
}

}  // namespace boxwood::builders
