// What the packet traversals of the `linear` layout share: the rays of a packet with their box-test constants planes
// apart, the box tests of four rays and of a packet as a whole, leaves, and the loop over packets.
//
// Whatever the packet, each ray finds what it would find alone. A ray is tested against the box of every leaf whose
// triangles it tests, by the same arithmetic as a single ray, and those boxes hold all it can hit; in what order
// leaves come does not matter, since of hits at one t the lowest id is taken. Rays that can hit nothing (malformed
// ones, those that fill up the last four) have an upper limit of -infinity, which no box test passes, and so has a
// ray of an any-hit query that is done: no traversal needs to know of either.
#pragma once

#include <memory>
#include <vector>

#include "queries/kernels/kernels.h"
#include "queries/kernels/linear_steps.h"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace boxwood::queries {

/// Bounds of a packet's rays, for tests of the whole packet by interval arithmetic. An axis on which the directions
/// differ in sign says nothing. Where all point downwards everything is mirrored, so there is one case only.
///
/// A slab's entry is taken as (plane - origin) * reciprocal, which stays narrow for rays from one eye, where the rays'
/// own tests have plane * reciprocal - origin * reciprocal. With the names of ray_setup.h the two differ by at most
/// 8 h P and a ray's pad is 12 h P, so that three times the largest pad keeps the interval outside every ray's own.
class PacketInterval {
 public:
  void clear() { *this = PacketInterval(); }
  void add(const RaySetup& ray) {
    for (int axis = 0; axis < 3; ++axis) {
      Axis& a = axes_[axis];
      const bool negative = ray.entry_plane[axis] & 1;
      const float o = negative ? -ray.origin[axis] : ray.origin[axis], r = std::fabs(ray.reciprocal[axis]);
      if (is_empty_) a.negative = negative;
      a.is_mixed |= a.negative != negative;
      a.origin_low = minimum(a.origin_low, o), a.origin_high = maximum(a.origin_high, o);
      a.slope_low = minimum(a.slope_low, r), a.slope_high = maximum(a.slope_high, r);
      a.pad = maximum(a.pad, 1.5f * (ray.exit_add[axis] - ray.entry_add[axis]));
    }
    tmin_ = minimum(tmin_, ray.tmin);
    is_empty_ = false;
  }
  /// May any ray meet the box before `tmax`, the largest of all the rays?
  bool may_meet(const Box& box, float tmax) const {
    float near = tmin_, far = tmax;
    for (int axis = 0; axis < 3; ++axis) {
      const Axis& a = axes_[axis];
      if (a.is_mixed) continue;
      const float entry_plane = a.negative ? -box.upper[axis] : box.lower[axis];
      const float exit_plane = a.negative ? -box.lower[axis] : box.upper[axis];
      const float before = entry_plane - a.origin_high, after = exit_plane - a.origin_low;
      near = maximum(near, before * (before >= 0 ? a.slope_low : a.slope_high) - a.pad);
      far = minimum(far, after * (after >= 0 ? a.slope_high : a.slope_low) + a.pad);
    }
    return near <= far;
  }

 private:
  struct Axis {
    float origin_low = kInfinity, origin_high = -kInfinity, slope_low = kInfinity, slope_high = 0;
    float pad = 0;  // exit_add - entry_add is two pads of a ray, give or take a rounding
    bool negative = false, is_mixed = false;
  };
  Axis axes_[3];
  float tmin_ = kInfinity;
  bool is_empty_ = true;
};

/// The rays of one packet and their answers so far.
class Packet {
 public:
  using Mask = std::uint32_t;
  static constexpr std::size_t kGroup = 4;  ///< rays whose boxes are tested at once

  Packet(const Layout& layout, std::size_t size, const TraversalOptions& options, bool any)
      : nodes_(reinterpret_cast<const LinearNode*>(layout.nodes.data())),
        triangles_(reinterpret_cast<const LinearTriangle*>(layout.triangles.data())),
        layout_(layout),
        shortens_(options.terminating),
        ends_(options.terminating && any),
        planes_(kPlanes * size),
        setups_(size),
        bests_(size),
        counts_(size) {}

