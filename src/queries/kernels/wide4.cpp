// The kernels of layout `wide4`, for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "queries/kernels/wide4.cpp"
#include "base/simd_targets.h"
// clang-format off
#include <hwy/foreach_target.h>
// clang-format on
#include <hwy/highway.h>

#include "queries/kernels/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::queries::HWY_NAMESPACE {

Kernels wide4_kernels(Mode mode) {
  return mode == Mode::robust ? make_kernels<4, TriangleLeaf, true>() : make_kernels<4, TriangleLeaf, false>();
}

}  // namespace boxwood::queries::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "queries/kernels/kernels.h"

namespace boxwood::queries {

HWY_EXPORT(wide4_kernels);

Kernels wide4_kernels(Mode mode, std::int64_t target) {
  return HWY_DISPATCH_TABLE(wide4_kernels)[dispatch_index(target)](mode);
}

}  // namespace boxwood::queries
#endif
