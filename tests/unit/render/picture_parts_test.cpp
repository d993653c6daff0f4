// The parts pictures are made of: numbers per pixel, the colour ramp, the scale, the font, the smoothing of occlusion.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "render/bitmap_font.h"
#include "render/color.h"
#include "render/color_scale.h"
#include "render/occlusion_filter.h"
#include "render/sampling.h"
#include "render/value_plane.h"

namespace boxwood::render {
namespace {

Image blank(int width, int height) {
  return {width, height, std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) * height)};
}

std::size_t count_color(const Image& image, Rgb color) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3)
    count += std::equal(color.begin(), color.end(), image.rgb.begin() + static_cast<std::ptrdiff_t>(i));
  return count;
}

TEST(ValuePlane, KeepsNumbersAndSaturates) {
  Image image = blank(4, 1);
  ValuePlane plane(image);
  plane.set(0, 0), plane.set(1, 0x123456), plane.set(2, ~0ull), plane.set_nothing(3);
  EXPECT_EQ(plane[0], 0u);
  EXPECT_EQ(plane[1], 0x123456u);
  EXPECT_EQ(plane[2], ValuePlane::kLargest);
  EXPECT_EQ(plane[3], ValuePlane::kNothing);
  const auto summary = plane.summarize();
  EXPECT_EQ(summary.count, 3u);
  EXPECT_EQ(summary.smallest, 0u);
  EXPECT_EQ(summary.largest, ValuePlane::kLargest);
}

TEST(ValuePlane, QuantilesAreThoseOfTheSortedNumbers) {
  Image image = blank(100, 37);
  ValuePlane plane(image);
  std::vector<std::uint32_t> values;
  double sum = 0;
  for (std::size_t i = 0; i < plane.size(); ++i) {
    if (i % 7 == 0) {
      plane.set_nothing(i);
      continue;
    }
    // Numbers of all sizes, many of them equal.
    const std::uint64_t bits = random_bits(1, i, 0);
    values.push_back(static_cast<std::uint32_t>((bits >> 40) >> (bits & 23)));
    values.back() = std::min(values.back(), ValuePlane::kLargest);
    plane.set(i, values.back());
    sum += values.back();
  }
  std::sort(values.begin(), values.end());
  for (const double share : {0.0, 0.001, 0.25, 0.5, 0.995, 0.9999, 1.0}) {
    const double rank = std::max(std::ceil(share * static_cast<double>(values.size())), 1.0);
    EXPECT_EQ(plane.quantile(share), values[static_cast<std::size_t>(rank) - 1]) << share;
  }
  EXPECT_DOUBLE_EQ(plane.summarize().mean, sum / static_cast<double>(values.size()));
}

TEST(ValuePlane, WithoutNumbersEverythingIsZero) {
  Image image = blank(3, 3);
  ValuePlane plane(image);
  for (std::size_t i = 0; i < plane.size(); ++i) plane.set_nothing(i);
  EXPECT_EQ(plane.quantile(0.5), 0u);
  EXPECT_EQ(plane.summarize().count, 0u);
  EXPECT_EQ(plane.summarize().largest, 0u);
}

TEST(HeatColor, LightnessRisesAllTheWayFromDarkBlueToYellow) {
  const auto luminance = [](Rgb c) {
    return 0.2126 * std::pow(c[0], 2.2) + 0.7152 * std::pow(c[1], 2.2) + 0.0722 * std::pow(c[2], 2.2);
  };
  double last = -1;
  for (int i = 0; i <= 64; ++i) {
    const double now = luminance(heat_color(i / 64.0));
    EXPECT_GT(now, last) << i;
    last = now;
  }
  const Rgb dark = heat_color(0), light = heat_color(1);
  EXPECT_GT(dark[2], dark[0]);
  EXPECT_GT(dark[2], dark[1]);
  EXPECT_GT(light[0], 200);
  EXPECT_GT(light[1], 200);
  EXPECT_LT(light[2], light[1]);
  EXPECT_EQ(heat_color(-3), dark);
  EXPECT_EQ(heat_color(7), light);
}

