// The kernels of layout `wide16`, for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "queries/kernels/wide16.cpp"
#include "base/simd_targets.h"
// clang-format off
#include <hwy/foreach_target.h>
// clang-format on
#include <hwy/highway.h>

#include "queries/kernels/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::queries::HWY_NAMESPACE {

Kernels wide16_kernels(Mode mode) {
  return mode == Mode::robust ? make_kernels<16, TriangleLeaf, true>() : make_kernels<16, TriangleLeaf, false>();
}

}  // namespace boxwood::queries::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "queries/kernels/kernels.h"

namespace boxwood::queries {

HWY_EXPORT(wide16_kernels);

Kernels wide16_kernels(Mode mode, std::int64_t target) {
  return HWY_DISPATCH_TABLE(wide16_kernels)[dispatch_index(target)](mode);
}

}  // namespace boxwood::queries
#endif
