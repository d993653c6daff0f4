// An architectural atrium in the manner of Sponza: two storeys of arcades around an open court. Floor, walls and slabs
// are a few huge axis-aligned triangles beside finely tessellated columns, arches, balusters and cloth: the mixture on
// which EVH's and POPOV's arguments rest. Upright, the large triangles have flat boxes and cost nothing; turned
// (rotate=...), their boxes fill the hall, which is EVH's case for pre-splitting. Units are metres.
#include <algorithm>
#include <cmath>

#include "mesh/scenes/mesh_builder.h"
#include "mesh/scenes/noise.h"
#include "mesh/scenes/random.h"
#include "mesh/scenes/scene_list.h"

namespace boxwood::mesh::procedural {
namespace {

constexpr float kPi = 3.14159265f;
constexpr float kBay = 4, kCourt = 4.6f, kDepth = 0.8f,
                kOuter = 9;  // z of the arcade's face, its thickness, outer wall
constexpr float kGallery = 5.4f, kSlab = 0.3f, kRoof = 10.2f, kWall = 12.5f;
constexpr int kMostBays = 8;

/// How finely each kind of part is tessellated; 64 is about 250,000 triangles in the full hall.
enum class Part { columns, arches, balusters, ornaments };
using Detail = std::array<int, 4>;

Detail even_detail(int detail) {
  Detail all;
  all.fill(detail);
  return all;
}

class Atrium {
 public:
  Atrium(MeshBuilder& builder, int bays, const Detail& detail, std::uint64_t seed)
      : builder_(builder), bays_(bays), detail_(detail), random_(seed) {}

  void describe() {
    shell();
    for (const float side : {1.0f, -1.0f}) {
      side_ = side;
      slabs();
      for (int i = 0; i <= bays_; ++i) column(at(i * kBay), 0, 3.2f, 0.34f);
      for (int i = 0; i <= 2 * bays_; ++i) column(at(0.5f * kBay * i), kGallery + kSlab, 2.4f, 0.15f);
      for (int i = 0; i < bays_; ++i) arch(at(i * kBay), kBay, 0.42f, 3.2f, kGallery);
      for (int i = 0; i < 2 * bays_; ++i) arch(at(0.5f * kBay * i), 0.5f * kBay, 0.22f, kGallery + kSlab + 2.4f, kRoof);
      balustrade();
    }
    side_ = 1;
    fountain();
    for (int i = 0; i < bays_; ++i) shrub(i);
    for (int i = 1; i < bays_; i += 2) banner(at(i * kBay));
    rose_window();
  }

 private:
  float half_length() const { return 0.5f * kBay * static_cast<float>(bays_); }
  float at(float along) const { return along - half_length(); }
  int pieces(Part part, double usual, int least) const {
    return std::max(least, static_cast<int>(std::lround(usual * detail_[static_cast<int>(part)] / 64)));
  }
  /// The other side of the court is this one turned by half a circle, so that fronts stay fronts.
  Vec3 place(float x, float y, float z) const { return {side_ * x, y, side_ * z}; }
  void placed_box(Vec3 lower, Vec3 upper) {
    const Vec3 a = place(lower.x, lower.y, lower.z), b = place(upper.x, upper.y, upper.z);
    builder_.box({minimum(a, b), maximum(a, b)});
  }

  void shell() {
    const float l = half_length(), w = kOuter, h = kWall;
    builder_.quad({-l, 0, w}, {l, 0, w}, {l, 0, -w}, {-l, 0, -w});
    builder_.quad({-l, 0, -w}, {l, 0, -w}, {l, h, -w}, {-l, h, -w});
    builder_.quad({l, 0, w}, {-l, 0, w}, {-l, h, w}, {l, h, w});
    builder_.quad({l, 0, -w}, {l, 0, w}, {l, h, w}, {l, h, -w});
    builder_.quad({-l, 0, w}, {-l, 0, -w}, {-l, h, -w}, {-l, h, w});
  }

  void slabs() {
    const float l = half_length();
    placed_box({-l, kGallery, kCourt - 0.15f}, {l, kGallery + kSlab, kOuter});
    placed_box({-l, kRoof, kCourt - 0.25f}, {l, kRoof + 0.35f, kOuter});
    placed_box({-l, kRoof + 0.35f, kCourt - 0.1f}, {l, kRoof + 0.6f, kOuter});
  }

