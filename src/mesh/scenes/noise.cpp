#include "mesh/scenes/noise.h"

namespace boxwood::mesh::procedural {
namespace {

std::uint32_t hash_cell(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t seed) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8da6b343u ^ static_cast<std::uint32_t>(y) * 0xd8163841u ^
                    static_cast<std::uint32_t>(z) * 0xcb1ab31fu ^ seed;
  h = (h ^ h >> 15) * 0x2c1b3c6du;
  h = (h ^ h >> 12) * 0x297a2d39u;
  return h ^ h >> 15;
}

/// Dot product of (x, y, z) with one of the twelve directions to the middles of a cube's edges.
float along_gradient(std::uint32_t hash, float x, float y, float z) {
  static constexpr float kDirection[16][3] = {{1, 1, 0},  {-1, 1, 0},  {1, -1, 0}, {-1, -1, 0}, {1, 0, 1},  {-1, 0, 1},
                                              {1, 0, -1}, {-1, 0, -1}, {0, 1, 1},  {0, -1, 1},  {0, 1, -1}, {0, -1, -1},
                                              {1, 1, 0},  {-1, 1, 0},  {0, -1, 1}, {0, -1, -1}};
  const float* d = kDirection[hash >> 28];
  return d[0] * x + d[1] * y + d[2] * z;
}

float fade(float t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}
float mix(float a, float b, float t) {
  return a + t * (b - a);
}

}  // namespace

float gradient_noise(Vec3 p, std::uint32_t seed) {
  const float fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
  const auto ix = static_cast<std::int32_t>(fx), iy = static_cast<std::int32_t>(fy), iz = static_cast<std::int32_t>(fz);
  const float x = p.x - fx, y = p.y - fy, z = p.z - fz;
  const float u = fade(x), v = fade(y), w = fade(z);
  float plane[2];
  for (int k = 0; k < 2; ++k) {
    float line[2];
    for (int j = 0; j < 2; ++j) {
      const float near = along_gradient(hash_cell(ix, iy + j, iz + k, seed), x, y - j, z - k);
      const float far = along_gradient(hash_cell(ix + 1, iy + j, iz + k, seed), x - 1, y - j, z - k);
      line[j] = mix(near, far, u);
    }
    plane[k] = mix(line[0], line[1], v);
  }
  return mix(plane[0], plane[1], w);
}

float fractal_noise(Vec3 p, int octaves, std::uint32_t seed) {
  float sum = 0, amplitude = 1;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += amplitude * gradient_noise(p, seed + static_cast<std::uint32_t>(octave) * 0x9e3779b9u);
    p = 2 * p + Vec3{17.13f, 31.77f, 5.91f};  // octaves must not share their zeros
    amplitude *= 0.5f;
  }
  return sum;
}

}  // namespace boxwood::mesh::procedural
