#include "mesh/scenes/random.h"

namespace boxwood::mesh::procedural {

Random::Random(std::uint64_t seed, std::uint64_t stream) : state_(0), increment_(2 * stream + 1) {
  bits();
  state_ += seed;
  bits();
  bits();  // small seeds differ in few bits, which one step does not yet carry to the top
}

std::uint32_t Random::bits() {
  const std::uint64_t old = state_;
  state_ = old * 6364136223846793005ull + increment_;
  const auto folded = static_cast<std::uint32_t>((old >> 18 ^ old) >> 27);
  const auto turn = static_cast<std::uint32_t>(old >> 59);
  return folded >> turn | folded << (32 - turn) % 32;
}

Vec3 Random::in_ball() {
  for (;;) {
    const float x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
    if (x * x + y * y + z * z <= 1) return {x, y, z};
  }
}

Vec3 Random::direction() {
  for (;;) {
    const Vec3 p = in_ball();
    if (dot(p, p) > 1e-4f) return normalize(p);
  }
}

}  // namespace boxwood::mesh::procedural
