// Four floats that are worked on together: one SSE register, or an array that the compiler makes of it what it can.
// Minimum and maximum return the second argument when the first is NaN or both are zero, in both forms.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#include <xmmintrin.h>
#endif

namespace boxwood {

#if defined(__SSE2__)

struct Float4 {
  __m128 v;

  static Float4 load(const void* p) { return {_mm_load_ps(static_cast<const float*>(p))}; }
  static Float4 load_anywhere(const void* p) { return {_mm_loadu_ps(static_cast<const float*>(p))}; }
  static Float4 fill(float x) { return {_mm_set1_ps(x)}; }
  static Float4 fill_bits(std::uint32_t x) { return {_mm_castsi128_ps(_mm_set1_epi32(static_cast<int>(x)))}; }
  static Float4 of(float x, float y, float z, float w = 0) { return {_mm_setr_ps(x, y, z, w)}; }
  void store(void* p) const { _mm_store_ps(static_cast<float*>(p), v); }
  void store_anywhere(float* p) const { _mm_storeu_ps(p, v); }
  /// Truncated to integers; not negative.
  void store_integers(std::uint32_t* p) const { _mm_store_si128(reinterpret_cast<__m128i*>(p), _mm_cvttps_epi32(v)); }
  static Float4 load_integers(const std::uint32_t* p) {
    return {_mm_cvtepi32_ps(_mm_load_si128(reinterpret_cast<const __m128i*>(p)))};
  }
};
inline Float4 operator+(Float4 a, Float4 b) {
  return {_mm_add_ps(a.v, b.v)};
}
inline Float4 operator-(Float4 a, Float4 b) {
  return {_mm_sub_ps(a.v, b.v)};
}
inline Float4 operator*(Float4 a, Float4 b) {
  return {_mm_mul_ps(a.v, b.v)};
}
inline Float4 minimum(Float4 a, Float4 b) {
  return {_mm_min_ps(a.v, b.v)};
}
inline Float4 maximum(Float4 a, Float4 b) {
  return {_mm_max_ps(a.v, b.v)};
}
/// Bitwise and, or, exclusive or: for masks of all or no bits per lane, and signs.
inline Float4 operator&(Float4 a, Float4 b) {
  return {_mm_and_ps(a.v, b.v)};
}
inline Float4 operator|(Float4 a, Float4 b) {
  return {_mm_or_ps(a.v, b.v)};
}
inline Float4 operator^(Float4 a, Float4 b) {
  return {_mm_xor_ps(a.v, b.v)};
}
/// All bits in the lanes where a < b.
inline Float4 less(Float4 a, Float4 b) {
  return {_mm_cmplt_ps(a.v, b.v)};
}
/// All bits in the lanes where a <= b; none with a NaN.
inline Float4 at_most(Float4 a, Float4 b) {
  return {_mm_cmple_ps(a.v, b.v)};
}
/// Are the highest bits of lanes 0 to 2 set?
inline bool all_set(Float4 mask) {
  return (_mm_movemask_ps(mask.v) & 7) == 7;
}
inline Float4 absolute(Float4 v) {
  return {_mm_andnot_ps(_mm_set1_ps(-0.0f), v.v)};
}
/// Are lanes 0 to 2 within +-limit? NaNs are not.
inline bool all_within(Float4 v, float limit) {
  return all_set(at_most(absolute(v), Float4::fill(limit)));
}
/// a in the lanes of the mask, b in the others.
inline Float4 select(Float4 mask, Float4 a, Float4 b) {
  return {_mm_or_ps(_mm_and_ps(mask.v, a.v), _mm_andnot_ps(mask.v, b.v))};
}

/// Half areas of three boxes by their extents, in lanes 0 to 2: (x * y + y * z) + z * x of each.
inline Float4 half_areas(Float4 e0, Float4 e1, Float4 e2) {
  const auto products = [](__m128 e) { return _mm_mul_ps(e, _mm_shuffle_ps(e, e, _MM_SHUFFLE(3, 0, 2, 1))); };
  const __m128 p0 = products(e0.v), p1 = products(e1.v), p2 = products(e2.v);
  const __m128 low = _mm_unpacklo_ps(p0, p1), high = _mm_unpackhi_ps(p0, p1);
  const __m128 xy = _mm_shuffle_ps(low, p2, _MM_SHUFFLE(3, 0, 1, 0));
  const __m128 yz = _mm_shuffle_ps(low, p2, _MM_SHUFFLE(3, 1, 3, 2));
  const __m128 zx = _mm_shuffle_ps(high, p2, _MM_SHUFFLE(3, 2, 1, 0));
  return {_mm_add_ps(_mm_add_ps(xy, yz), zx)};
}
/// The same of one box: Box::half_area to the bit.
inline float half_area(Float4 e) {
  const __m128 p = _mm_mul_ps(e.v, _mm_shuffle_ps(e.v, e.v, _MM_SHUFFLE(3, 0, 2, 1)));
  const __m128 xy_yz = _mm_add_ss(p, _mm_shuffle_ps(p, p, _MM_SHUFFLE(1, 1, 1, 1)));
  return _mm_cvtss_f32(_mm_add_ss(xy_yz, _mm_movehl_ps(p, p)));
}
/// Rows become columns.
inline void transpose(Float4& a, Float4& b, Float4& c, Float4& d) {
  _MM_TRANSPOSE4_PS(a.v, b.v, c.v, d.v);
}
inline void prefetch(const void* p) {
  _mm_prefetch(static_cast<const char*>(p), _MM_HINT_T0);
}

#else

struct Float4 {
  alignas(16) float v[4];