  void column(float x, float foot, float height, float radius) {
    const float z = kCourt + 0.5f * kDepth, r = radius;
    const float block = 0.55f * r, plate = 0.5f * r;
    placed_box({x - 1.6f * r, foot, z - 1.6f * r}, {x + 1.6f * r, foot + block, z + 1.6f * r});
    placed_box({x - 1.5f * r, foot + height - plate, z - 1.5f * r}, {x + 1.5f * r, foot + height, z + 1.5f * r});
    const float h = height - block - plate;
    const ProfilePoint outline[] = {{1.45f * r, 0},
                                    {1.5f * r, 0.15f * r},
                                    {1.2f * r, 0.42f * r},
                                    {1.26f * r, 0.6f * r},
                                    {1.0f * r, 0.85f * r},
                                    {1.02f * r, 0.3f * h},
                                    {0.96f * r, 0.55f * h},
                                    {0.86f * r, h - 1.7f * r},
                                    {0.98f * r, h - 1.55f * r},
                                    {0.86f * r, h - 1.4f * r},
                                    {0.95f * r, h - 0.75f * r},
                                    {1.45f * r, h}};
    builder_.revolve(place(x, foot + block, z), frame_along({0, 1, 0}),
                     smooth_profile(outline, pieces(Part::columns, 24, 12)), pieces(Part::columns, 28, 6));
  }

  /// Wall with a round-headed opening between the columns at x and x + width, from the columns' heads up to `top`.
  void arch(float x, float width, float pier, float spring, float top) {
    const int steps = pieces(Part::arches, 24, 4), rows = pieces(Part::arches, 2, 1);
    const float radius = 0.5f * width - pier;
    const auto outline = [&](int i) -> std::array<float, 2> {
      if (i == 0) return {x, spring};
      if (i == steps + 2) return {x + width, spring};
      const float angle = kPi * static_cast<float>(i - 1) / static_cast<float>(steps);
      return {x + 0.5f * width - radius * std::cos(angle), spring + radius * std::sin(angle)};
    };
    for (const bool court : {true, false}) {
      const float z = court ? kCourt : kCourt + kDepth;
      builder_.grid(steps + 2, rows, false, [&](int i, int j) {
        const auto [px, py] = outline(court ? steps + 2 - i : i);
        return place(px, py + (top - py) * static_cast<float>(j) / static_cast<float>(rows), z);
      });
    }
    builder_.grid(steps + 2, rows, false, [&](int i, int j) {
      const auto [px, py] = outline(i);
      return place(px, py, kCourt + kDepth * static_cast<float>(j) / static_cast<float>(rows));
    });
  }

  void balustrade() {
    const float foot = kGallery + kSlab, l = half_length(), z = kCourt + 0.12f;
    placed_box({-l, foot + 0.05f, z - 0.1f}, {l, foot + 0.15f, z + 0.1f});
    placed_box({-l, foot + 0.9f, z - 0.13f}, {l, foot + 1.02f, z + 0.13f});
    const int balusters = bays_ * std::min(16, pieces(Part::balusters, 14, 4));
    const ProfilePoint outline[] = {{0.07f, 0},     {0.045f, 0.08f}, {0.085f, 0.26f},
                                    {0.035f, 0.5f}, {0.05f, 0.68f},  {0.07f, 0.75f}};
    const auto profile = smooth_profile(outline, pieces(Part::balusters, 9, 4));
    for (int i = 0; i < balusters; ++i) {
      const float x =
          at(kBay * static_cast<float>(bays_) * (static_cast<float>(i) + 0.5f) / static_cast<float>(balusters));
      builder_.revolve(place(x, foot + 0.15f, z), frame_along({0, 1, 0}), profile, pieces(Part::balusters, 8, 4));
    }
  }