TEST(Color, KnownPoints) {
  EXPECT_EQ(to_srgb({0, 0, 0}), (Rgb{0, 0, 0}));
  EXPECT_EQ(to_srgb({1, 1, 1}), (Rgb{255, 255, 255}));
  EXPECT_EQ(to_srgb({-1, 2, 0.2140411f}), (Rgb{0, 255, 128 - 1}));
  EXPECT_EQ(to_srgb(from_oklab(1, 0, 0)), (Rgb{255, 255, 255}));
  EXPECT_EQ(to_srgb(from_oklab(0, 0, 0)), (Rgb{0, 0, 0}));
  // Pure red in Oklab.
  EXPECT_EQ(to_srgb(from_oklab(0.62795536, 0.22486306, 0.12584630)), (Rgb{255, 0, 0}));
}

TEST(ColorScale, RoundStepsThatReachTheNumber) {
  for (const std::uint32_t value : {0u, 1u, 2u, 5u, 6u, 7u, 10u, 11u, 57u, 99u, 100u, 101u, 1234u, 16777214u}) {
    const ColorScale scale = ColorScale::up_to(value);
    EXPECT_GE(scale.upper, value);
    EXPECT_GE(scale.upper, 1u);
    EXPECT_EQ(scale.upper % scale.step, 0u);
    EXPECT_LE(scale.upper / scale.step, 5u);
    EXPECT_LT(scale.upper - std::max(value, 1u), scale.step);
    std::uint32_t leading = scale.step;
    while (leading % 10 == 0) leading /= 10;
    EXPECT_TRUE(leading == 1 || leading == 2 || leading == 5) << scale.step;
  }
  EXPECT_EQ(ColorScale::up_to(57).upper, 60u);
  EXPECT_EQ(ColorScale::up_to(57).step, 20u);
}

TEST(DrawColorScale, DrawsTheRampAndOnlyInTheLowerLeftCorner) {
  Image image = blank(400, 300);
  std::fill(image.rgb.begin(), image.rgb.end(), 77);
  ASSERT_TRUE(draw_color_scale(image, {60, 20}, "nodes visited per ray", {1000, 0, 118, 23.4}));
  std::set<std::array<std::uint8_t, 3>> ramp, drawn;
  for (int i = 0; i <= 4096; ++i) ramp.insert(heat_color(i / 4096.0));
  for (std::size_t i = 0; i < image.rgb.size(); i += 3)
    if (const Rgb color{image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]}; ramp.contains(color)) drawn.insert(color);
  EXPECT_GT(drawn.size(), 90u);
  EXPECT_GT(count_color(image, {245, 245, 245}), 100u);
  for (int y = 0; y < 150; ++y)
    for (int x = 0; x < 400; ++x) ASSERT_EQ(image.rgb[3 * (static_cast<std::size_t>(y) * 400 + x)], 77);
  for (int y = 0; y < 300; ++y)
    for (int x = 300; x < 400; ++x) ASSERT_EQ(image.rgb[3 * (static_cast<std::size_t>(y) * 400 + x)], 77);
}

TEST(DrawColorScale, LeavesSmallPicturesAlone) {
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{100, 100}, std::pair{1000, 60}, std::pair{60, 1000}}) {
    Image image = blank(width, height);
    const Image before = image;
    EXPECT_FALSE(draw_color_scale(image, {60, 20}, "nodes visited per ray", {1000, 0, 118, 23.4}));
    EXPECT_EQ(image.rgb, before.rgb);
  }
}

TEST(DrawColorScale, AnySizeAndAnyNumberStaysInsideThePicture) {
  // The address sanitizer watches the writes; the sizes step across the smallest one that has room.
  for (int width = 120; width < 260; width += 7)
    for (int height = 100; height < 240; height += 13) {
      Image image = blank(width, height);
      draw_color_scale(image, ColorScale::up_to(16777214), "triangles tested per ray", {1, 0, 16777214, 16777214});
    }
  Image wide = blank(16384, 400);
  EXPECT_TRUE(draw_color_scale(wide, {1, 1}, "nodes visited per ray", {1, 0, 1, 0.5}));
}

TEST(BitmapFont, EveryCharacterInUseHasAGlyphOfItsOwn) {
  const std::string used = "abcdefghijklmnopqrstuvwxyz0123456789.,+:-%()";
  std::vector<Image> drawn;
  for (const char character : used + "\x7f") {
    drawn.push_back(blank(kGlyphAdvance, kGlyphAscent + kGlyphDescent));
    draw_text(drawn.back(), 0, 0, std::string_view(&character, 1), 1, {255, 255, 255});
    EXPECT_GT(count_color(drawn.back(), {255, 255, 255}), 0u) << character;
  }
  for (std::size_t i = 0; i < drawn.size(); ++i)
    for (std::size_t j = i + 1; j < drawn.size(); ++j) EXPECT_NE(drawn[i].rgb, drawn[j].rgb) << used[i] << " and " << j;
}

