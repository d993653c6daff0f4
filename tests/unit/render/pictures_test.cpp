#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "boxwood/render.h"
#include "render/color.h"
#include "render/color_scale.h"
#include "support/effort.h"
#include "test_meshes.h"

namespace boxwood::render {
namespace {

constexpr Shade kAllShades[] = {Shade::normals, Shade::ao,         Shade::depth,    Shade::nodes,   Shade::primitives,
                                Shade::ids,     Shade::subdivided, Shade::clusters, Shade::children};

Rgb pixel(const Image& image, int x, int y) {
  const std::uint8_t* p = &image.rgb[3 * (static_cast<std::size_t>(y) * image.width + x)];
  return {p[0], p[1], p[2]};
}

int brightness(Rgb color) {
  return color[0] + color[1] + color[2];
}

Image picture(const Accel& accel, const View& view, int width, int height, Shade shade) {
  auto image = render(accel, view, width, height, shade);
  if (!image) throw std::runtime_error(image.error().message);
  EXPECT_EQ(image->width, width);
  EXPECT_EQ(image->height, height);
  EXPECT_EQ(image->rgb.size(), 3 * static_cast<std::size_t>(width) * height);
  return std::move(*image);
}

std::set<Rgb> colors(const Image& image) {
  std::set<Rgb> found;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) found.insert(pixel(image, x, y));
  return found;
}

TEST(FindShade, KnowsAllNamesAndListsThemForAnUnknownOne) {
  const char* names[] = {"normals", "ao", "depth", "nodes", "primitives", "ids", "subdivided", "clusters", "children"};
  for (std::size_t i = 0; i < std::size(kAllShades); ++i) {
    const auto shade = find_shade(names[i]);
    ASSERT_TRUE(shade);
    EXPECT_EQ(*shade, kAllShades[i]);
  }
  for (const char* wrong : {"", "Normals", "heat", "ao "}) {
    const auto shade = find_shade(wrong);
    ASSERT_FALSE(shade);
    EXPECT_EQ(shade.error().code, ErrorCode::unknown_name);
    EXPECT_NE(shade.error().message.find("normals, ao, depth, nodes, primitives, ids, subdivided, clusters, children"),
              std::string::npos);
    EXPECT_NE(shade.error().message.find('"' + std::string(wrong) + '"'), std::string::npos);
  }
}

TEST(Render, MarkedTrianglesAreRedAndOnlyThose) {
  const Accel accel = build(square(1));  // two triangles
  const Image plain = picture(accel, kFromAbove, 40, 40, Shade::normals);
  const auto unmarked = render(accel, kFromAbove, 40, 40, Shade::subdivided);
  ASSERT_TRUE(unmarked);
  EXPECT_EQ(unmarked->rgb, plain.rgb);
  const std::vector<std::uint32_t> marks = {0, 1};
  EXPECT_EQ(render(accel, kFromAbove, 40, 40, Shade::normals, marks)->rgb, plain.rgb);
  const auto image = render(accel, kFromAbove, 40, 40, Shade::subdivided, marks);
  ASSERT_TRUE(image);
  const Image ids = picture(accel, kFromAbove, 40, 40, Shade::ids);
  std::set<Rgb> changed_ids, kept_ids;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      const Rgb before = pixel(plain, x, y), after = pixel(*image, x, y);
      (before == after ? kept_ids : changed_ids).insert(pixel(ids, x, y));
      if (before != after) {
        EXPECT_GT(after[0], 2 * after[1]) << x << ", " << y;
      }
    }
  EXPECT_EQ(changed_ids.size(), 1u);  // all of one triangle
  EXPECT_FALSE(kept_ids.contains(*changed_ids.begin()));
}

TEST(Render, RefusesWhatPrimaryRaysRefuses) {
  const Accel accel = build(square(1));
  View bad = kFromAbove;
  bad.look_at = bad.eye;
  for (const Shade shade : kAllShades) {
    EXPECT_EQ(render(accel, kFromAbove, 0, 5, shade).error().message, primary_rays(kFromAbove, 0, 5).error().message);
    EXPECT_EQ(render(accel, kFromAbove, 5, 16385, shade).error().code, ErrorCode::out_of_range);
    EXPECT_EQ(render(accel, bad, 5, 5, shade).error().message, primary_rays(bad, 5, 5).error().message);
  }
  const auto unknown = render(accel, kFromAbove, 4, 4, static_cast<Shade>(77));
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, ErrorCode::invalid_argument);
  EXPECT_NE(unknown.error().message.find("77"), std::string::npos);
}

