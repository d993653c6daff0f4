// The batch kernels of layout `wide8`, for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "queries/kernels/batch_wide8.cpp"
#include "base/simd_targets.h"
// clang-format off
#include <hwy/foreach_target.h>
// clang-format on
#include <hwy/highway.h>

#include "queries/kernels/batch_kernels-inl.h"
#include "queries/kernels/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::queries::HWY_NAMESPACE {

BatchKernels wide8_batch_kernels(Mode mode) {
  return mode == Mode::robust ? make_batch_kernels<8, TriangleLeaf, true>()
                              : make_batch_kernels<8, TriangleLeaf, false>();
}

}  // namespace boxwood::queries::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "queries/kernels/kernels.h"

namespace boxwood::queries {

HWY_EXPORT(wide8_batch_kernels);

BatchKernels wide8_batch_kernels(Mode mode, std::int64_t target) {
  return HWY_DISPATCH_TABLE(wide8_batch_kernels)[dispatch_index(target)](mode);
}

}  // namespace boxwood::queries
#endif