  void load(const Ray* rays, std::size_t count) {
    size_ = (count + kGroup - 1) / kGroup * kGroup;
    farthest_ = -kInfinity;
    interval_.clear();
    for (std::size_t i = 0; i < size_; ++i) {
      RaySetup& setup = setups_[i];
      bests_[i] = {};
      counts_[i] = {};
      if (i >= count || !set_up(rays[i], layout_.bounds, setup)) {
        setup = {};
        plane(kLimit)[i] = -kInfinity;
      } else {
        bests_[i].t = plane(kLimit)[i] = setup.tmax;
        farthest_ = maximum(farthest_, setup.tmax);
        interval_.add(setup);
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        plane(kReciprocal + axis)[i] = setup.reciprocal[axis];
        plane(kEntry + axis)[i] = setup.entry_add[axis];
        plane(kExit + axis)[i] = setup.exit_add[axis];
      }
      plane(kTmin)[i] = setup.tmin;
    }
  }

  std::size_t size() const { return size_; }
  const LinearNode& node(std::uint32_t index) const { return nodes_[index]; }
  const RaySetup& setup(std::size_t ray) const { return setups_[ray]; }
  const Best& best(std::size_t ray) const { return bests_[ray]; }
  Counts& counts(std::size_t ray) { return counts_[ray]; }
  bool all_done() const { return farthest_ == -kInfinity; }
  bool may_meet(const Box& box) const { return interval_.may_meet(box, farthest_); }
  bool meets(std::size_t ray, const Box& box) const { return box_test(box, setups_[ray], plane(kLimit)[ray]); }

  /// The box test of rays `first` to `first + 3`, one bit each; `first` is a multiple of four. Each lane does what
  /// box_test does: which plane is entered first follows from the products, and the sign of the reciprocal.
  Mask meets_four(std::size_t first, const Box& box) const {
#if defined(__SSE2__)
    __m128 near = _mm_load_ps(plane(kTmin) + first), far = _mm_load_ps(plane(kLimit) + first);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const __m128 reciprocal = _mm_load_ps(plane(kReciprocal + axis) + first);
      const __m128 a = _mm_mul_ps(_mm_set1_ps(box.lower[static_cast<int>(axis)]), reciprocal);
      const __m128 b = _mm_mul_ps(_mm_set1_ps(box.upper[static_cast<int>(axis)]), reciprocal);
      near = _mm_max_ps(near, _mm_add_ps(_mm_min_ps(a, b), _mm_load_ps(plane(kEntry + axis) + first)));
      far = _mm_min_ps(far, _mm_add_ps(_mm_max_ps(a, b), _mm_load_ps(plane(kExit + axis) + first)));
    }
    return static_cast<Mask>(_mm_movemask_ps(_mm_cmple_ps(near, far)));
#else
    Mask mask = 0;
    for (std::size_t lane = 0; lane < kGroup; ++lane) mask |= static_cast<Mask>(meets(first + lane, box)) << lane;
    return mask;
#endif
  }

  /// Is the second child of an inner node entered first, by the direction of this ray?
  bool second_first(std::size_t ray, const LinearNode& inner) const {
    return setups_[ray].entry_plane[inner.count_and_axis & 3] & 1;
  }

  /// Tests the triangles of a leaf for one ray.
  template <bool kRobust, bool kCount>
  void test_leaf(const LinearNode& leaf, std::size_t ray) {
    const std::uint32_t count = leaf.count_and_axis >> 2;
    if constexpr (kCount) ++counts_[ray].leaves, counts_[ray].primitives += count;
    Best& best = bests_[ray];
    const LinearTriangle* const begin = triangles_ + leaf.offset;
    for (const LinearTriangle* t = begin; t != begin + count; ++t) {
      if (!improve<kRobust>(*t, setups_[ray], best) || !shortens_) continue;
      is_shorter_ = true;
      plane(kLimit)[ray] = ends_ ? -kInfinity : best.t;
      if (ends_) return;
    }
  }
  /// To be called after each leaf: brings the packet's own upper limit up to date.
  void finish_leaf() {
    if (!is_shorter_) return;
    is_shorter_ = false;
    farthest_ = -kInfinity;
    for (std::size_t i = 0; i < size_; ++i) farthest_ = maximum(farthest_, plane(kLimit)[i]);
  }

 private:
  enum Plane : std::size_t { kReciprocal = 0, kEntry = 3, kExit = 6, kTmin = 9, kLimit = 10, kPlanes = 11 };

  float* plane(std::size_t p) {
    return planes_.data() + p * bests_.size();
  }
  const float* plane(std::size_t p) const {
    return planes_.data() + p * bests_.size();
  }

  const LinearNode* nodes_;
  const LinearTriangle* triangles_;
  const Layout& layout_;
  bool shortens_, ends_;
  bool is_shorter_ = false;
  std::size_t size_ = 0;
  float farthest_ = -kInfinity;  ///< the largest upper limit of all rays
  PacketInterval interval_;
  AlignedBuffer<float> planes_;
  std::vector<RaySetup> setups_;
  std::vector<Best> bests_;
  std::vector<Counts> counts_;
};

