// The batch kernels as a table of functions.
#if defined(BOXWOOD_QUERIES_KERNELS_BATCH_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_QUERIES_KERNELS_BATCH_KERNELS_INL_H_
#undef BOXWOOD_QUERIES_KERNELS_BATCH_KERNELS_INL_H_
#else
#define BOXWOOD_QUERIES_KERNELS_BATCH_KERNELS_INL_H_
#endif

#include "queries/kernels/batch_interleaved-inl.h"
#include "queries/kernels/batch_tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::queries::HWY_NAMESPACE {

template <int W, class Leaf, bool kRobust>
BatchKernels make_batch_kernels() {
  return {
      [](const Layout& l, const Ray* r, const Tile& t, Hit* h, Vec3* normals) {
        return trace_packet<W, Leaf, kRobust, false>(l, r, t, {h, normals, nullptr});
      },
      [](const Layout& l, const Ray* r, const Tile& t, std::uint8_t* o) {
        return trace_packet<W, Leaf, kRobust, true>(l, r, t, {nullptr, nullptr, o});
      },
      interleaved_closest<W, Leaf, kRobust>,
      interleaved_any<W, Leaf, kRobust>,
      kInterleaves<W>,
  };
}

}  // namespace boxwood::queries::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