  void fountain() {
    const Frame up = frame_along({0, 1, 0});
    const int around = pieces(Part::ornaments, 64, 8);
    placed_box({-2.4f, 0, -2.4f}, {2.4f, 0.14f, 2.4f});
    const ProfilePoint basin[] = {{1.9f, 0},     {1.95f, 0.1f}, {1.75f, 0.25f}, {1.85f, 0.6f},
                                  {1.98f, 0.7f}, {1.8f, 0.72f}, {1.65f, 0.4f},  {0.4f, 0.3f}};
    const ProfilePoint stem[] = {{0.4f, 0.3f},   {0.22f, 0.5f}, {0.16f, 0.8f},  {0.26f, 1.05f}, {0.13f, 1.25f},
                                 {0.25f, 1.45f}, {0.9f, 1.7f},  {0.92f, 1.75f}, {0.2f, 1.6f},   {0, 1.62f}};
    builder_.revolve({0, 0.14f, 0}, up, smooth_profile(basin, pieces(Part::ornaments, 40, 8)), around);
    builder_.revolve({0, 0.14f, 0}, up, smooth_profile(stem, pieces(Part::ornaments, 40, 10)), around);
    builder_.sphere({0, 1.98f, 0}, 0.24f, pieces(Part::ornaments, 32, 6));
  }

  /// A clipped shrub in a pot between court and arcade.
  void shrub(int bay) {
    const float x = at((static_cast<float>(bay) + 0.5f) * kBay), z = bay % 2 ? -3.9f : 3.9f;
    const ProfilePoint pot[] = {{0.22f, 0}, {0.34f, 0.3f}, {0.36f, 0.5f}, {0.42f, 0.55f}, {0.36f, 0.56f}, {0, 0.5f}};
    const float size = random_.uniform(0.42f, 0.6f);
    const std::uint32_t seed = random_.bits();
    builder_.revolve({x, 0, z}, frame_along({0, 1, 0}), smooth_profile(pot, pieces(Part::ornaments, 16, 6)),
                     pieces(Part::ornaments, 28, 6));
    const std::size_t first = builder_.vertices().size();
    builder_.sphere({x, 0.5f + size, z}, size, pieces(Part::ornaments, 40, 6));
    const Vec3 center{x, 0.5f + size, z};
    for (std::size_t i = first; i < builder_.vertices().size(); ++i) {
      Vec3& v = builder_.vertices()[i];
      v = center + (1 + 0.22f * fractal_noise(7 * v, 4, seed)) * (v - center);
    }
  }

  /// Cloth on a cable across the court.
  void banner(float x) {
    const float width = random_.uniform(1.7f, 2.3f), drop = random_.uniform(2.3f, 3.3f), top = 9.6f;
    const float z = random_.uniform(-1.4f, 1.4f), phase = random_.uniform(0, 6), sway = random_.uniform(0.1f, 0.22f);
    builder_.bar({x, top + 0.03f, -kCourt - 0.2f}, {x, top + 0.03f, kCourt + 0.2f}, 0.02f, 0.02f);
    const int columns = pieces(Part::ornaments, 28, 3), rows = pieces(Part::ornaments, 40, 4);
    builder_.grid(columns, rows, false, [&](int i, int j) {
      const float u = static_cast<float>(i) / static_cast<float>(columns);
      const float v = 1 - static_cast<float>(j) / static_cast<float>(rows);
      const float fold = sway * v * std::sin(9 * u + phase + 2.2f * v) + 0.3f * sway * v * std::sin(17 * u - 3 * v);
      const float hem = 0.25f * v * (1 - 4 * (u - 0.5f) * (u - 0.5f));
      return Vec3{x + fold, top - v * drop - hem, z + width * (0.5f - u) * (1 - 0.08f * v)};
    });
  }

  /// Stone rings and spokes before the end wall that the camera faces.
  void rose_window() {
    const Frame inward = frame_along({-1, 0, 0});
    const Vec3 center{half_length(), 8.0f, 0};
    for (const float ring : {2.2f, 1.35f, 0.5f}) {
      const float t = 0.14f;
      const ProfilePoint outline[] = {{ring + t, 0}, {ring + t, 0.2f}, {ring, 0.32f}, {ring - t, 0.2f}, {ring - t, 0}};
      builder_.revolve(center, inward, smooth_profile(outline, pieces(Part::ornaments, 14, 5)),
                       pieces(Part::ornaments, 72, 10));
    }
    for (int i = 0; i < 12; ++i) {
      const float angle = kPi * static_cast<float>(i) / 6;
      const Vec3 out{0, std::cos(angle), std::sin(angle)}, front{-0.1f, 0, 0};
      builder_.bar(center + front + 0.5f * out, center + front + 2.2f * out, 0.09f, 0.06f);
    }
    const ProfilePoint door[] = {{0, 0}, {1.1f, 0.02f}, {1.25f, 0.3f}, {1.45f, 0.35f}, {1.5f, 0}};
    builder_.revolve({half_length(), 1.9f, 0}, inward, smooth_profile(door, pieces(Part::ornaments, 12, 5)),
                     pieces(Part::ornaments, 48, 10));
  }