TEST(Render, AnySizeAndAnyMeshWorksForEveryShade) {
  TriangleMesh broken = square(1);
  broken.vertices[1].x = std::nanf("");
  TriangleMesh equal = square(1);
  for (int i = 0; i < 20; ++i) equal.triangles.push_back(equal.triangles[0]);
  TriangleMesh line;
  line.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  line.triangles = {{0, 1, 2}};
  for (const TriangleMesh& mesh : {TriangleMesh{}, square(1), broken, equal, line, square(1e17f), square(1e-30f)}) {
    const Accel accel = build(mesh);
    for (const Shade shade : kAllShades)
      for (const auto& [width, height] : {std::pair{1, 1}, std::pair{2, 1}, std::pair{1, 3}, std::pair{37, 23}})
        picture(accel, kFromAbove, width, height, shade);
  }
  const Accel accel = build(square(1));
  for (const Shade shade : kAllShades) {
    picture(accel, kFromAbove, 16384, 2, shade);
    picture(accel, kFromAbove, 1, 16384, shade);
  }
}

TEST(Render, EmptyMeshShowsTheBackgroundOnly) {
  const Accel accel = build(TriangleMesh{});
  const Image backdrop = picture(accel, kFromAbove, 60, 40, Shade::normals);
  for (int y = 0; y < 40; ++y)
    for (int x = 1; x < 60; ++x) ASSERT_EQ(pixel(backdrop, x, y), pixel(backdrop, 0, y));
  EXPECT_GT(colors(backdrop).size(), 10u);
  EXPECT_LT(brightness(pixel(backdrop, 0, 0)), brightness(pixel(backdrop, 0, 39)));
  EXPECT_EQ(picture(accel, kFromAbove, 60, 40, Shade::ids).rgb, backdrop.rgb);
  EXPECT_EQ(picture(accel, kFromAbove, 60, 40, Shade::ao).rgb, backdrop.rgb);
  EXPECT_EQ(colors(picture(accel, kFromAbove, 60, 40, Shade::depth)).size(), 1u);
  EXPECT_EQ(colors(picture(accel, kFromAbove, 60, 40, Shade::primitives)), std::set<Rgb>{heat_color(0)});
}

TEST(Render, BackgroundExactlyWhereNothingIsHit) {
  const Accel accel = build(icosphere(2));
  const Accel nothing = build(TriangleMesh{});
  const int width = 300, height = test::kInstrumented ? 40 : 250;  // 250: more than one batch
  const auto primary = *primary_rays(kFromAbove, width, height);
  for (const Shade shade : {Shade::normals, Shade::ao, Shade::ids}) {
    const Image image = picture(accel, kFromAbove, width, height, shade);
    const Image backdrop = picture(nothing, kFromAbove, width, height, shade);
    std::size_t hits = 0, changed = 0;
    for (std::size_t i = 0; i < primary.size(); ++i) {
      const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
      const bool differs = pixel(image, x, y) != pixel(backdrop, x, y);
      if (accel.closest_hit(primary[i]))
        ++hits, changed += differs;
      else
        ASSERT_FALSE(differs) << x << ' ' << y;
    }
    EXPECT_GT(hits, test::effort(5000, 20));
    EXPECT_GT(changed, hits * 99 / 100);
  }
}

TEST(Render, IdsAreOneColourPerTriangle) {
  const Accel accel = build(icosphere(1));
  const int size = 280;
  const auto primary = *primary_rays(kFromAbove, size, size);
  const Image image = picture(accel, kFromAbove, size, size, Shade::ids);
  std::map<std::uint32_t, Rgb> color_of;
  std::set<Rgb> distinct;
  for (std::size_t i = 0; i < primary.size(); ++i) {
    const Hit hit = accel.closest_hit(primary[i]);
    if (!hit) continue;
    const Rgb color = pixel(image, static_cast<int>(i) % size, static_cast<int>(i) / size);
    const auto [place, is_new] = color_of.try_emplace(hit.primitive, color);
    ASSERT_EQ(place->second, color) << "triangle " << hit.primitive;
    distinct.insert(color);
  }
  EXPECT_GT(color_of.size(), 20u);
  EXPECT_EQ(distinct.size(), color_of.size());
}

