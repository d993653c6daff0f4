// References that follow each other and lie close together, taken as one by a builder: fewer to sort and split.
#pragma once

#include "builders/parts/option_specs.h"

namespace boxwood::builders {

inline constexpr const char* kMergeMost = "merge.most";
inline constexpr const char* kMergeGrowth = "merge.growth";
inline constexpr const char* kMergeLeast = "merge.least";

inline constexpr OptionSpec kMergeMostOption{
    .key = kMergeMost,
    .description = "most references that are taken as one when they follow each other and lie close together; 1: none",
    .default_value = 1,
    .lowest = 1,
    .highest = 16,
    .integer = true};
inline constexpr OptionSpec kMergeGrowthOption{
    .key = kMergeGrowth,
    .description = "they lie close while the box around them has at most so many times the areas of their boxes, added",
    .default_value = 0.8,
    .lowest = 0,
    .highest = 1e6};
inline constexpr OptionSpec kMergeLeastOption{
    .key = kMergeLeast,
    .description = "least share of the references that this must save, going by a sample; else none are taken as one",
    .default_value = 0,
    .lowest = 0,
    .highest = 1};

/// The share of references that runs (see MergedRuns) save, by a few stretches of them, at even distances.
double sampled_saving(std::span<const refs::Reference> references, std::uint32_t most, double growth);

class MergedRuns {
 public:
  /// Takes runs of up to `most` references, each as long as the box around it has at most `growth` times the area of
  /// its references' boxes, added. Parts of one primitive are not put together again. O(n), parallel, the same runs for
  /// every number of threads. `numbered`: each reference's primitive has the reference's own number.
  MergedRuns(refs::ReferenceSet&& set, bool numbered, std::uint32_t most, double growth, Executor& executor);

  /// One reference for each run, over as many primitives.
  refs::ReferenceSet take_set() { return std::move(runs_); }
  std::size_t size() const { return first_.size() - 1; }
  double references_per_run() const { return double(first_[size()]) / double(size()); }
  /// From a tree over the runs to one over what they were made of.
  void expand(tree::BinaryTree& tree, Executor& executor) const;

 private:
  std::uint32_t length(std::uint32_t run) const { return first_[run + 1] - first_[run]; }

  refs::ReferenceSet runs_;
  std::size_t primitive_count_;
  AlignedBuffer<std::uint32_t> first_;       ///< of each run, and one more
  AlignedBuffer<std::uint32_t> primitives_;  ///< of each reference; empty: the reference's own number
};

}  // namespace boxwood::builders