  MeshBuilder& builder_;
  int bays_;
  Detail detail_;
  Random random_;
  float side_ = 1;
};

/// For budgets too small for arcades: the bare hall with square pillars.
void describe_pillars(MeshBuilder& builder, std::size_t budget, std::uint64_t seed) {
  const float l = 2 * kBay, w = kOuter, h = kRoof;
  builder.quad({-l, 0, w}, {l, 0, w}, {l, 0, -w}, {-l, 0, -w});
  builder.quad({-l, h, -w}, {l, h, -w}, {l, h, w}, {-l, h, w});
  builder.quad({-l, 0, -w}, {l, 0, -w}, {l, h, -w}, {-l, h, -w});
  builder.quad({l, 0, w}, {-l, 0, w}, {-l, h, w}, {l, h, w});
  builder.quad({l, 0, -w}, {l, 0, w}, {l, h, w}, {l, h, -w});
  builder.quad({-l, 0, w}, {-l, 0, -w}, {-l, h, -w}, {-l, h, w});
  const int pillars = static_cast<int>((budget - 12) / 8), per_row = (pillars + 1) / 2;
  Random random(seed);
  for (int i = 0; i < pillars; ++i) {
    const float x = l * (2 * (static_cast<float>(i / 2) + 0.5f) / static_cast<float>(per_row) - 1);
    const float z = i % 2 ? kCourt : -kCourt;
    const float size = std::min(0.45f, 0.6f * l / static_cast<float>(per_row)) * random.uniform(0.8f, 1);
    builder.grid(4, 1, true, [&](int corner, int j) {
      const float angle = -kPi * (0.5f * static_cast<float>(corner) + 0.25f);
      return Vec3{x + size * std::cos(angle), j ? h : 0, z + size * std::sin(angle)};
    });
  }
}

}  // namespace

Scene make_atrium(const SceneOptions& options) {
  const std::size_t budget = options.triangles;
  const auto count = [&](int bays, const Detail& detail) {
    MeshBuilder counter(MeshBuilder::Purpose::count);
    Atrium(counter, bays, detail, options.seed).describe();
    return counter.triangle_count();
  };
  // At small budgets a shorter hall comes before coarser columns.
  constexpr int kShortest = 3, kCoarsest = 8, kUseful = 20, kFinest = 1 << 15;
  const int bays = largest_detail(kShortest, kMostBays, budget,
                                  [&](int b) { return count(b, even_detail(b == kShortest ? kCoarsest : kUseful)); });
  MeshBuilder builder(MeshBuilder::Purpose::build);
  float half_length = 2 * kBay;
  if (count(bays, even_detail(kCoarsest)) > budget) {
    describe_pillars(builder, budget, options.seed);
  } else {
    // Everything alike first, then each kind of part takes what rounding has left over.
    Detail detail =
        even_detail(largest_detail(kCoarsest, kFinest, budget, [&](int d) { return count(bays, even_detail(d)); }));
    for (int& part : detail) {
      part = largest_detail(part, 2 * part, budget, [&](int d) {
        part = d;
        return count(bays, detail);
      });
    }
    builder.reserve(budget / 10 * 7, budget);
    Atrium(builder, bays, detail, options.seed).describe();
    half_length = 0.5f * kBay * static_cast<float>(bays);
  }
  Scene scene;
  scene.mesh = builder.take();
  scene.view = {.eye = {1 - half_length, 1.75f, 1.9f}, .look_at = {0, 3.6f, -0.9f}, .up = {0, 1, 0}, .fov = 68};
  return scene;
}

}  // namespace boxwood::mesh::procedural