TEST(Render, ClustersAreOneColourPerNumber) {
  const Accel accel = build(square(1));
  const int size = 31;
  const auto difference = [&](std::vector<std::uint32_t> groups) {
    const auto image = render(accel, kFromAbove, size, size, Shade::clusters, groups);
    if (!image) throw std::runtime_error(image.error().message);
    // Above and below the centre: the two triangles, seen at one angle.
    const Rgb upper = pixel(*image, 15, 11), lower = pixel(*image, 15, 19);
    int sum = 0;
    for (std::size_t c = 0; c < 3; ++c) sum += std::abs(upper[c] - lower[c]);
    return sum;
  };
  EXPECT_LE(difference({7, 7}), 3);  // rounding
  EXPECT_GT(difference({7, 8}), 20);
}

TEST(Render, NormalsAreLightestWhereTheSurfaceFacesTheEyeAndSeeBothSides) {
  const Image image = picture(build(icosphere(5)), kFromAbove, 201, 201, Shade::normals);
  const int centre = brightness(pixel(image, 100, 100));
  int darkest = centre;
  for (int x = 0; x < 201; ++x) darkest = std::min(darkest, brightness(pixel(image, x, 100)));
  EXPECT_LT(darkest, centre * 3 / 4);
  View below = kFromAbove;
  below.eye.z = -5;
  const Accel flat = build(square(1));
  EXPECT_GT(brightness(pixel(picture(flat, below, 31, 31, Shade::normals), 15, 15)), 400);
  EXPECT_GT(brightness(pixel(picture(flat, kFromAbove, 31, 31, Shade::normals), 15, 15)), 400);
}

TEST(Render, DepthIsLighterWhereNearerAndDarkestWhereNothingIs) {
  TriangleMesh steps = square(1, 0);
  add_quad(steps, {-1, -1, 1}, {1, 0, 0}, {0, 2, 0});
  const Image image = picture(build(steps), kFromAbove, 101, 101, Shade::depth);
  const int near = brightness(pixel(image, 40, 50)), far = brightness(pixel(image, 60, 50));
  const int nothing = brightness(pixel(image, 0, 0));
  EXPECT_GT(near, far + 200);
  EXPECT_GT(far, nothing + 30);
  // Planes that face the camera have one depth: it is measured along the view, not along the ray.
  EXPECT_EQ(pixel(image, 40, 50), pixel(image, 32, 35));
  EXPECT_EQ(pixel(image, 60, 50), pixel(image, 66, 65));
}

TEST(Render, AmbientOcclusionIsDarkInCornersAndLightInTheOpen) {
  TriangleMesh room = square(2);
  add_quad(room, {-0.5f, -2, 0}, {0, 4, 0}, {0, 0, 1.5f});
  const Image image =
      picture(build(room), {.eye = {1.2f, 0, 3}, .look_at = {0.7f, 0, 0}, .fov = 50}, 120, 120, Shade::ao);
  const Image open = picture(build(square(2)), kFromAbove, 60, 60, Shade::ao);
  EXPECT_EQ(colors(picture(build(square(50)), kFromAbove, 60, 60, Shade::ao)).size(), 1u);
  const int free = brightness(pixel(open, 30, 30));
  EXPECT_GT(free, 650);
  int darkest = free;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 120; ++x) darkest = std::min(darkest, brightness(pixel(image, x, y)));
  EXPECT_LT(darkest, free - 100);
}

TEST(Render, AmbientOcclusionInsideASmallClosedRoomIsAllDark) {
  // A long tube: nothing is farther from anything than a fifth of the diagonal.
  TriangleMesh tube;
  add_quad(tube, {-1, -1, -20}, {2, 0, 0}, {0, 0, 40});
  add_quad(tube, {-1, 1, -20}, {2, 0, 0}, {0, 0, 40});
  add_quad(tube, {-1, -1, -20}, {0, 2, 0}, {0, 0, 40});
  add_quad(tube, {1, -1, -20}, {0, 2, 0}, {0, 0, 40});
  const View inside{.eye = {0, 0, 0}, .look_at = {1, 0, 0}, .fov = 60};
  const Image image = picture(build(tube), inside, 50, 50, Shade::ao);
  EXPECT_LT(brightness(pixel(image, 25, 25)), 150);
}