  static Float4 load(const void* p) {
    Float4 r;
    std::memcpy(r.v, p, 16);
    return r;
  }
  static Float4 load_anywhere(const void* p) { return load(p); }
  static Float4 fill(float x) { return {{x, x, x, x}}; }
  static Float4 fill_bits(std::uint32_t x) {
    float f;
    std::memcpy(&f, &x, 4);
    return fill(f);
  }
  static Float4 of(float x, float y, float z, float w = 0) { return {{x, y, z, w}}; }
  void store(void* p) const { std::memcpy(p, v, 16); }
  void store_anywhere(float* p) const { std::memcpy(p, v, 16); }
  void store_integers(std::uint32_t* p) const {
    for (int i = 0; i < 4; ++i) p[i] = static_cast<std::uint32_t>(v[i]);
  }
  static Float4 load_integers(const std::uint32_t* p) {
    return {{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]), static_cast<float>(p[3])}};
  }
};
template <class F>
inline Float4 by_lane(const Float4& a, const Float4& b, F f) {
  return {{f(a.v[0], b.v[0]), f(a.v[1], b.v[1]), f(a.v[2], b.v[2]), f(a.v[3], b.v[3])}};
}
template <class F>
inline Float4 by_bits(const Float4& a, const Float4& b, F f) {
  return by_lane(a, b, [&](float x, float y) {
    std::uint32_t s, t;
    std::memcpy(&s, &x, 4), std::memcpy(&t, &y, 4);
    s = f(s, t);
    std::memcpy(&x, &s, 4);
    return x;
  });
}
inline Float4 operator+(Float4 a, Float4 b) {
  return by_lane(a, b, [](float x, float y) { return x + y; });
}
inline Float4 operator-(Float4 a, Float4 b) {
  return by_lane(a, b, [](float x, float y) { return x - y; });
}
inline Float4 operator*(Float4 a, Float4 b) {
  return by_lane(a, b, [](float x, float y) { return x * y; });
}
inline Float4 minimum(Float4 a, Float4 b) {
  return by_lane(a, b, [](float x, float y) { return x < y ? x : y; });
}
inline Float4 maximum(Float4 a, Float4 b) {
  return by_lane(a, b, [](float x, float y) { return x > y ? x : y; });
}
inline Float4 operator&(Float4 a, Float4 b) {
  return by_bits(a, b, [](std::uint32_t x, std::uint32_t y) { return x & y; });
}
inline Float4 operator|(Float4 a, Float4 b) {
  return by_bits(a, b, [](std::uint32_t x, std::uint32_t y) { return x | y; });
}
inline Float4 operator^(Float4 a, Float4 b) {
  return by_bits(a, b, [](std::uint32_t x, std::uint32_t y) { return x ^ y; });
}
template <class F>
inline Float4 mask_by_lane(const Float4& a, const Float4& b, F f) {
  return by_lane(a, b, [&](float x, float y) {
    const std::uint32_t bits = f(x, y) ? ~0u : 0u;
    float mask;
    std::memcpy(&mask, &bits, 4);
    return mask;
  });
}
inline Float4 less(Float4 a, Float4 b) {
  return mask_by_lane(a, b, [](float x, float y) { return x < y; });
}
inline Float4 at_most(Float4 a, Float4 b) {
  return mask_by_lane(a, b, [](float x, float y) { return x <= y; });
}
inline bool all_set(Float4 mask) {
  return std::signbit(mask.v[0]) && std::signbit(mask.v[1]) && std::signbit(mask.v[2]);
}
inline Float4 absolute(Float4 v) {
  return by_lane(v, v, [](float x, float) { return std::fabs(x); });
}
inline bool all_within(Float4 v, float limit) {
  const auto within = [limit](float x) { return x <= limit && x >= -limit; };
  return within(v.v[0]) && within(v.v[1]) && within(v.v[2]);
}
/// a in the lanes of the mask, b in the others.
inline Float4 select(Float4 mask, Float4 a, Float4 b) {
  const Float4 others = by_bits(mask, mask, [](std::uint32_t x, std::uint32_t) { return ~x; });
  return (mask & a) | (others & b);
}
inline Float4 half_areas(Float4 e0, Float4 e1, Float4 e2) {
  const auto area = [](const float* e) { return e[0] * e[1] + e[1] * e[2] + e[2] * e[0]; };
  return {{area(e0.v), area(e1.v), area(e2.v), 0}};
}
inline float half_area(Float4 e) {
  return e.v[0] * e.v[1] + e.v[1] * e.v[2] + e.v[2] * e.v[0];
}
inline void transpose(Float4& a, Float4& b, Float4& c, Float4& d) {
  const Float4 rows[] = {a, b, c, d};
  for (int i = 0; i < 4; ++i)
    a.v[i] = rows[i].v[0], b.v[i] = rows[i].v[1], c.v[i] = rows[i].v[2], d.v[i] = rows[i].v[3];
}
inline void prefetch(const void*) {}

#endif

/// Lanes 0 to 2 all bits, lane 3 none: takes a primitive id out of what is to be calculated with.
inline Float4 xyz_mask() {
  constexpr std::uint32_t all = ~0u;
  float f;
  std::memcpy(&f, &all, 4);
  return Float4::of(f, f, f, 0);
}

}  // namespace boxwood
