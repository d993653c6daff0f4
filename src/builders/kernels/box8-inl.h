// A box in eight lanes: the lower corner, then the upper one negated, so that one minimum grows it. Where registers
// have four lanes it takes two. Both forms, and Box4, give the same bits.
#if defined(BOXWOOD_BUILDERS_KERNELS_BOX8_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_BUILDERS_KERNELS_BOX8_INL_H_
#undef BOXWOOD_BUILDERS_KERNELS_BOX8_INL_H_
#else
#define BOXWOOD_BUILDERS_KERNELS_BOX8_INL_H_
#endif

#include <hwy/highway.h>

#include "builders/parts/box4.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::builders::HWY_NAMESPACE {

#if HWY_ARCH_X86 && HWY_MAX_BYTES >= 32

namespace hn = hwy::HWY_NAMESPACE;

struct Box8 {
  using Tag = hn::FixedTag<float, 8>;
  hn::Vec<Tag> v;

  static HWY_INLINE Box8 empty() { return {hn::Set(Tag(), kInfinity)}; }
  static HWY_INLINE Box8 load(const void* p) { return {hn::Load(Tag(), static_cast<const float*>(p))}; }
  HWY_INLINE void store(void* p) const { hn::Store(v, Tag(), static_cast<float*>(p)); }
  /// Twice the same four lanes.
  static HWY_INLINE Box8 of(Float4 lower, Float4 upper) {
    const hn::FixedTag<float, 4> half;
    return {hn::Combine(Tag(), hn::Vec<decltype(half)>{upper.v}, hn::Vec<decltype(half)>{lower.v})};
  }
  HWY_INLINE Float4 low() const { return {hn::LowerHalf(hn::FixedTag<float, 4>(), v).raw}; }
  HWY_INLINE Float4 high() const { return {hn::UpperHalf(hn::FixedTag<float, 4>(), v).raw}; }
  HWY_INLINE Box8 operator&(Box8 b) const { return {hn::And(v, b.v)}; }
  HWY_INLINE Box8 operator|(Box8 b) const { return {hn::Or(v, b.v)}; }
  HWY_INLINE Box8 operator^(Box8 b) const { return {hn::Xor(v, b.v)}; }
  HWY_INLINE void grow(Box8 b) { v = hn::Min(b.v, v); }
};

#else

struct Box8 {
  Float4 a, b;

  static HWY_INLINE Box8 empty() { return {Float4::fill(kInfinity), Float4::fill(kInfinity)}; }
  static HWY_INLINE Box8 load(const void* p) {
    return {Float4::load(p), Float4::load(static_cast<const float*>(p) + 4)};
  }
  HWY_INLINE void store(void* p) const {
    a.store(p);
    b.store(static_cast<float*>(p) + 4);
  }
  static HWY_INLINE Box8 of(Float4 lower, Float4 upper) { return {lower, upper}; }
  HWY_INLINE Float4 low() const { return a; }
  HWY_INLINE Float4 high() const { return b; }
  HWY_INLINE Box8 operator&(Box8 other) const { return {a & other.a, b & other.b}; }
  HWY_INLINE Box8 operator|(Box8 other) const { return {a | other.a, b | other.b}; }
  HWY_INLINE Box8 operator^(Box8 other) const { return {a ^ other.a, b ^ other.b}; }
  HWY_INLINE void grow(Box8 other) { a = minimum(other.a, a), b = minimum(other.b, b); }
};

#endif

/// The signs of lanes 4 to 7: exclusive or with it goes from an upper corner to a negated one and back.
HWY_INLINE Box8 upper_signs() {
  return Box8::of(Float4::fill(0), Float4::fill(-0.0f));
}

HWY_INLINE Box4 as_box4(Box8 box) {
  box = box ^ upper_signs();
  return {box.low(), box.high()};
}

}  // namespace boxwood::builders::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
