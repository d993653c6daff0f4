// The kernels of layout `wide8-quads`, for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "queries/kernels/wide8_quads.cpp"
#include "base/simd_targets.h"
// clang-format off
#include <hwy/foreach_target.h>
// clang-format on
#include <hwy/highway.h>

#include "queries/kernels/wide_quads-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::queries::HWY_NAMESPACE {

Kernels wide8_quads_kernels(Mode mode) {
  return mode == Mode::robust ? make_kernels<8, QuadLeaf, true>() : make_kernels<8, QuadLeaf, false>();
}

}  // namespace boxwood::queries::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "queries/kernels/kernels.h"

namespace boxwood::queries {

HWY_EXPORT(wide8_quads_kernels);

Kernels wide8_quads_kernels(Mode mode, std::int64_t target) {
  return HWY_DISPATCH_TABLE(wide8_quads_kernels)[dispatch_index(target)](mode);
}

}  // namespace boxwood::queries
#endif
