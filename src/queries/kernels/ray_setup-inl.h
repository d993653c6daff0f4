// set_up of ray_setup.h with one vector for the three axes: a fifth to a third of a ray's time was there. Compiled once
// per instruction set by the sources that include it; no include guard of the usual kind for that reason.
#if defined(BOXWOOD_QUERIES_KERNELS_RAY_SETUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_QUERIES_KERNELS_RAY_SETUP_INL_H_
#undef BOXWOOD_QUERIES_KERNELS_RAY_SETUP_INL_H_
#else
#define BOXWOOD_QUERIES_KERNELS_RAY_SETUP_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <limits>

#include "queries/ray_setup.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::queries::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

template <bool kRobust>
HWY_INLINE bool set_up_ray(const Ray& ray, const Box& bounds, RaySetup& s) {
  return set_up(ray, bounds, s);
}

#else

/// As set_up, to the last bit: each lane does what its axis does there. The triangle test's constants are left out for
/// the fast mode. Lane 3 holds what happens to stand behind the three coordinates.
template <bool kRobust>
HWY_INLINE bool set_up_ray(const Ray& ray, const Box& bounds, RaySetup& s) {
  const hn::FixedTag<float, 4> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const hn::RebindToSigned<decltype(d)> di;
  static_assert(sizeof(Ray) == 32 && sizeof(Box) == 24);
  const float* const floats = reinterpret_cast<const float*>(&ray);
  const float* const box = reinterpret_cast<const float*>(&bounds);
  const auto axes = hn::FirstN(d, 3);
  const auto origin = hn::LoadU(d, floats), direction = hn::LoadU(d, floats + 4);
  const auto distance = hn::Abs(hn::IfThenElseZero(axes, origin)), size = hn::Abs(hn::IfThenElseZero(axes, direction));
  const auto most = hn::Set(d, std::numeric_limits<float>::max());
  const auto finite = hn::And(hn::Le(distance, most), hn::Le(size, most));
  const auto sizes = hn::MaxOfLanes(d, size);
  if (!hn::AllTrue(d, finite) || !(hn::GetLane(sizes) > 0)) return false;
  const auto exponent = hn::Min(hn::Max(hn::ShiftRight<23>(hn::BitCast(di, sizes)), hn::Set(di, kLowestExponent)),
                                hn::Set(di, kHighestExponent));
  const auto down = hn::BitCast(d, hn::ShiftLeft<23>(hn::Sub(hn::Set(di, 254), exponent)));
  const auto up = hn::BitCast(d, hn::ShiftLeft<23>(exponent));
  if (!set_interval(ray, hn::GetLane(down), hn::GetLane(up), s)) return false;
  const auto scaled = hn::Mul(direction, down);
  const auto lower = hn::LoadU(d, box), upper = hn::Shuffle0321(hn::LoadU(d, box + 2));
  const auto reach = hn::Add(hn::Max(hn::Abs(lower), hn::Abs(upper)), distance);
  const auto limit = hn::Div(hn::Set(d, 1e37f), hn::Max(reach, hn::Set(d, 1.0f)));
  const auto r = hn::Min(hn::Div(hn::Set(d, 1.0f), hn::Abs(scaled)), limit);
  const auto pad = hn::Mul(hn::Mul(hn::Set(d, 12 * 0x1p-24f), reach), r);
  const auto reciprocal = hn::CopySign(r, scaled);
  const auto offset = hn::Mul(hn::Neg(origin), reciprocal);
  const auto negative = hn::BitCast(di, hn::ShiftRight<31>(hn::BitCast(du, scaled)));
  const auto rows = hn::Add(hn::Iota(di, 0), hn::Iota(di, 0));
  hn::Store(origin, d, s.origin);
  hn::Store(scaled, d, s.direction);
  hn::Store(reciprocal, d, s.reciprocal);
  hn::Store(hn::Sub(offset, pad), d, s.entry_add);
  hn::Store(hn::Add(offset, pad), d, s.exit_add);
  hn::Store(hn::Add(rows, negative), di, s.entry_plane);
  hn::Store(hn::Sub(hn::Add(rows, hn::Set(di, 1)), negative), di, s.exit_plane);
  if constexpr (kRobust) {
    alignas(8) std::uint8_t largest_axes[8] = {};
    hn::StoreMaskBits(d, hn::Eq(size, sizes), largest_axes);
    set_main_axis(std::countr_zero(largest_axes[0]), s);
  }
  return true;
}

#endif

}  // namespace boxwood::queries::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
