#include <gtest/gtest.h>

#include <limits>

#include "boxwood/render.h"

namespace boxwood::render {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
const View kView{.eye = {1, 2, 3}, .look_at = {1, 2, -7}, .up = {0, 1, 0}, .fov = 90};

void expect_near(Vec3 a, Vec3 b, float tolerance = 1e-6f) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

std::vector<Ray> rays_of(const View& view, int width, int height) {
  auto rays = primary_rays(view, width, height);
  EXPECT_TRUE(rays) << (rays ? "" : rays.error().message);
  return rays ? std::move(*rays) : std::vector<Ray>{};
}

void expect_refused(const View& view, int width, int height, ErrorCode code, const std::string& what) {
  const auto rays = primary_rays(view, width, height);
  ASSERT_FALSE(rays);
  EXPECT_EQ(rays.error().code, code);
  EXPECT_NE(rays.error().message.find(what), std::string::npos) << rays.error().message;
}

TEST(PrimaryRays, OnePixelLooksStraightAhead) {
  const auto rays = rays_of(kView, 1, 1);
  ASSERT_EQ(rays.size(), 1u);
  EXPECT_EQ(rays[0].origin, kView.eye);
  EXPECT_EQ(rays[0].direction, (Vec3{0, 0, -1}));
  EXPECT_EQ(rays[0].tmin, 0);
  EXPECT_EQ(rays[0].tmax, kInfinity);
}

TEST(PrimaryRays, CentreOfAnOddPictureIsTheViewDirection) {
  const View view{.eye = {1, -2, 3}, .look_at = {4, 5, -6}, .up = {0, 0, 1}, .fov = 33};
  const auto rays = rays_of(view, 7, 5);
  expect_near(rays[2 * 7 + 3].direction, normalize(view.look_at - view.eye));
}

TEST(PrimaryRays, PixelCentresLieOnTheExactGridOfTheFieldOfView) {
  // 90 degrees: the picture's upper edge is at 45 degrees, y = 1 at distance 1; its sides are at width / height.
  const int width = 8, height = 4;
  const auto rays = rays_of(kView, width, height);
  ASSERT_EQ(rays.size(), 32u);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const Vec3 d = rays[static_cast<std::size_t>(row * width + column)].direction;
      EXPECT_NEAR(d.x / -d.z, (column + 0.5) * 2.0 / height - 2, 1e-6);
      EXPECT_NEAR(d.y / -d.z, 1 - (row + 0.5) * 2.0 / height, 1e-6);
      EXPECT_NEAR(length(d), 1, 1e-6f);
    }
}

TEST(PrimaryRays, CornersApproachTheFieldOfViewInALargePicture) {
  const View view{.eye = {}, .look_at = {0, 0, -1}, .up = {0, 1, 0}, .fov = 60};
  const auto rays = rays_of(view, 2000, 2000);
  const double half = std::tan(30 * 3.14159265358979323846 / 180) * 1999 / 2000;
  const Vec3 top_left = rays.front().direction, bottom_right = rays.back().direction;
  EXPECT_NEAR(top_left.x / -top_left.z, -half, 1e-6);
  EXPECT_NEAR(top_left.y / -top_left.z, half, 1e-6);
  EXPECT_NEAR(bottom_right.x / -bottom_right.z, half, 1e-6);
  EXPECT_NEAR(bottom_right.y / -bottom_right.z, -half, 1e-6);
}

TEST(PrimaryRays, UpIsTurnedIntoThePicturePlane) {
  // The camera looks down by 45 degrees; the upper row must look higher than the lower one, and left stays left.
  const View view{.eye = {0, 0, 0}, .look_at = {0, -1, -1}, .up = {0, 1, 0}, .fov = 50};
  const auto rays = rays_of(view, 3, 3);
  EXPECT_GT(rays[1].direction.y, rays[7].direction.y);
  EXPECT_NEAR(rays[1].direction.x, 0, 1e-7f);
  EXPECT_LT(rays[3].direction.x, rays[5].direction.x);
}

