// A city on a street grid: a few huge ground triangles, many boxes from kiosks to towers with ledges and fins. Sizes
// differ by more than a hundred to one and most of it is hidden from any one place: like POPOV's Venice and Soda Hall,
// a scene whose cost lies in large, sparse, mostly axis-aligned boxes. Units are metres.
#include <algorithm>
#include <cmath>

#include "mesh/scenes/mesh_builder.h"
#include "mesh/scenes/random.h"
#include "mesh/scenes/scene_list.h"

namespace boxwood::mesh::procedural {
namespace {

constexpr float kLot = 26, kStreet = 16;
constexpr int kBlock = 3;                 // lots along each side of a block
constexpr double kTrianglesPerLot = 128;  // on average, to foresee how far the city will reach

/// Integer cell number `index` of a square spiral around (0, 0).
std::array<int, 2> spiral(std::size_t index) {
  if (index == 0) return {0, 0};
  auto ring = static_cast<long>((std::sqrt(static_cast<double>(index)) + 1) / 2);
  while ((2 * ring + 1) * (2 * ring + 1) <= static_cast<long>(index)) ++ring;
  while ((2 * ring - 1) * (2 * ring - 1) > static_cast<long>(index)) --ring;
  const long step = static_cast<long>(index) - (2 * ring - 1) * (2 * ring - 1), side = step / (2 * ring),
             along = step % (2 * ring) - ring + 1;
  const int r = static_cast<int>(ring), a = static_cast<int>(along);
  return side == 0   ? std::array{r, a}
         : side == 1 ? std::array{-a, r}
         : side == 2 ? std::array{-r, -a}
                     : std::array{a, -r};
}

float lot_position(int lot) {
  const int block = static_cast<int>(std::floor((static_cast<float>(lot) + 1) / kBlock));
  return kLot * static_cast<float>(lot) + kStreet * static_cast<float>(block);
}

class Building {
 public:
  Building(MeshBuilder& builder, Vec3 middle, float half_x, float half_z, Random& random)
      : builder_(builder), middle_(middle), half_x_(half_x), half_z_(half_z), random_(random) {}

  /// Slabs with a ledge at every storey.
  void ledges(float height) {
    prism(0, height, 1);
    const int storeys = std::max(2, static_cast<int>(height / 3.6f));
    for (int i = 1; i <= storeys; ++i) {
      const float y = height * static_cast<float>(i) / static_cast<float>(storeys);
      prism(y - 0.45f, y + (i == storeys ? 0.6f : 0.1f), 1.035f, true);
    }
    roof(height + 0.6f, 1);
  }

  /// A tower with thin fins from bottom to top and a setback crown.
  void fins(float height) {
    prism(0, height, 0.97f);
    const int across = 4 + static_cast<int>(random_.below(5));
    for (int i = 0; i <= across; ++i) {
      const float t = 2 * static_cast<float>(i) / static_cast<float>(across) - 1;
      for (const float side : {1.0f, -1.0f}) {
        fin(t * 0.97f * half_x_, side * half_z_, height);
        if (i > 0 && i < across) fin(side * half_x_, t * 0.97f * half_z_, height);
      }
    }
    prism(height, height * 1.06f, 0.7f);
    roof(height * 1.06f, 0.7f);
  }

  /// Boxes on boxes, each narrower, with ledges at the steps.
  void steps(float height) {
    const int tiers = 2 + static_cast<int>(random_.below(4));
    float y = 0, width = 1;
    for (int i = 0; i < tiers; ++i) {
      const float top = y + (height - y) * (i + 1 == tiers ? 1 : random_.uniform(0.35f, 0.6f));
      prism(y, top, width);
      prism(top - 0.8f, top + 0.4f, width + 0.03f, true);
      const int bands = static_cast<int>((top - y) / 8);
      for (int k = 1; k < bands; ++k) {
        const float level = y + (top - y) * static_cast<float>(k) / static_cast<float>(bands);
        prism(level - 0.25f, level + 0.25f, width + 0.02f, true);
      }
      y = top;
      if (i + 1 < tiers) width *= random_.uniform(0.65f, 0.85f);
    }
    if (random_.below(2)) {
      const float mast = height * random_.uniform(0.12f, 0.3f);
      builder_.tube(middle_ + Vec3{0, y, 0}, middle_ + Vec3{0, y + mast, 0}, 0.5f, 0.1f, 6);
    } else {
      roof(y + 0.4f, width);
    }
  }

