// The beam of a packet: rays that share a main axis, bounded by four planes through it, and its test against the boxes
// of a wide node (the idea of Reshetov, Soupikov and Hurley 2005, bib key reshetov2005, with planes as in Boulos, Wald
// and Shirley 2006, bib key boulos2006).
//
// With Z the coordinate along the main axis, counted so that it grows along the rays, every ray is a line whose x and y
// are linear in Z. What they are at most and at least is taken at the two ends of the stretch [z0, z1] that rays and
// scene have in common, and a plane through both is outside all rays in between. So rays from one point, rays to one
// point and parallel rays all give a narrow beam.
//
// Rounding: with M the largest |x| + |Z| of origins and scene, each of the few steps to a plane and to its distance
// from a box is off by at most 2^-24 times 2 M, fewer than 16 of them follow each other, and the triangle tests may
// take a vertex to be 4 * 2^-24 M from where it is (ray_setup.h). The planes are moved out by 64 * 2^-24 M.
#if defined(BOXWOOD_QUERIES_KERNELS_BATCH_FRUSTUM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_QUERIES_KERNELS_BATCH_FRUSTUM_INL_H_
#undef BOXWOOD_QUERIES_KERNELS_BATCH_FRUSTUM_INL_H_
#else
#define BOXWOOD_QUERIES_KERNELS_BATCH_FRUSTUM_INL_H_
#endif

#include "queries/kernels/batch_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::queries::HWY_NAMESPACE {

class Frustum {
 public:
  /// Of the rays whose limit is not below zero. False when none of them can meet the bounds.
  HWY_INLINE bool enclose(const PacketRays& rays, const Box& bounds, int kx, int ky, int kz, bool runs_down) {
    kx_ = kx, ky_ = ky, kz_ = kz, sign_ = runs_down ? -1.0f : 1.0f;
    near_row_ = 2 * kz + runs_down, far_row_ = 2 * kz + !runs_down;
    const RayTag d;
    const auto zero = hn::Zero(d), none = hn::Set(d, kInfinity);
    auto start = none;
    auto reach_x = zero, reach_y = zero, reach_z = zero;
    for (int i = 0; i < PacketRays::kRays; i += static_cast<int>(hn::Lanes(d))) {
      const auto active = hn::Ge(hn::Load(d, rays.limit + i), zero);
      const auto oz = hn::Load(d, rays.origin[kz] + i), dz = hn::Load(d, rays.direction[kz] + i);
      const auto from = hn::MulAdd(hn::Load(d, rays.tmin + i), hn::Abs(dz), hn::Mul(oz, hn::Set(d, sign_)));
      start = hn::Min(start, hn::IfThenElse(active, from, none));
      reach_x = hn::Max(reach_x, hn::Abs(hn::Load(d, rays.origin[kx] + i)));
      reach_y = hn::Max(reach_y, hn::Abs(hn::Load(d, rays.origin[ky] + i)));
      reach_z = hn::Max(reach_z, hn::Abs(oz));
    }
    const auto largest = [&](auto v) HWY_ATTR { return hn::GetLane(hn::MaxOfLanes(d, v)); };
    const float z_reach = largest(reach_z) + extent(bounds, kz);
    pad_z_ = 16 * 0x1p-24f * z_reach;
    const float lower = runs_down ? -bounds.upper[kz] : bounds.lower[kz];
    const float upper = runs_down ? -bounds.lower[kz] : bounds.upper[kz];
    z0_ = maximum(hn::GetLane(hn::MinOfLanes(d, start)), lower) - pad_z_;
    scene_end_ = upper + pad_z_;
    update_end(rays);
    if (!(z0_ <= z1_)) return false;
    const float pad = 64 * 0x1p-24f;
    bound(rays, kx, rays.shear_x, pad * (z_reach + largest(reach_x) + extent(bounds, kx)), low_[0], high_[0]);
    bound(rays, ky, rays.shear_y, pad * (z_reach + largest(reach_y) + extent(bounds, ky)), low_[1], high_[1]);
    return true;
  }

  /// To be called when limits have come down.
  HWY_INLINE void update_end(const PacketRays& rays) {
    const RayTag d;
    auto end = hn::Set(d, -kInfinity);
    for (int i = 0; i < PacketRays::kRays; i += static_cast<int>(hn::Lanes(d))) {
      const auto limit = hn::Load(d, rays.limit + i);
      const auto to = hn::MulAdd(limit, hn::Abs(hn::Load(d, rays.direction[kz_] + i)),
                                 hn::Mul(hn::Load(d, rays.origin[kz_] + i), hn::Set(d, sign_)));
      end = hn::Max(end, hn::IfThenElse(hn::Ge(limit, hn::Zero(d)), to, end));
    }
    z1_ = minimum(hn::GetLane(hn::MaxOfLanes(d, end)) + pad_z_, scene_end_);
  }

