// The batch engine: how a stream of rays is cut into packets, rays in flight and single rays. docs/batches.md has what
// is chosen when, and the measurements behind it.
#pragma once

#include <atomic>
#include <span>

#include "boxwood/queries.h"
#include "queries/kernels/batch.h"

namespace boxwood::queries {

/// The ways a batch can go; `batch` has no packets and no rays in flight on layouts that lack them.
struct BatchMethods {
  Kernels single{};
  BatchKernels batch{};
  bool has_batch = false;
};
/// Errors: those of select_kernels.
Result<BatchMethods> select_batch(layouts::LayoutId layout, Mode mode, std::string_view isa);

/// Is this one of the traversals that trace_batch has (on layouts for which check_traversal allows it)?
constexpr bool is_batch(Traversal traversal) {
  return traversal == Traversal::batch || traversal == Traversal::coherent || traversal == Traversal::interleaved ||
         traversal == Traversal::sorted;
}

/// How a stream is cut, the same for every number of threads.
struct BatchCut {
  std::size_t row = 0;  ///< rays in a row of the picture that they come from; 0: none found
  std::size_t chunk = 0;
};
/// Looks at a few hundred rays of the stream. Deterministic.
BatchCut cut_batch(const BatchMethods& methods, std::span<const Ray> rays, Traversal traversal);

/// Which way through incoherent rays is faster, in flight or one by one: that depends on the tree, the rays and the
/// processor's caches, and answers do not depend on it. So now and then some rays go each way, against the clock. What
/// is found holds from one call to the next: short calls could not afford to find it out. Safe to share by threads.
class FasterWay {
 public:
  /// Trials that follow each other soon, in the first calls and at the beginning of long ones.
  static constexpr std::uint32_t kFirstTrials = 4;

  /// A call with so many rays begins. They may be of another kind than the last ones: one with many asks again at once.
  void begin_call(std::size_t rays);
  /// Is it time to try both ways? `rays` are traced next, in any case.
  bool try_both(std::size_t rays);
  /// What both ways took for as many rays each, any unit.
  void record(double in_flight, double single);
  bool is_in_flight() const { return log_ratio_.load(std::memory_order_relaxed) < 0; }

 private:
  std::atomic<std::size_t> until_trial_{0};  ///< rays
  std::atomic<std::uint32_t> early_trials_{kFirstTrials};
  std::atomic<float> log_ratio_{-0.15f};  ///< of time in flight over time one by one, base 2, mostly of the last trials
  std::atomic<float> next_weight_{1.0f};  ///< of the next trial in that mean
};

/// Where the answers go: for a closest hit `hits` and perhaps `normals`, else `occluded`.
struct BatchAnswers {
  Hit* hits = nullptr;
  Vec3* normals = nullptr;
  std::uint8_t* occluded = nullptr;

  bool any() const { return occluded != nullptr; }
  BatchAnswers from(std::size_t begin) const {
    return {hits ? hits + begin : nullptr, normals ? normals + begin : nullptr, occluded ? occluded + begin : nullptr};
  }
};

/// Traces one chunk. Memory is allocated for rays that are copied together, some 40 KB, and by `sorted`, in proportion
/// to the chunk. Throws std::bad_alloc.
void trace_batch(const BatchMethods& methods, const layouts::Layout& layout, Traversal traversal, std::size_t row,
                 FasterWay& faster_way, std::span<const Ray> rays, const BatchAnswers& answers);

/// Puts rays that start in the same place and go the same way next to each other: by octant, Morton code of the origin
/// in `bounds` and coarse direction. `sorted` gets the rays, `places` where each of them stood; both as long as `rays`,
/// `scratch` twice. At most 2^32 rays. Stable, hence deterministic.
void sort_rays(std::span<const Ray> rays, const Box& bounds, std::span<Ray> sorted, std::span<std::uint32_t> places,
               std::span<std::uint64_t> scratch);

}  // namespace boxwood::queries
