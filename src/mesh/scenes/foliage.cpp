// Trees and grass of disconnected leaves: a leaf has 2 to 4 triangles of its own and shares no vertex with another.
// EBBVH's weak case: pairing by shared edges ends inside each leaf. Wood takes at most a twentieth of the triangles.
#include <algorithm>
#include <cmath>

#include "mesh/scenes/mesh_builder.h"
#include "mesh/scenes/random.h"
#include "mesh/scenes/scene_list.h"

namespace boxwood::mesh::procedural {
namespace {

struct Branch {
  Vec3 from, to;
  float radius;
  int level;
};

/// A tree of height about 1 in units of `size`: each branch carries thinner and shorter ones. Breadth first.
std::vector<Branch> grow(Vec3 foot, float size, Random& random) {
  constexpr int kLevels = 4, kChildren[kLevels] = {9, 5, 4, 0};
  const Vec3 lean{random.uniform(-0.06f, 0.06f), 1, random.uniform(-0.06f, 0.06f)};
  std::vector<Branch> branches{{foot, foot + size * lean, 0.035f * size, 0}};
  for (std::size_t i = 0; i < branches.size(); ++i) {
    const Branch parent = branches[i];
    const Vec3 along = parent.to - parent.from;
    const Frame frame = frame_along(along);
    const int children = kChildren[parent.level];
    float turn = random.uniform(0, 6.28f);
    for (int k = 0; k < children; ++k) {
      // Higher branches are shorter and steeper, which rounds the crown.
      const float t = (parent.level == 0 ? 0.28f : 0.3f) +
                      0.7f * (static_cast<float>(k) + random.uniform()) / static_cast<float>(children);
      turn += 2.4f + random.uniform(-0.3f, 0.3f);
      const float spread = random.uniform(0.7f, 1.15f) * (parent.level == 0 ? 1.35f - 0.7f * t : 0.9f);
      const Vec3 side = std::cos(turn) * frame.x + std::sin(turn) * frame.z;
      const Vec3 direction = normalize(std::cos(spread) * frame.y + std::sin(spread) * side + Vec3{0, 0.12f, 0});
      const float reach = length(along) * random.uniform(0.42f, 0.62f) * (parent.level == 0 ? 1.25f - 0.6f * t : 1.0f);
      const Vec3 from = parent.from + std::min(t, 0.97f) * along;
      branches.push_back({from, from + reach * direction, parent.radius * 0.45f, parent.level + 1});
    }
  }
  return branches;
}

/// A pointed leaf or blade from `stem` along `along`, `across` wide to each side, bent towards -`normal`.
void add_leaf(MeshBuilder& builder, Vec3 stem, Vec3 along, Vec3 across, Vec3 normal, int triangles) {
  const Vec3 fold = 0.35f * normal;
  const std::uint32_t base = builder.vertex(stem);
  if (triangles == 3) {  // a blade: a tapering strip with a tip
    const std::uint32_t wide = builder.vertex(stem + across);
    const std::uint32_t left = builder.vertex(stem + 0.6f * along - 0.1f * across - 0.3f * fold);
    const std::uint32_t right = builder.vertex(stem + 0.6f * along + 0.8f * across - 0.3f * fold);
    const std::uint32_t tip = builder.vertex(stem + along + 0.35f * across - 2 * fold);
    builder.triangle(base, wide, right);
    builder.triangle(base, right, left);
    builder.triangle(left, right, tip);
    return;
  }
  const std::uint32_t right = builder.vertex(stem + 0.45f * along + across + fold);
  const std::uint32_t left = builder.vertex(stem + 0.45f * along - across + fold);
  if (triangles == 2) {
    const std::uint32_t tip = builder.vertex(stem + along);
    builder.triangle(base, right, tip);
    builder.triangle(base, tip, left);
  } else {  // folded along the middle rib, the tip hanging
    const std::uint32_t middle = builder.vertex(stem + 0.5f * along);
    const std::uint32_t tip = builder.vertex(stem + along - 1.2f * fold);
    builder.triangle(base, right, middle);
    builder.triangle(base, middle, left);
    builder.triangle(middle, right, tip);
    builder.triangle(middle, tip, left);
  }
}

/// Leaves along the twigs (the last level of branches), `budget` triangles of them.
void add_crown(MeshBuilder& builder, const std::vector<Branch>& branches, float size, std::size_t budget,
               Random& random) {
  const auto twig_count = static_cast<std::uint32_t>(std::count_if(
      branches.begin(), branches.end(), [&](const Branch& b) { return b.level == branches.back().level; }));
  const std::size_t first_twig = branches.size() - twig_count;
  // The leaves' total area stays about the same, so that a crown neither thins out nor closes with their number.
  const float leaves = static_cast<float>(budget) / 3;
  const float leaf = size * std::clamp(3.5f / std::sqrt(leaves), 0.004f, 0.2f);
  while (budget >= 2) {
    const int triangles = budget < 4 ? 2 : random.below(2) ? 4 : 2;
    budget -= static_cast<std::size_t>(triangles);
    const Branch& twig = branches[first_twig + random.below(twig_count)];
    const Vec3 twig_along = twig.to - twig.from;
    const Vec3 stem =
        twig.from + random.uniform(0.1f, 1.1f) * twig_along + 0.3f * length(twig_along) * random.in_ball();
    const Vec3 along = normalize(normalize(twig_along) + 0.8f * random.direction() + Vec3{0, -0.35f, 0});
    const Vec3 across = normalize(cross(along, Vec3{0, 1, 0} + 0.9f * random.direction()));
    const float grown = leaf * random.uniform(0.6f, 1.2f);
    add_leaf(builder, stem, grown * along, 0.3f * grown * across, 0.4f * grown * cross(across, along), triangles);
  }
}

void add_grass(MeshBuilder& builder, float reach, std::size_t budget, Random& random) {
  const float height = std::clamp(4.5f * reach / std::sqrt(static_cast<float>(budget) + 1), 0.03f, 0.4f);
  for (; budget >= 3; budget -= 3) {
    const float distance = reach * std::sqrt(random.uniform()), angle = random.uniform(0, 6.2831853f);
    const float heading = random.uniform(0, 6.2831853f), tall = height * random.uniform(0.5f, 1.3f);
    const Vec3 across{std::cos(heading), 0, std::sin(heading)}, front{-across.z, 0, across.x};
    const Vec3 along = normalize(Vec3{0, 1, 0} + 0.35f * random.in_ball());
    add_leaf(builder, {distance * std::cos(angle), 0, distance * std::sin(angle)}, tall * along, 0.09f * tall * across,
             tall * 0.5f * front, 3);
  }
}

void add_tree(MeshBuilder& builder, Vec3 foot, float size, std::size_t budget, Random& random) {
  const std::vector<Branch> branches = grow(foot, size, random);
  const std::size_t before = builder.triangle_count();
  constexpr int kSides = 5;
  for (const Branch& b : branches) {
    if (builder.triangle_count() - before + 2 * kSides > budget / 20) break;  // thick ones first
    builder.tube(b.from, b.to, b.radius, 0.4f * b.radius, kSides);
  }
  add_crown(builder, branches, size, budget - (builder.triangle_count() - before), random);
}

}  // namespace

Scene make_foliage(const SceneOptions& options) {
  const std::size_t trees = std::clamp<std::size_t>(options.triangles / 30'000, 1, 240);
  const std::size_t grass = options.triangles < 1000 ? 0 : options.triangles / 5;
  const std::size_t per_tree = (options.triangles - grass - 2) / trees;
  const float spread = 1.55f * std::sqrt(static_cast<float>(trees));
  const float meadow = spread + 2.2f;

  MeshBuilder builder(MeshBuilder::Purpose::build);
  builder.reserve(options.triangles / 2 * 3, options.triangles);
  const float ground = meadow + 3.8f;
  builder.quad({-ground, 0, ground}, {ground, 0, ground}, {ground, 0, -ground}, {-ground, 0, -ground});
  for (std::size_t i = 0; i < trees; ++i) {
    Random random(options.seed, 2 * i + 1);
    // A sunflower's spiral spreads any number of trees evenly.
    const float distance = spread * std::sqrt((static_cast<float>(i) + 0.4f) / static_cast<float>(trees));
    const float angle = 2.39996f * static_cast<float>(i) + 0.5f + random.uniform(-0.12f, 0.12f);
    const Vec3 foot = trees == 1 ? Vec3{} : Vec3{distance * std::cos(angle), 0, distance * std::sin(angle)};
    add_tree(builder, foot, random.uniform(1.7f, 2.7f), per_tree, random);
  }
  Random random(options.seed, 0);
  if (grass) add_grass(builder, meadow, options.triangles - builder.triangle_count(), random);
  Scene scene;
  scene.mesh = builder.take();
  scene.view = {.eye = {0.3f * spread, 1.2f, spread + 5.2f}, .look_at = {0, 1.5f, 0}, .up = {0, 1, 0}, .fov = 45};
  return scene;
}

}  // namespace boxwood::mesh::procedural
