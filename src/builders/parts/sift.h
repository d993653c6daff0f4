// Sifting: the references of a range go to one side of a split or, cut, to both.
#pragma once

#include <utility>
#include <vector>

#include "builders/parts/splitting_driver.h"

namespace boxwood::builders {

/// What a reference becomes on both sides of a split; an empty box: nothing there.
struct Sides {
  Box left, right;

  static Sides only_left(const refs::Reference& reference) { return {reference.box(), {}}; }
  static Sides only_right(const refs::Reference& reference) { return {{}, reference.box()}; }
};

/// The references of both sides of a split, in the order of the input.
class SiftedReferences {
 public:
  /// Room for as many references is taken at once.
  SiftedReferences(std::size_t left, std::size_t right) {
    left_.reserve(left);
    right_.reserve(right);
  }

  void add(const refs::Reference& reference, const Sides& sides) {
    if (!sides.left.is_empty()) {
      left_.push_back({sides.left.lower, reference.primitive, sides.left.upper, 0});
      left_bounds_.grow(sides.left);
    }
    if (!sides.right.is_empty()) {
      right_.push_back({sides.right.lower, reference.primitive, sides.right.upper, 0});
      right_bounds_.grow(sides.right);
    }
  }

  void move_to(SplittingRange& left, SplittingRange& right) {
    left.references = std::move(left_), right.references = std::move(right_);
    left.bounds = left_bounds_, right.bounds = right_bounds_;
  }

  /// Puts chunks together in their order.
  static void join(std::vector<SiftedReferences>& chunks, Executor& executor, SplittingRange& left,
                   SplittingRange& right) {
    std::vector<std::size_t> left_begin, right_begin;
    std::size_t left_count = 0, right_count = 0;
    for (const SiftedReferences& chunk : chunks) {
      left_begin.push_back(left_count), right_begin.push_back(right_count);
      left_count += chunk.left_.size(), right_count += chunk.right_.size();
      left.bounds.grow(chunk.left_bounds_), right.bounds.grow(chunk.right_bounds_);
    }
    left.references.resize(left_count);
    right.references.resize(right_count);
    executor.for_chunks(chunks.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
      std::copy(chunks[i].left_.begin(), chunks[i].left_.end(), left.references.data() + left_begin[i]);
      std::copy(chunks[i].right_.begin(), chunks[i].right_.end(), right.references.data() + right_begin[i]);
      chunks[i] = SiftedReferences(0, 0);
    });
  }

 private:
  std::vector<refs::Reference> left_, right_;
  Box left_bounds_, right_bounds_;
};

/// Fills in references, bounds and spare of both sides and frees those of the range. `sides_of(reference)` gives the
/// Sides of one; it is called from several threads at once. About `left_count` and `right_count` are expected to come.
template <class SidesOf>
void sift(SplittingRange& range, std::size_t left_count, std::size_t right_count, Executor& executor,
          const SidesOf& sides_of, SplittingRange& left, SplittingRange& right) {
  const std::size_t count = range.size();
  const std::vector<refs::Reference> references = std::move(range.references);
  if (count <= kLargeRange) {
    SiftedReferences sifted(left_count, right_count);
    for (const refs::Reference& reference : references) sifted.add(reference, sides_of(reference));
    sifted.move_to(left, right);
  } else {
    std::vector<SiftedReferences> chunks((count + kChunk - 1) / kChunk, SiftedReferences(0, 0));
    executor.for_chunks(count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) chunks[chunk].add(references[i], sides_of(references[i]));
    });
    SiftedReferences::join(chunks, executor, left, right);
  }
  const SpareShares shares = share_rest(range.spare, count, left.size(), right.size());
  left.spare = shares.left, right.spare = shares.right;
}

}  // namespace boxwood::builders