TEST(PrimaryRays, UpAlongTheViewOrZeroIsReplaced) {
  for (const Vec3 up : {Vec3{0, 0, 1}, Vec3{0, 0, -3}, Vec3{0, 0, 0}, Vec3{1e-9f, 0, 1}}) {
    View view = kView;
    view.up = up;
    const auto rays = rays_of(view, 3, 3);
    ASSERT_EQ(rays.size(), 9u);
    for (const Ray& ray : rays) {
      EXPECT_TRUE(is_finite(ray.direction));
      EXPECT_NEAR(length(ray.direction), 1, 1e-6f);
    }
    expect_near(rays[4].direction, {0, 0, -1});
    EXPECT_GT(length(rays[0].direction - rays[8].direction), 0.5f);
  }
}

TEST(PrimaryRays, ExtremeButFiniteViewsGiveUnitDirections) {
  const float big = std::numeric_limits<float>::max(), small = std::numeric_limits<float>::denorm_min();
  for (const View& view : {View{.eye = {-big, big, -big}, .look_at = {big, -big, big}},
                           View{.eye = {}, .look_at = {small, 0, 0}, .up = {0, small, 0}},
                           View{.eye = {}, .look_at = {1, 0, 0}, .up = {0, big, 0}, .fov = 179.9999f},
                           View{.eye = {}, .look_at = {1, 0, 0}, .fov = 1e-30f}})
    for (const Ray& ray : rays_of(view, 4, 3)) EXPECT_NEAR(length(ray.direction), 1, 1e-6f);
}

TEST(PrimaryRays, RefusesSizesAndNamesThem) {
  expect_refused(kView, 0, 10, ErrorCode::out_of_range, "width of 0 pixels");
  expect_refused(kView, -5, 10, ErrorCode::out_of_range, "width of -5 pixels");
  expect_refused(kView, 10, 0, ErrorCode::out_of_range, "height of 0 pixels");
  expect_refused(kView, 16385, 10, ErrorCode::out_of_range, "width of 16385 pixels");
  expect_refused(kView, 10, 2000000000, ErrorCode::out_of_range, "height of 2000000000 pixels");
}

TEST(PrimaryRays, AcceptsTheLargestSide) {
  EXPECT_EQ(rays_of(kView, 16384, 1).size(), 16384u);
  EXPECT_EQ(rays_of(kView, 1, 16384).size(), 16384u);
}

TEST(PrimaryRays, RefusesViewsThatAreNotFinite) {
  View view = kView;
  view.eye.y = kNan;
  expect_refused(view, 4, 4, ErrorCode::invalid_argument, "eye (1, nan, 3)");
  view = kView;
  view.look_at.x = kInfinity;
  expect_refused(view, 4, 4, ErrorCode::invalid_argument, "look_at (inf, 2, -7)");
  view = kView;
  view.up.z = -kInfinity;
  expect_refused(view, 4, 4, ErrorCode::invalid_argument, "up (0, 1, -inf)");
}

TEST(PrimaryRays, RefusesAnEyeThatLooksAtItself) {
  View view = kView;
  view.look_at = view.eye;
  expect_refused(view, 4, 4, ErrorCode::invalid_argument, "the same point (1, 2, 3)");
}

TEST(PrimaryRays, RefusesFieldsOfViewOutsideZeroTo180) {
  for (const auto& [fov, text] :
       {std::pair{0.0f, "fov of 0 "}, std::pair{-10.0f, "fov of -10 "}, std::pair{180.0f, "fov of 180 "},
        std::pair{kNan, "fov of nan "}, std::pair{kInfinity, "fov of inf "}}) {
    View view = kView;
    view.fov = fov;
    expect_refused(view, 4, 4, ErrorCode::out_of_range, text);
  }
}

}  // namespace
}  // namespace boxwood::render
