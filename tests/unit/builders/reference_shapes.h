// Sets of references for the builders' tests: plain ones and those that heuristics stumble over.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "boxwood/refs.h"
#include "support/effort.h"

namespace boxwood::testing {

using Boxes = std::vector<Box>;

/// Uniform in [0, 1), the same on every machine.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  float operator()() { return static_cast<float>(engine_() >> 8) * 0x1p-24f; }
  Vec3 vector() {
    const float x = (*this)(), y = (*this)(), z = (*this)();
    return {x, y, z};
  }

 private:
  std::mt19937 engine_;
};

inline refs::ReferenceSet reference_set(const Boxes& boxes) {
  refs::ReferenceSet set;
  set.primitive_count = boxes.size();
  set.references = AlignedBuffer<refs::Reference>(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    set.references[i] = {boxes[i].lower, static_cast<std::uint32_t>(i), boxes[i].upper, 0};
    set.bounds.grow(boxes[i]);
  }
  return set;
}

/// `count` boxes made one by one.
inline Boxes make_boxes(std::size_t count, const std::function<Box(std::size_t)>& make) {
  Boxes boxes(count);
  for (std::size_t i = 0; i < count; ++i) boxes[i] = make(i);
  return boxes;
}

inline Boxes soup(std::size_t count, std::uint32_t seed, float scale = 1) {
  Random random(seed);
  const float size = std::fmin(0.5f, 2.0f / std::cbrt(static_cast<float>(count + 1)));
  return make_boxes(count, [&](std::size_t) {
    const Vec3 corner = random.vector() * (1 - size);  // all boxes stay within [0, 1]
    return Box{corner * scale, (corner + random.vector() * size) * scale};
  });
}

/// A wavy height field of flat squares, side by side, like a scanned surface.
inline Boxes height_field(std::size_t side) {
  const auto height = [](std::size_t x, std::size_t y) {
    return std::sin(0.1f * static_cast<float>(x)) + std::cos(0.07f * static_cast<float>(y));
  };
  return make_boxes(side * side, [&](std::size_t i) {
    const std::size_t x = i % side, y = i / side;
    Box box;
    for (const std::size_t dx : {0, 1})
      for (const std::size_t dy : {0, 1})
        box.grow(Vec3{static_cast<float>(x + dx), static_cast<float>(y + dy), 3 * height(x + dx, y + dy)});
    return box;
  });
}

struct Shape {
  const char* name;
  Boxes boxes;
};

/// What every builder must cope with. Coordinates stay within what meshes may have.
inline std::vector<Shape> awkward_shapes() {
  std::vector<Shape> shapes;
  const Box unit{{0, 0, 0}, {1, 1, 1}};
  Random random(7);
  shapes.push_back({"one", {unit}});
  shapes.push_back({"two", {unit, {{2, 0, 0}, {3, 1, 1}}}});
  shapes.push_back({"two_equal", {unit, unit}});
  shapes.push_back({"three", {unit, {{2, 0, 0}, {3, 1, 1}}, {{0, 5, 0}, {1, 6, 1}}}});
  shapes.push_back({"equal", Boxes(1000, unit)});
  shapes.push_back({"equal_points", Boxes(1000, Box{{1, 2, 3}, {1, 2, 3}})});
  shapes.push_back({"concentric", make_boxes(500, [](std::size_t i) {
                      const float r = static_cast<float>(i + 1);
                      return Box{{-r, -r, -r}, {r, r, r}};
                    })});
  shapes.push_back({"coplanar", make_boxes(700, [&](std::size_t) {
                      const float x = random(), y = random();
                      return Box{{x, y, 5}, {x + 0.1f, y + 0.1f, 5}};
                    })});
  shapes.push_back({"collinear", make_boxes(700, [&](std::size_t) {
                      const float x = random();
                      return Box{{x, 2, 5}, {x + 0.01f, 2, 5}};
                    })});
  shapes.push_back({"collinear_diagonal", make_boxes(700, [&](std::size_t) {
                      const float x = random();
                      return Box{{x, x, x}, {x, x, x}};
                    })});
  shapes.push_back({"huge", soup(800, 1, 9e17f)});
  shapes.push_back({"huge_opposite", make_boxes(300, [&](std::size_t i) {
                      const float x = i % 2 ? 1e18f : -1e18f;
                      return Box{{x, -1e18f, random()}, {x, 1e18f, 2}};
                    })});
  shapes.push_back({"tiny", soup(800, 2, 1e-30f)});
  shapes.push_back({"denormal", soup(800, 3, 1e-40f)});
  shapes.push_back({"far_apart_scales", make_boxes(600, [&](std::size_t i) {
                      const float s = i % 3 == 0 ? 1e-20f : i % 3 == 1 ? 1.0f : 1e15f;
                      const Vec3 p = random.vector() * s;
                      return Box{p, p + random.vector() * s};
                    })});
  shapes.push_back({"slivers", make_boxes(900, [&](std::size_t i) {
                      const Vec3 p = random.vector();
                      Vec3 size{1e-6f, 1e-6f, 1e-6f};
                      size[static_cast<int>(i % 3)] = 1;
                      return Box{p, p + size};
                    })});
  shapes.push_back({"exponential", make_boxes(200, [](std::size_t i) {
                      const float x = std::ldexp(1.0f, 50 - static_cast<int>(i));
                      return Box{{x, 0, 0}, {1.25f * x, x, x}};
                    })});
  shapes.push_back({"neighbouring_floats", make_boxes(64, [](std::size_t i) {
                      float x = 1;
                      for (std::size_t k = 0; k < i / 8; ++k) x = std::nextafter(x, 2.0f);
                      return Box{{x, 1, 1}, {x, 1, 2}};
                    })});
  shapes.push_back({"one_far_away", make_boxes(500, [&](std::size_t i) {
                      const Vec3 p = i == 250 ? Vec3{1e12f, 1e12f, 1e12f} : random.vector();
                      return Box{p, p + Vec3{0.01f, 0.01f, 0.01f}};
                    })});
  shapes.push_back({"soup", soup(3000, 4)});
  shapes.push_back({"height_field", height_field(50)});
  if (test::kInstrumented)
    for (Shape& shape : shapes) shape.boxes.resize(std::min<std::size_t>(shape.boxes.size(), 300));
  return shapes;
}

}  // namespace boxwood::testing
