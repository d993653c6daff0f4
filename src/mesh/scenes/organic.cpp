// A closed surface like a scan: a thick root, knotted once (an open piece of a trefoil), with muscle-like swellings and
// fractal bark. The surface of a box of n x n x m cells is laid over the tube, its two ends over the round caps, so
// the mesh is watertight, manifold, in one piece and has triangles of like size, whatever the number.
#include <algorithm>
#include <cmath>

#include "mesh/scenes/mesh_builder.h"
#include "mesh/scenes/noise.h"
#include "mesh/scenes/random.h"
#include "mesh/scenes/scene_list.h"

namespace boxwood::mesh::procedural {
namespace {

constexpr float kPi = 3.14159265f;
constexpr float kTubeRadius = 0.62f;
constexpr double kCellsAlongPerSide = 34;  // cells along the tube for each cell of a cap's side, for square cells

Vec3 curve(double t) {  // t from 0 to 1
  const double angle = 0.3 + t * 0.93 * 2 * 3.14159265358979;
  const double reach = 2 + std::cos(3 * angle);
  return {static_cast<float>(reach * std::cos(2 * angle)), static_cast<float>(reach * std::sin(2 * angle)),
          static_cast<float>(1.25 * std::sin(3 * angle))};
}

/// Curve parameters of m + 1 points spaced evenly along the curve.
std::vector<double> even_parameters(int m) {
  constexpr int kSamples = 4096;
  std::vector<double> travelled(kSamples + 1);
  for (int i = 1; i <= kSamples; ++i)
    travelled[i] = travelled[i - 1] + length(curve(double(i) / kSamples) - curve(double(i - 1) / kSamples));
  std::vector<double> parameters(m + 1);
  int k = 0;
  for (int j = 0; j <= m; ++j) {
    const double wanted = travelled[kSamples] * j / m;
    while (k < kSamples - 1 && travelled[k + 1] < wanted) ++k;
    parameters[j] = (k + (wanted - travelled[k]) / (travelled[k + 1] - travelled[k])) / kSamples;
  }
  return parameters;
}

struct Section {
  Vec3 center;
  Frame frame;  // y along the curve
  float radius;
};

/// Cross sections with frames that turn as little as possible from one to the next.
std::vector<Section> sections(int m) {
  std::vector<Section> result(m + 1);
  const std::vector<double> t = even_parameters(m);
  for (int j = 0; j <= m; ++j) {
    Section& s = result[j];
    s.center = curve(t[j]);
    const Vec3 tangent = normalize(curve(t[j] + 1e-3) - curve(t[j] - 1e-3));
    if (j == 0) {
      s.frame = frame_along(tangent);
    } else {
      const Vec3 x = result[j - 1].frame.x;
      s.frame.y = tangent;
      s.frame.x = normalize(x - dot(x, tangent) * tangent);
      s.frame.z = cross(s.frame.x, s.frame.y);
    }
    const float along = static_cast<float>(t[j]);
    const float taper = 0.5f + 0.5f * std::sqrt(std::sin(kPi * (0.06f + 0.88f * along)));
    s.radius = kTubeRadius * taper * (1 + 0.1f * std::sin(23 * along));
  }
  return result;
}

class Surface {
 public:
  Surface(std::uint64_t seed) : seed_(Random(seed).bits()) {}

  /// The point seen from the middle of a section in a direction: `azimuth` around the curve, `polar` away from it.
  Vec3 point(const Section& s, float azimuth, float polar) const {
    const Vec3 around = std::cos(azimuth) * s.frame.x + std::sin(azimuth) * s.frame.z;
    const Vec3 direction = std::cos(polar) * around + std::sin(polar) * s.frame.y;
    const Vec3 smooth = s.center + s.radius * direction;
    const float swelling = gradient_noise(1.3f * smooth, seed_);
    const float ridges = 1 - 2 * std::fabs(gradient_noise(3.1f * smooth + Vec3{9, 4, 7}, seed_ ^ 0x5bd1e995u));
    const float bark = fractal_noise(6.5f * smooth, 6, seed_ + 77);
    return smooth + s.radius * (0.20f * swelling + 0.07f * ridges + 0.075f * bark) * direction;
  }