  /// A low house under a gabled roof.
  void gable(float height) {
    prism(0, height, 1);
    const float x = 1.05f * half_x_, z = 1.05f * half_z_, ridge = height + 0.55f * half_x_;
    const Vec3 m = middle_;
    const std::uint32_t v = builder_.vertex(m + Vec3{-x, height, z});
    for (const Vec3 p :
         {Vec3{x, height, z}, Vec3{x, height, -z}, Vec3{-x, height, -z}, Vec3{0, ridge, z}, Vec3{0, ridge, -z}})
      builder_.vertex(m + p);
    builder_.triangle(v, v + 1, v + 4);
    builder_.triangle(v + 2, v + 3, v + 5);
    builder_.triangle(v + 1, v + 2, v + 5);
    builder_.triangle(v + 1, v + 5, v + 4);
    builder_.triangle(v + 3, v, v + 4);
    builder_.triangle(v + 3, v + 4, v + 5);
    const Vec3 chimney = m + Vec3{0.4f * half_x_, height, 0.3f * half_z_};
    builder_.box({chimney - Vec3{0.5f, 0, 0.5f}, chimney + Vec3{0.5f, 0.55f * half_x_ + 1, 0.5f}}, false);
  }

 private:
  void prism(float from, float to, float width, bool bottom = false) {
    builder_.box({middle_ + Vec3{-width * half_x_, from, -width * half_z_},
                  middle_ + Vec3{width * half_x_, to, width * half_z_}},
                 bottom);
  }
  void fin(float x, float z, float height) {
    builder_.box({middle_ + Vec3{x - 0.22f, 0, z - 0.22f}, middle_ + Vec3{x + 0.22f, 1.02f * height, z + 0.22f}},
                 false);
  }
  /// Machines and now and then a water tank.
  void roof(float y, float width) {
    const int machines = static_cast<int>(random_.below(4));
    for (int i = 0; i < machines; ++i) {
      const float size = random_.uniform(0.5f, 1.6f);
      const Vec3 p = middle_ + Vec3{0.7f * width * half_x_ * random_.uniform(-1, 1), y,
                                    0.7f * width * half_z_ * random_.uniform(-1, 1)};
      builder_.box({p - Vec3{size, 0, size}, p + Vec3{size, 1.3f * size, size}}, false);
    }
    if (random_.below(3)) return;
    const ProfilePoint tank[] = {{1.3f, 0.8f}, {1.3f, 3.4f}, {0, 4.4f}};
    const Vec3 p = middle_ + Vec3{0.3f * half_x_, y, -0.3f * half_z_};
    builder_.revolve(p, frame_along({0, 1, 0}), tank, 12);
    for (const float x : {-0.8f, 0.8f})
      for (const float z : {-0.8f, 0.8f}) builder_.bar(p + Vec3{x, 0, z}, p + Vec3{x, 0.9f, z}, 0.12f, 0.12f);
  }

