// What every scene promises: count, validity, determinism, rotation. What each stands for is in scene_properties_test.
#include <gtest/gtest.h>

#include <limits>

#include "unit/mesh/hand_made.h"

namespace boxwood {
namespace {

SequentialExecutor sequential;

mesh::Scene make(std::string_view id, std::size_t triangles, std::uint64_t seed = 1, Vec3 rotate = {}) {
  Result<mesh::Scene> scene = mesh::make_scene(id, {.triangles = triangles, .seed = seed, .rotate = rotate});
  EXPECT_TRUE(scene) << id;
  return scene ? std::move(*scene) : mesh::Scene{};
}

class EachScene : public testing::TestWithParam<const mesh::SceneInfo*> {};

TEST_P(EachScene, KeepsItsPromises) {
  for (const std::size_t target : {12u, 13u, 20u, 100u, 777u, 5'000u, 40'000u, 200'000u}) {
    const mesh::Scene scene = make(GetParam()->id, target);
    const std::size_t count = scene.mesh.triangles.size();
    EXPECT_EQ(scene.mesh.name, GetParam()->id);
    EXPECT_LE(count, target + target / 10) << target;
    EXPECT_GE(double(count), double(target) * (target < 100 ? 0.5 : target < 10'000 ? 0.75 : 0.93)) << target;
    EXPECT_TRUE(mesh::check_indices(scene.mesh, sequential)) << target;
    const mesh::Report report = mesh::inspect(scene.mesh, sequential);
    EXPECT_EQ(report.non_finite, 0u) << target;
    EXPECT_EQ(report.degenerate, 0u) << target;
    EXPECT_EQ(report.duplicate, 0u) << target;
    std::vector<bool> used(scene.mesh.vertices.size());
    for (const auto& t : scene.mesh.triangles)
      for (const std::uint32_t v : t) used[v] = true;
    EXPECT_EQ(std::count(used.begin(), used.end(), false), 0) << target << ": vertices without a triangle";
    EXPECT_TRUE(is_finite(scene.view.eye) && is_finite(scene.view.look_at) && scene.view.eye != scene.view.look_at);
    EXPECT_TRUE(scene.view.fov > 0 && scene.view.fov < 180);
  }
}

TEST_P(EachScene, IsDeterministicInItsSeed) {
  for (const std::size_t target : {100u, 30'000u}) {
    const std::uint64_t hash = mesh::hash(make(GetParam()->id, target).mesh, sequential);
    EXPECT_EQ(mesh::hash(make(GetParam()->id, target).mesh, sequential), hash);
    EXPECT_NE(mesh::hash(make(GetParam()->id, target, 2).mesh, sequential), hash);
    EXPECT_NE(mesh::hash(make(GetParam()->id, target, ~std::uint64_t(0)).mesh, sequential), hash);
  }
}

TEST_P(EachScene, ZeroTrianglesMeansTheDefault) {
  const std::size_t expected = GetParam()->default_triangles;
  EXPECT_TRUE(expected >= 100'000 && expected <= 300'000);
  EXPECT_EQ(mesh::hash(make(GetParam()->id, 0).mesh, sequential),
            mesh::hash(make(GetParam()->id, expected).mesh, sequential));
}

TEST_P(EachScene, RotatesAboutTheCentreOfItsBounds) {
  const mesh::Scene plain = make(GetParam()->id, 3000);
  const Box box = mesh::bounds(plain.mesh, sequential);
  const float tolerance = 1e-5f * length(box.extent());
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 degrees;
    degrees[axis] = 90;
    const mesh::Scene turned = make(GetParam()->id, 3000, 1, degrees);
    const Box turned_box = mesh::bounds(turned.mesh, sequential);
    const int next = (axis + 1) % 3, after = (axis + 2) % 3;
    EXPECT_NEAR(turned_box.extent()[axis], box.extent()[axis], tolerance);
    EXPECT_NEAR(turned_box.extent()[next], box.extent()[after], tolerance);
    EXPECT_NEAR(turned_box.extent()[after], box.extent()[next], tolerance);
    EXPECT_LT(length(turned_box.center() - box.center()), tolerance);
    // A quarter turn takes the next axis to the one after it, for the mesh and for the camera.
    const auto turned_point = [&](Vec3 p) {
      const Vec3 d = p - box.center();
      Vec3 q;
      q[axis] = d[axis], q[next] = -d[after], q[after] = d[next];
      return q + box.center();
    };
    for (std::size_t i = 0; i < plain.mesh.vertices.size(); i += 97)
      EXPECT_LT(length(turned.mesh.vertices[i] - turned_point(plain.mesh.vertices[i])), tolerance);
    EXPECT_LT(length(turned.view.eye - turned_point(plain.view.eye)), 4 * tolerance);
    EXPECT_LT(length(turned.view.look_at - turned_point(plain.view.look_at)), 4 * tolerance);
    EXPECT_LT(length(turned.view.up - (turned_point(plain.view.up + box.center()) - box.center())), tolerance + 1e-5f);
  }
  const mesh::Scene skewed = make(GetParam()->id, 3000, 1, {12, -200, 77.5f});
  EXPECT_EQ(skewed.mesh.triangles, plain.mesh.triangles);
  for (std::size_t i = 1; i < plain.mesh.vertices.size(); i += 31)
    EXPECT_NEAR(length(skewed.mesh.vertices[i] - skewed.mesh.vertices[0]),
                length(plain.mesh.vertices[i] - plain.mesh.vertices[0]), tolerance);
  EXPECT_EQ(mesh::hash(make(GetParam()->id, 3000, 1, {360, -720, 0}).mesh, sequential),
            mesh::hash(plain.mesh, sequential))
      << "whole turns leave everything where it is";
}

std::vector<const mesh::SceneInfo*> all_scenes() {
  std::vector<const mesh::SceneInfo*> list;
  for (const mesh::SceneInfo& info : mesh::scenes()) list.push_back(&info);
  return list;
}

INSTANTIATE_TEST_SUITE_P(Scenes, EachScene, testing::ValuesIn(all_scenes()),
                         [](const auto& info) { return std::string(info.param->id); });

TEST(Scenes, RotationOrderIsXThenYThenZ) {
  // x by 90 takes +y to +z, then y by 90 takes +z to +x: the camera's up tells.
  const mesh::Scene scene = make("soup", 12, 1, {90, 90, 0});
  EXPECT_LT(length(scene.view.up - Vec3{1, 0, 0}), 1e-6f);
  const mesh::Scene with_z = make("soup", 12, 1, {90, 90, 90});
  EXPECT_LT(length(with_z.view.up - Vec3{0, 1, 0}), 1e-6f);
}

TEST(Scenes, RefusesWhatItCanNotMake) {
  const auto expect_error = [](std::string_view id, mesh::SceneOptions options, ErrorCode code, const char* part) {
    const Result<mesh::Scene> scene = mesh::make_scene(id, options);
    ASSERT_FALSE(scene) << part;
    EXPECT_EQ(scene.error().code, code);
    EXPECT_NE(scene.error().message.find(part), std::string::npos) << scene.error().message;
  };
  expect_error("teapot", {}, ErrorCode::unknown_name, "teapot");
  expect_error("teapot", {}, ErrorCode::unknown_name, "organic, atrium, foliage");
  expect_error("", {}, ErrorCode::unknown_name, "soup");
  expect_error("City", {}, ErrorCode::unknown_name, "City");
  expect_error("city", {.triangles = 11}, ErrorCode::out_of_range, "11");
  expect_error("city", {.triangles = 20'000'001}, ErrorCode::out_of_range, "20000001");
  expect_error("city", {.rotate = {0, kInfinity, 0}}, ErrorCode::invalid_argument, "inf");
  expect_error("city", {.rotate = {std::numeric_limits<float>::quiet_NaN(), 0, 0}}, ErrorCode::invalid_argument, "nan");
}

TEST(Scenes, RegistryIsComplete) {
  const char* ids[] = {"organic", "atrium", "foliage", "spaceship", "city", "shells", "soup"};
  ASSERT_EQ(mesh::scenes().size(), std::size(ids));
  for (std::size_t i = 0; i < std::size(ids); ++i) {
    EXPECT_STREQ(mesh::scenes()[i].id, ids[i]);
    EXPECT_GT(std::strlen(mesh::scenes()[i].summary), 20u);
    EXPECT_GT(std::strlen(mesh::scenes()[i].paper), 5u);
  }
}

}  // namespace
}  // namespace boxwood