TEST(BitmapFont, ScalesAndIsCutAtTheEdges) {
  Image small = blank(40, 12), large = blank(120, 36);
  draw_text(small, 2, 1, "ray 7", 1, {255, 255, 255});
  draw_text(large, 6, 3, "ray 7", 3, {255, 255, 255});
  EXPECT_EQ(9 * count_color(small, {255, 255, 255}), count_color(large, {255, 255, 255}));
  EXPECT_EQ(text_width("ray 7", 3), 3 * text_width("ray 7", 1));
  EXPECT_EQ(text_width("", 3), 0);
  Image cut = blank(7, 5);
  draw_text(cut, -3, -2, "mmm", 2, {255, 255, 255});
  EXPECT_GT(count_color(cut, {255, 255, 255}), 0u);
}

/// Feeds a picture through the filter in pieces of `rows_at_once` rows and gives what comes out, -1 where nothing does.
std::vector<float> smooth(const std::vector<OpenPoint>& points, std::size_t width, std::size_t rows_at_once,
                          float radius) {
  const std::size_t height = points.size() / width;
  OcclusionFilter filter(width, height, radius);
  std::vector<float> open;
  for (std::size_t row = 0; row < height; row += rows_at_once) {
    const std::size_t rows = std::min(rows_at_once, height - row);
    const auto room = filter.append_rows(rows);
    std::copy_n(points.begin() + static_cast<std::ptrdiff_t>(row * width), rows * width, room.begin());
    for (std::size_t ready = open.size() / width; ready < filter.ready_rows(); ++ready)
      for (std::size_t column = 0; column < width; ++column) open.push_back(filter.open(column, ready).value_or(-1));
  }
  return open;
}

TEST(OcclusionFilter, TheSizeOfThePiecesDoesNotMatter) {
  const std::size_t width = 13, height = 17;
  std::vector<OpenPoint> points(width * height);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Sample2 sample = random_pair(1, i, 0);
    if (sample.x < 0.2) continue;
    points[i] = {.position = {0.01f * static_cast<float>(i % width), 0.01f * static_cast<float>(i / width), 0},
                 .normal = {0, 0, i % 5 ? 1.0f : -1.0f},
                 .open = static_cast<float>(sample.y)};
  }
  const auto whole = smooth(points, width, height, 1);
  ASSERT_EQ(whole.size(), points.size());
  for (const std::size_t rows : {1, 2, 3, 5, 16}) EXPECT_EQ(smooth(points, width, rows, 1), whole) << rows;
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(whole[i] < 0, points[i].open < 0);
}

TEST(OcclusionFilter, AveragesOneSurfaceAndNeverAcrossEdgesStepsOrGaps) {
  // Four columns each: open floor, dark wall, dark floor one step lower, dark floor far away.
  const std::size_t width = 16, height = 6;
  std::vector<OpenPoint> points;
  for (std::size_t i = 0; i < width * height; ++i) {
    const std::size_t column = i % width, part = column / 4;
    const float x = 0.01f * static_cast<float>(column) + (part == 3 ? 10.0f : 0);
    points.push_back({.position = {x, 0.01f * static_cast<float>(i / width), part == 2 ? -0.5f : 0},
                      .normal = part == 1 ? Vec3{1, 0, 0} : Vec3{0, 0, 1},
                      .open = part == 0 ? (i % 2 ? 0.75f : 0.25f) : 0.0f});
  }
  const auto open = smooth(points, width, 2, 1);
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (i % width >= 4)
      EXPECT_EQ(open[i], 0) << i;
    else
      EXPECT_NEAR(open[i], 0.5f, 0.13f) << i;
  }
}

TEST(OcclusionFilter, OnePixel) {
  EXPECT_EQ(smooth({{.position = {}, .normal = {0, 0, 1}, .open = 0.3f}}, 1, 1, 0), std::vector<float>{0.3f});
  EXPECT_EQ(smooth({{}}, 1, 1, 0), std::vector<float>{-1});
}

}  // namespace
}  // namespace boxwood::render