  MeshBuilder& builder_;
  Vec3 middle_;
  float half_x_, half_z_;
  Random& random_;
};

/// What stands on one lot; `nearness` is 1 in the middle of the city and 0 at its edge.
void describe_lot(MeshBuilder& builder, int x, int z, float nearness, std::uint64_t seed) {
  const auto cell = std::uint64_t(std::uint32_t(x)) << 32 | std::uint32_t(z);
  Random random(seed, cell);
  const Vec3 middle{lot_position(x), 0.3f, lot_position(z)};
  const float half_x = 0.5f * kLot * random.uniform(0.62f, 0.94f), half_z = 0.5f * kLot * random.uniform(0.62f, 0.94f);
  const float luck = random.uniform();
  const float height = 6 + 22 * random.uniform() + 210 * nearness * nearness * luck * luck * luck;
  Building building(builder, middle, half_x, half_z, random);
  if (luck < 0.08f) {  // a square with kiosks and lamps
    for (int i = 0; i < 6; ++i) {
      const Vec3 p = middle + Vec3{half_x * random.uniform(-1, 1), 0, half_z * random.uniform(-1, 1)};
      builder.box({p - Vec3{0.9f, 0, 0.9f}, p + Vec3{0.9f, 2.4f, 0.9f}}, false);
    }
  } else if (height < 12) {
    building.gable(height);
  } else if (random.below(10) < (height > 60 ? 4u : 1u)) {
    building.fins(height);
  } else if (random.below(10) < 4) {
    building.steps(height);
  } else {
    building.ledges(height);
  }
}

}  // namespace

Scene make_city(const SceneOptions& options) {
  const double lots_expected = std::max(1.0, static_cast<double>(options.triangles) / kTrianglesPerLot);
  const auto reach = static_cast<float>(0.5 * std::sqrt(lots_expected)) + 1;

  MeshBuilder builder(MeshBuilder::Purpose::build);
  builder.reserve(options.triangles / 10 * 8, options.triangles);
  const std::size_t budget = options.triangles - 2;  // two for the ground
  int farthest = 1;
  // Lots that no longer fit are left empty, which frays the edge of the city and uses the budget up.
  for (std::size_t index = 0, misses = 0; misses < 30; ++index) {
    const auto [column, row] = spiral(index);
    const int x = column, z = row;  // not every compiler lets a lambda use structured bindings
    MeshBuilder lot(MeshBuilder::Purpose::count);
    const auto ring = static_cast<float>(std::max(std::abs(x), std::abs(z)));
    const float nearness = std::max(0.0f, 1 - ring / reach);
    const bool block_corner = (x + 300'001) % kBlock == 0 && (z + 300'001) % kBlock == 0;
    const auto describe = [&](MeshBuilder& target) {
      if (block_corner) {
        const float rim = 0.5f * kLot, side = kLot * kBlock;
        const Vec3 corner{lot_position(x) - rim, 0, lot_position(z) - rim};
        target.box({corner, corner + Vec3{side, 0.3f, side}}, false);
      }
      describe_lot(target, x, z, nearness, options.seed);
    };
    describe(lot);
    if (builder.triangle_count() + lot.triangle_count() > budget) {
      ++misses;
      continue;
    }
    describe(builder);
    farthest = std::max({farthest, std::abs(x), std::abs(z)});
  }
  // A few kiosks in the main street take what is left.
  for (int i = 0; builder.triangle_count() + 10 <= budget; ++i) {
    const Vec3 p{lot_position(0) - kLot - 0.5f * kStreet, 0, 7.0f * static_cast<float>(i)};
    builder.box({p - Vec3{0.8f, 0, 0.8f}, p + Vec3{0.8f, 2.4f, 0.8f}}, false);
  }
  const float ground = lot_position(farthest) + 3 * kLot;
  builder.quad({-ground, 0, ground}, {ground, 0, ground}, {ground, 0, -ground}, {-ground, 0, -ground});
  Scene scene;
  scene.mesh = builder.take();
  const float edge = reach * (kLot + kStreet / kBlock);
  scene.view = {.eye = {0.55f * edge, 60 + 0.3f * edge, 1.25f * edge},
                .look_at = {0, 25, 0.1f * edge},
                .up = {0, 1, 0},
                .fov = 42};
  return scene;
}

}  // namespace boxwood::mesh::procedural
