// Boxes in registers, for the loops over references.
#pragma once

#include "boxwood/refs.h"
#include "math/float4.h"

namespace boxwood::builders {

/// A box in two registers, uninitialised; what stands in the fourth lanes is never looked at.
struct Box4 {
  Float4 lower, upper;

  static Box4 empty() { return {Float4::fill(kInfinity), Float4::fill(-kInfinity)}; }
  static Box4 of(const Box& b) {
    return {Float4::of(b.lower.x, b.lower.y, b.lower.z), Float4::of(b.upper.x, b.upper.y, b.upper.z)};
  }
  static Box4 of(const refs::Reference& r) { return {Float4::load(&r.lower), Float4::load(&r.upper)}; }

  void grow(const Box4& b) { lower = minimum(b.lower, lower), upper = maximum(b.upper, upper); }
  void grow(Float4 p) { lower = minimum(p, lower), upper = maximum(p, upper); }
  Box box() const {
    alignas(16) float l[4], u[4];
    lower.store(l), upper.store(u);
    return {{l[0], l[1], l[2]}, {u[0], u[1], u[2]}};
  }
};

/// Twice the centre of a reference's box; the fourth lane is zero.
inline Float4 centroid2(const Box4& b, Float4 mask) {
  return (b.lower & mask) + (b.upper & mask);
}

}  // namespace boxwood::builders
