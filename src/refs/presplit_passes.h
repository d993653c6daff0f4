// What all pre-splits share: one pass that counts parts, one that writes them, each parallel over fixed chunks of
// references and joined in their order, so that the result does not depend on threads.
//
// A splitter is called as splitter(reference, sink) and gives the sink each part's box (`part`, in a fixed order) and
// each cut (`cut`: the box that was cut and those of its two parts). It asks sink.is_full() between parts.
#pragma once

#include <algorithm>
#include <atomic>
#include <vector>

#include "boxwood/refs.h"

namespace boxwood::refs {

inline constexpr std::size_t kPresplitChunk = 1 << 12;
inline constexpr std::size_t kMostParts = (std::size_t{1} << 31) - 1;

/// In double precision: neither overflows nor vanishes for any usable mesh.
inline double box_area(const Box& box) {
  const double x = double(box.upper.x) - box.lower.x, y = double(box.upper.y) - box.lower.y,
               z = double(box.upper.z) - box.lower.z;
  return 2 * (x * y + y * z + z * x);
}
inline double box_volume(const Box& box) {
  return (double(box.upper.x) - box.lower.x) * (double(box.upper.y) - box.lower.y) *
         (double(box.upper.z) - box.lower.z);
}

class CountingSink {
 public:
  explicit CountingSink(std::size_t limit) : limit_(limit) {}
  void part(const Box&) { ++count_; }
  void cut(const Box&, const Box&, const Box&) {}
  bool is_full() const { return count_ > limit_; }
  std::size_t count() const { return count_; }

 private:
  std::size_t count_ = 0, limit_;
};

/// Writes references and sums up what a PresplitReport says of them.
class WritingSink {
 public:
  struct Sums {
    double area_before = 0, area_after = 0, factors = 0;
    double best = kInfinity, worst = 0;
    std::size_t splits = 0, measured = 0;

    void add(const Sums& other) {
      area_before += other.area_before, area_after += other.area_after, factors += other.factors;
      best = std::min(best, other.best), worst = std::max(worst, other.worst);
      splits += other.splits, measured += other.measured;
    }
  };

  explicit WritingSink(Reference* out) : out_(out) {}
  void begin(const Reference& whole) {
    primitive_ = whole.primitive;
    sums_.area_before += box_area(whole.box());
  }
  void part(const Box& box) {
    *out_++ = {box.lower, primitive_, box.upper, 0};
    sums_.area_after += box_area(box);
  }
  void cut(const Box& whole, const Box& first, const Box& second) {
    ++sums_.splits;
    const double area = box_area(whole);
    if (!(area > 0)) return;
    for (const Box& box : {first, second}) {
      const double factor = box_area(box) / area;
      sums_.factors += factor;
      sums_.best = std::min(sums_.best, factor);
      sums_.worst = std::max(sums_.worst, factor);
      ++sums_.measured;
    }
  }
  bool is_full() const { return false; }
  const Sums& sums() const { return sums_; }

 private:
  Reference* out_;
  std::uint32_t primitive_ = 0;
  Sums sums_;
};

/// Parts of each chunk. Stops early, with a sum above `limit`, once there are more than `limit` parts.
template <class Splitter>
std::vector<std::size_t> count_parts(const ReferenceSet& set, const Splitter& splitter, Executor& executor,
                                     std::size_t limit) {
  const std::size_t references = set.references.size();
  std::vector<std::size_t> counts((references + kPresplitChunk - 1) / kPresplitChunk);
  // Only whether the total passes the limit matters, and that does not depend on the order of the additions.
  std::atomic<std::size_t> total = 0;
  executor.for_chunks(references, kPresplitChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    if (total.load(std::memory_order_relaxed) > limit) return;
    CountingSink sink(limit);
    for (std::size_t i = begin; i < end && !sink.is_full(); ++i) splitter(set.references[i], sink);
    counts[chunk] = sink.count();
    total.fetch_add(sink.count(), std::memory_order_relaxed);
  });
  return counts;
}

inline std::size_t sum_of(const std::vector<std::size_t>& counts) {
  std::size_t sum = 0;
  for (const std::size_t count : counts) sum += count;
  return sum;
}

template <class Splitter>
Status split_references(ReferenceSet& set, const Splitter& splitter, Executor& executor, PresplitReport& report) {
  const std::vector<std::size_t> counts = count_parts(set, splitter, executor, kMostParts);
  const std::size_t total = sum_of(counts);
  if (total > kMostParts)
    return {ErrorCode::too_large, "a pre-split would make more than " + std::to_string(kMostParts) + " references of " +
                                      std::to_string(set.references.size())};
  std::vector<std::size_t> first(counts.size());
  for (std::size_t i = 1; i < counts.size(); ++i) first[i] = first[i - 1] + counts[i - 1];
  AlignedBuffer<Reference> parts(total);
  std::vector<WritingSink::Sums> sums(counts.size());
  executor.for_chunks(set.references.size(), kPresplitChunk,
                      [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                        WritingSink sink(parts.data() + first[chunk]);
                        for (std::size_t i = begin; i < end; ++i) {
                          sink.begin(set.references[i]);
                          splitter(set.references[i], sink);
                        }
                        sums[chunk] = sink.sums();
                      });
  WritingSink::Sums all;
  for (const WritingSink::Sums& chunk : sums) all.add(chunk);
  report.area_before = all.area_before;
  report.area_after = all.area_after;
  report.splits = all.splits;
  if (all.measured > 0) {
    report.best_factor = all.best;
    report.average_factor = all.factors / static_cast<double>(all.measured);
    report.worst_factor = all.worst;
  }
  set.references = std::move(parts);
  return {};
}

}  // namespace boxwood::refs
