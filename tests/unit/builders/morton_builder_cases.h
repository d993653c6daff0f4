// What the tests of the Morton builders share: reference sets without a mesh, and a build that must succeed.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "boxwood/builders.h"
#include "boxwood/metrics.h"
#include "boxwood/tree.h"

namespace boxwood::test {

inline refs::ReferenceSet reference_set(const std::vector<Box>& boxes) {
  refs::ReferenceSet set;
  set.references = AlignedBuffer<refs::Reference>(boxes.size());
  set.primitive_count = boxes.size();
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    set.references[i] = {boxes[i].lower, std::uint32_t(i), boxes[i].upper, 0};
    set.bounds.grow(boxes[i]);
  }
  return set;
}

using Settings = std::map<std::string, std::string>;

/// Builds and validates.
inline tree::BinaryTree build_valid(const std::vector<Box>& boxes, const std::string& builder, const Settings& settings,
                                    Executor& executor, std::size_t max_leaf = 0) {
  auto tree = builders::build(reference_set(boxes), {builder, settings}, {executor});
  EXPECT_TRUE(tree) << (tree ? "" : tree.error().message);
  if (!tree) return {};
  const auto status = tree::validate(*tree, {boxes, max_leaf});
  EXPECT_TRUE(status) << (status ? "" : status.error().message);
  return std::move(*tree);
}

inline tree::BinaryTree build_valid(const std::vector<Box>& boxes, const std::string& builder,
                                    const Settings& settings = {}) {
  SequentialExecutor executor;
  return build_valid(boxes, builder, settings, executor);
}

/// Two triangles for each cell of a bumpy sheet that is folded back on itself, as a scanner would see cloth.
inline std::vector<Box> scan_boxes(int cells) {
  const auto point = [&](int i, int j) {
    const float u = 6.2831853f * float(i) / float(cells), v = 6.2831853f * float(j) / float(cells);
    const float radius = 3 + std::cos(v) + 0.2f * std::sin(7 * u) * std::sin(5 * v);
    return Vec3{radius * std::cos(u), radius * std::sin(u), std::sin(v) + 0.1f * std::cos(9 * u)};
  };
  std::vector<Box> boxes;
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      const Vec3 a = point(i, j), b = point(i + 1, j), c = point(i, j + 1), d = point(i + 1, j + 1);
      boxes.push_back(Triangle{a, b, c}.bounds());
      boxes.push_back(Triangle{c, b, d}.bounds());
    }
  }
  return boxes;
}

inline std::vector<Box> random_boxes(std::size_t count, std::uint32_t seed, float size = 0.1f) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> position(-10, 10), extent(0, size);
  std::vector<Box> boxes(count);
  for (Box& box : boxes) {
    const Vec3 lower{position(random), position(random), position(random)};
    box = {lower, lower + Vec3{extent(random), extent(random), extent(random)}};
  }
  return boxes;
}

/// Sets that upset a builder which trusts its codes.
inline std::map<std::string, std::vector<Box>> difficult_sets() {
  std::map<std::string, std::vector<Box>> sets;
  sets["one"] = random_boxes(1, 1);
  sets["two"] = random_boxes(2, 2);
  sets["two equal"] = {2, Box{{1, 2, 3}, {4, 5, 6}}};
  sets["equal"] = {1000, Box{{1, 2, 3}, {4, 5, 6}}};
  sets["points"] = {1000, Box{{1, 2, 3}, {1, 2, 3}}};
  for (int i = 0; i < 1000; ++i) {
    const float x = float(i);
    sets["collinear"].push_back({{x, 2 * x, 3 * x}, {x + 1, 2 * x + 1, 3 * x + 1}});
    sets["along an axis"].push_back({{x, 0, 0}, {x, 0, 0}});
    sets["coplanar"].push_back({{float(i % 31), float(i / 31), 7}, {float(i % 31) + 1, float(i / 31) + 1, 7}});
    sets["nested"].push_back({{-x, -x, -x}, {x, x, x}});
    const float power = std::ldexp(1.0f, -(i % 120));
    sets["exponential"].push_back({{power, power, 0}, {power, power, 0}});
  }
  sets["with an outlier"] = random_boxes(999, 3);
  sets["with an outlier"].push_back({{1e18f, 1e18f, 1e18f}, {1e18f, 1e18f, 1e18f}});
  for (const float scale : {5e16f, 1e-30f, 1e-44f}) {
    auto boxes = random_boxes(500, 4, 3);
    for (Box& box : boxes) box = {box.lower * scale, box.upper * scale};
    sets["scaled by " + std::to_string(std::log10(scale))] = boxes;
  }
  return sets;
}

}  // namespace boxwood::test