  /// How far behind the beam's beginning its end is now; children that are entered behind it are left out.
  HWY_INLINE float length() const { return z1_ - z0_; }

  /// Which boxes of the node the beam meets, one bit each, and how far behind its beginning it enters them.
  template <int W>
  HWY_INLINE std::uint32_t test(const WideNode<W>& node, float* entry) const {
    const hn::CappedTag<float, W> d;
    std::uint32_t hit = 0;
    const auto sign = hn::Set(d, sign_), z0 = hn::Set(d, z0_), z1 = hn::Set(d, z1_);
    for (int i = 0; i < W; i += static_cast<int>(hn::Lanes(d))) {
      const auto near = hn::Max(hn::Mul(hn::Load(d, node.planes[near_row_] + i), sign), z0);
      const auto far = hn::Min(hn::Mul(hn::Load(d, node.planes[far_row_] + i), sign), z1);
      auto meets = hn::Le(near, far);
      for (int k = 0; k < 2; ++k) {
        const int row = 2 * (k ? ky_ : kx_);
        const auto lowest = hn::Min(at(d, low_[k], near), at(d, low_[k], far));
        const auto highest = hn::Max(at(d, high_[k], near), at(d, high_[k], far));
        meets = hn::And(meets, hn::And(hn::Ge(hn::Load(d, node.planes[row + 1] + i), lowest),
                                       hn::Le(hn::Load(d, node.planes[row] + i), highest)));
      }
      hn::Store(hn::Sub(near, z0), d, entry + i);
      hit |= packet_bits(d, meets) << i;
    }
    return hit;
  }

 private:
  struct Line {
    float offset, slope;
  };
  static HWY_INLINE float extent(const Box& bounds, int axis) {
    return maximum(std::fabs(bounds.lower[axis]), std::fabs(bounds.upper[axis]));
  }
  template <class D, class V>
  static HWY_INLINE V at(D d, const Line& line, V z) {
    return hn::MulAdd(hn::Set(d, line.slope), z, hn::Set(d, line.offset));
  }
  HWY_INLINE void bound(const PacketRays& rays, int axis, const float* shear, float pad, Line& low, Line& high) const {
    const RayTag d;
    const auto up = hn::Set(d, kInfinity), down = hn::Set(d, -kInfinity);
    auto low0 = up, low1 = up, high0 = down, high1 = down;
    for (int i = 0; i < PacketRays::kRays; i += static_cast<int>(hn::Lanes(d))) {
      const auto active = hn::Ge(hn::Load(d, rays.limit + i), hn::Zero(d));
      const auto oz = hn::Load(d, rays.origin[kz_] + i), o = hn::Load(d, rays.origin[axis] + i);
      const auto slope = hn::Load(d, shear + i);
      const auto x0 = hn::Add(o, hn::Mul(hn::Sub(hn::Set(d, sign_ * z0_), oz), slope));
      const auto x1 = hn::Add(o, hn::Mul(hn::Sub(hn::Set(d, sign_ * z1_), oz), slope));
      low0 = hn::Min(low0, hn::IfThenElse(active, x0, up)), high0 = hn::Max(high0, hn::IfThenElse(active, x0, down));
      low1 = hn::Min(low1, hn::IfThenElse(active, x1, up)), high1 = hn::Max(high1, hn::IfThenElse(active, x1, down));
    }
    low = line(hn::GetLane(hn::MinOfLanes(d, low0)), hn::GetLane(hn::MinOfLanes(d, low1)), -pad, false);
    high = line(hn::GetLane(hn::MaxOfLanes(d, high0)), hn::GetLane(hn::MaxOfLanes(d, high1)), pad, true);
  }
  /// Through both ends; across a stretch too short for a slope, the farther out of the two.
  HWY_INLINE Line line(float x0, float x1, float pad, bool is_high) const {
    const float length = z1_ - z0_;
    if (!(length > 1e3f * pad_z_)) return {(is_high ? maximum(x0, x1) : minimum(x0, x1)) + pad, 0};
    const float slope = (x1 - x0) / length;
    return {static_cast<float>(x0 - static_cast<double>(slope) * z0_) + pad, slope};
  }

  int kx_, ky_, kz_, near_row_, far_row_;
  float sign_, z0_, z1_, scene_end_, pad_z_;
  Line low_[2], high_[2];
};

}  // namespace boxwood::queries::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