/// Where the answers go; `hits` or `occluded` is null, and so may be `normals` and `per_ray`.
struct Answers {
  Hit* hits = nullptr;
  Vec3* normals = nullptr;
  std::uint8_t* occluded = nullptr;
  Counts* per_ray = nullptr;
};

/// Cuts an array of rays into packets of `packet_size`, lets `walk.run<kRobust, kCount>(packet)` trace each and takes
/// the answers. A walk is made for one call: `Walk(layout, packet_size)`.
template <class Walk, bool kRobust, bool kCount>
void trace_packets(const Layout& layout, const Ray* rays, std::size_t count, std::size_t packet_size,
                   const TraversalOptions& options, const Answers& answers) {
  Packet packet(layout, packet_size, options, answers.occluded != nullptr);
  Walk walk(layout, packet_size);
  for (std::size_t begin = 0; begin < count; begin += packet_size) {
    const std::size_t n = count - begin < packet_size ? count - begin : packet_size;
    packet.load(rays + begin, n);
    if (layout.root != layouts::kNoRoot && !packet.all_done()) walk.template run<kRobust, kCount>(packet);
    for (std::size_t i = 0; i < n; ++i) {
      const Best& best = packet.best(i);
      if (answers.occluded) answers.occluded[begin + i] = best.triangle != nullptr;
      if (answers.hits) answers.hits[begin + i] = make_hit(packet.setup(i), best);
      if (answers.normals) answers.normals[begin + i] = normal_of(best);
      if constexpr (kCount) {
        packet.counts(i).rays = 1;
        packet.counts(i).hits = best.triangle != nullptr;
        answers.per_ray[begin + i] = packet.counts(i);
      }
    }
  }
}

template <class Walk, bool kRobust>
void trace_packets(const Layout& layout, const Ray* rays, std::size_t count, const TraversalOptions& options,
                   const Answers& answers) {
  const std::size_t size = Walk::packet_size(options);
  if (answers.per_ray)
    trace_packets<Walk, kRobust, true>(layout, rays, count, size, options, answers);
  else
    trace_packets<Walk, kRobust, false>(layout, rays, count, size, options, answers);
}

/// The kernels of one packet traversal.
template <class Walk, bool kRobust>
TraversalKernels make_packet_kernels() {
  return {
      [](const Layout& l, const Ray* r, std::size_t n, const TraversalOptions& o, Hit* hits, Vec3* normals,
         Counts* per_ray) {
        trace_packets<Walk, kRobust>(l, r, n, o, {hits, normals, nullptr, per_ray});
      },
      [](const Layout& l, const Ray* r, std::size_t n, const TraversalOptions& o, std::uint8_t* occluded,
         Counts* per_ray) {
        trace_packets<Walk, kRobust>(l, r, n, o, {nullptr, nullptr, occluded, per_ray});
      },
  };
}

}  // namespace boxwood::queries