TEST(Render, HeatMapsColourTheCountsAndCarryAScale) {
  const Accel accel = build(icosphere(4));
  const int width = 400, height = 300;
  const auto primary = *primary_rays(kFromAbove, width, height);
  std::vector<Hit> hits(primary.size());
  std::vector<queries::Counts> counts(primary.size());
  ASSERT_TRUE(accel.closest_hits_counted(primary, hits, counts));
  for (const Shade shade : {Shade::nodes, Shade::primitives}) {
    std::vector<std::uint64_t> work;
    for (const auto& count : counts) work.push_back(shade == Shade::nodes ? count.nodes : count.primitives);
    std::vector<std::uint64_t> sorted = work;
    std::sort(sorted.begin(), sorted.end());
    const auto rank = static_cast<std::size_t>(std::ceil(0.995 * static_cast<double>(sorted.size())));
    const ColorScale scale = ColorScale::up_to(static_cast<std::uint32_t>(sorted[rank - 1]));
    const Image image = picture(accel, kFromAbove, width, height, shade);
    for (int y = 0; y < height / 2; ++y)
      for (int x = 0; x < width; ++x) {
        const auto value = static_cast<double>(work[static_cast<std::size_t>(y) * width + x]);
        ASSERT_EQ(pixel(image, x, y), heat_color(value / scale.upper)) << x << ' ' << y;
      }
    std::set<Rgb> corner;
    for (int y = height / 2; y < height; ++y)
      for (int x = 0; x < width / 2; ++x) corner.insert(pixel(image, x, y));
    EXPECT_TRUE(corner.contains({245, 245, 245})) << "the letters of the scale are missing";
    EXPECT_GT(corner.size(), 50u);
  }
}

TEST(Render, HeatMapsThatAreTooSmallForAScaleHaveNone) {
  const Accel accel = build(icosphere(3));
  const Image image = picture(accel, kFromAbove, 90, 70, Shade::nodes);
  std::set<Rgb> ramp;
  for (int i = 0; i <= 4096; ++i) ramp.insert(heat_color(i / 4096.0));
  for (const Rgb& color : colors(image)) EXPECT_TRUE(ramp.contains(color));
}

TEST(Render, SameBitsOnEveryExecutor) {
  TriangleMesh mesh = icosphere(3);
  add_quad(mesh, {-3, -3, -1}, {6, 0, 0}, {0, 6, 0});
  const View view{.eye = {2, 2, 3}, .look_at = {0, 0, 0}, .fov = 50};
  const int width = test::kInstrumented ? 96 : 320, height = test::kInstrumented ? 72 : 240;
  for (const Shade shade : kAllShades) {
    const Image reference = picture(build(mesh, std::make_shared<SequentialExecutor>()), view, width, height, shade);
    EXPECT_GT(colors(reference).size(), test::kInstrumented ? 2u : 20u) << "something is to be seen";
    for (const int threads : test::thread_counts())
      EXPECT_EQ(picture(build(mesh, std::make_shared<ThreadExecutor>(threads)), view, width, height, shade).rgb,
                reference.rgb)
          << "shade " << static_cast<int>(shade) << ", " << threads << " threads";
  }
}

TEST(Render, ChildrenHaveFourColours) {
  const Accel accel = build(square(1));
  std::set<std::set<Rgb>> pictures;
  for (const std::uint32_t number : {0u, 1u, 2u, 3u})
    pictures.insert(colors(*render(accel, kFromAbove, 24, 24, Shade::children, std::vector(2, number))));
  EXPECT_EQ(pictures.size(), 4u);
  const auto parted = render(accel, kFromAbove, 24, 24, Shade::children, std::vector{1u, 2u});
  EXPECT_EQ(pictures.count(colors(*parted)), 0u);
  // Triangles without a number are below neither child.
  const auto none = render(accel, kFromAbove, 24, 24, Shade::children, std::vector(2, 0u));
  EXPECT_EQ(render(accel, kFromAbove, 24, 24, Shade::children)->rgb, none->rgb);
}
}  // namespace
}  // namespace boxwood::render
