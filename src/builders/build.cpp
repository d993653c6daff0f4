// The entry of all builds: checks what the builders rely on, then runs one.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "boxwood/builders.h"

namespace boxwood::builders {
namespace {

constexpr std::size_t kChunk = 1 << 16;

/// A box that holds something and can be calculated with.
bool is_usable(const refs::Reference& reference, std::size_t primitive_count) {
  bool usable = reference.primitive < primitive_count;
  for (int axis = 0; axis < 3; ++axis)
    usable &= -kLargestCoordinate <= reference.lower[axis] && reference.lower[axis] <= reference.upper[axis] &&
              reference.upper[axis] <= kLargestCoordinate;
  return usable;
}

Status check_references(const refs::ReferenceSet& set, Executor& executor) {
  const std::span<const refs::Reference> references = set.references.span();
  std::vector<std::size_t> first_bad((references.size() + kChunk - 1) / kChunk, references.size());
  executor.for_chunks(references.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (is_usable(references[i], set.primitive_count)) continue;
      first_bad[chunk] = i;
      return;
    }
  });
  const std::size_t bad = *std::min_element(first_bad.begin(), first_bad.end());
  if (bad == references.size()) return {};
  const std::string where = "reference " + std::to_string(bad);
  const std::uint32_t primitive = references[bad].primitive;
  if (primitive >= set.primitive_count)
    return {ErrorCode::malformed, where + " names primitive " + std::to_string(primitive) + " of only " +
                                      std::to_string(set.primitive_count)};
  return {ErrorCode::malformed, where + " (primitive " + std::to_string(primitive) +
                                    ") has a box that is empty, not finite or beyond +-1e18"};
}

/// Does the set name a primitive more than once, as the parts that a pre-split makes do?
bool has_repeats(const refs::ReferenceSet& set) {
  const std::span<const refs::Reference> references = set.references.span();
  const auto not_increasing = [](const refs::Reference& a, const refs::Reference& b) {
    return a.primitive >= b.primitive;
  };
  if (std::adjacent_find(references.begin(), references.end(), not_increasing) == references.end()) return false;
  std::vector<bool> seen(set.primitive_count);
  for (const refs::Reference& reference : references) {
    if (seen[reference.primitive]) return true;
    seen[reference.primitive] = true;
  }
  return false;
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
  const std::size_t count = references.references.size();
  if (count > info.largest_sensible)
    return {ErrorCode::too_large, "builder '" + std::string(info.id) + "' takes at most " +
                                      std::to_string(info.largest_sensible) + " references, not " +
                                      std::to_string(count)};
  if (count == 0) {
    tree::BinaryTree empty;
    empty.primitive_count = references.primitive_count;
    empty.splits_references = info.splits_references;
    return empty;
  }
  if (const Status status = check_references(references, context.executor); !status) return status.error();
  const bool repeats = has_repeats(references);
#ifndef NDEBUG
  const std::vector<Box> boxes = boxes_by_primitive(references);
#endif
  Result<tree::BinaryTree> tree = info.build(std::move(references), *values, context);
  if (tree) {
    tree->splits_references |= repeats;
    assert(repeats || tree::validate(*tree, {.primitive_boxes = boxes}));
  }
  return tree;
}

}  // namespace

Result<tree::BinaryTree> build(refs::ReferenceSet&& references, const BuildOptions& options,
                               const BuildContext& context) {
  try {
    return build_checked(std::move(references), options, context);
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory, "out of memory while builder '" + options.builder + "' was at work"};
  }
}

}  // namespace boxwood::builders