 private:
  std::uint32_t seed_;
};

/// Azimuth of a point of a square's rim or inside it; a, b from -1 to 1, not both zero.
float square_azimuth(float a, float b) {
  if (std::fabs(a) >= std::fabs(b)) return (a > 0 ? 0 : kPi) + 0.25f * kPi * b / a;
  return (b > 0 ? 0.5f : 1.5f) * kPi - 0.25f * kPi * a / b;
}

/// Index of the i-th of the 4 n points along the rim of the (n + 1)^2 points of a cap, from (n, 0) towards (n, n).
std::uint32_t rim_index(int i, int n) {
  const int side = i / n, step = i % n;
  const int a = side == 0 ? n : side == 1 ? n - step : side == 2 ? 0 : step;
  const int b = side == 0 ? step : side == 1 ? n : side == 2 ? n - step : 0;
  return static_cast<std::uint32_t>(b * (n + 1) + a);
}

void add_cap(MeshBuilder& builder, const Surface& surface, const Section& section, int n, float sign) {
  const auto base = static_cast<std::uint32_t>(builder.vertices().size());
  for (int b = 0; b <= n; ++b) {
    for (int a = 0; a <= n; ++a) {
      const float x = static_cast<float>(2 * a - n) / static_cast<float>(n);
      const float y = static_cast<float>(2 * b - n) / static_cast<float>(n);
      const float outward = std::max(std::fabs(x), std::fabs(y));  // 1 on the rim
      const float azimuth = outward > 0 ? square_azimuth(x, y) : 0;
      builder.vertex(surface.point(section, azimuth, sign * 0.5f * kPi * (1 - outward)));
    }
  }
  for (int b = 0; b < n; ++b) {
    for (int a = 0; a < n; ++a) {
      const std::uint32_t v = base + static_cast<std::uint32_t>(b * (n + 1) + a), above = v + n + 1;
      if (sign < 0) {
        builder.triangle(v, v + 1, above + 1), builder.triangle(v, above + 1, above);
      } else {
        builder.triangle(v, above + 1, v + 1), builder.triangle(v, above, above + 1);
      }
    }
  }
}

}  // namespace

Scene make_organic(const SceneOptions& options) {
  // 2 (4 n m + 2 n^2) triangles: n sets the size of the cells, m then fills the budget to within 8 n.
  const double budget = static_cast<double>(options.triangles);
  const int n = std::max(1, static_cast<int>(std::lround(std::sqrt(budget / (8 * kCellsAlongPerSide + 4)))));
  const int m = std::max(1, static_cast<int>((budget / 2 - 2.0 * n * n) / (4.0 * n)));
  const Surface surface(options.seed);
  const std::vector<Section> along = sections(m);
  const int ring = 4 * n;

  MeshBuilder builder(MeshBuilder::Purpose::build);
  builder.reserve(options.triangles / 2 + 16, options.triangles);
  const auto cap_size = static_cast<std::uint32_t>((n + 1) * (n + 1));
  add_cap(builder, surface, along.front(), n, -1);
  add_cap(builder, surface, along.back(), n, 1);
  for (int j = 1; j < m; ++j)
    for (int i = 0; i < ring; ++i)
      builder.vertex(
          surface.point(along[j], kPi * (2.0f * static_cast<float>(i) / static_cast<float>(ring) - 0.25f), 0));
  const auto index = [&](int j, int i) {
    i %= ring;
    if (j == 0) return rim_index(i, n);
    if (j == m) return cap_size + rim_index(i, n);
    return 2 * cap_size + static_cast<std::uint32_t>((j - 1) * ring + i);
  };
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < ring; ++i) {
      builder.triangle(index(j, i), index(j + 1, i), index(j + 1, i + 1));
      builder.triangle(index(j, i), index(j + 1, i + 1), index(j, i + 1));
    }
  }
  Scene scene;
  scene.mesh = builder.take();
  scene.view = {.eye = {2.0f, 1.6f, 10.6f}, .look_at = {0, 0, 0}, .up = {0, 1, 0}, .fov = 40};
  return scene;
}

}  // namespace boxwood::mesh::procedural
