#include <gtest/gtest.h>

#include <limits>

#include "unit/mesh/hand_made.h"

namespace boxwood {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
SequentialExecutor sequential;

void expect_refused(const MeshView& view, ErrorCode code, const std::string& part) {
  const Status status = mesh::check_indices(view, sequential);
  ASSERT_FALSE(status) << part;
  EXPECT_EQ(status.error().code, code) << status.error().message;
  EXPECT_NE(status.error().message.find(part), std::string::npos) << status.error().message;
}

TEST(CheckIndices, AcceptsWhatCanBeRead) {
  EXPECT_TRUE(mesh::check_indices({}, sequential));
  const TriangleMesh cube = test::cube();
  EXPECT_TRUE(mesh::check_indices(cube, sequential));
  MeshView unindexed{cube.vertices.data(), 8, nullptr, 2};
  EXPECT_TRUE(mesh::check_indices(unindexed, sequential));
  MeshView no_triangles = cube;
  no_triangles.triangle_count = 0;
  EXPECT_TRUE(mesh::check_indices(no_triangles, sequential));
  EXPECT_TRUE(mesh::check_indices(test::TightView(cube, 13, 17, 1), sequential));
}

TEST(CheckIndices, RefusesWhatCanNot) {
  const TriangleMesh cube = test::cube();
  MeshView view = cube;
  view.positions = nullptr;
  expect_refused(view, ErrorCode::invalid_argument, "8 vertices");
  view = cube, view.vertex_stride = 11;
  expect_refused(view, ErrorCode::invalid_argument, "stride of 11");
  view = cube, view.triangle_stride = 0;
  expect_refused(view, ErrorCode::invalid_argument, "stride of 0");
  view = cube, view.vertex_count = std::size_t(1) << 31;
  expect_refused(view, ErrorCode::too_large, "2147483648 vertices");
  view = cube, view.triangle_count = std::size_t(1) << 31;
  expect_refused(view, ErrorCode::too_large, "2147483648 triangles");
  view = cube, view.vertex_stride = SIZE_MAX / 2;
  expect_refused(view, ErrorCode::too_large, "memory");
  view = cube, view.vertex_count = 7;
  expect_refused(view, ErrorCode::malformed, "triangle 2 refers to vertex 7");
  view = cube, view.vertex_count = 0;
  expect_refused(view, ErrorCode::malformed, "triangle 0 refers to vertex 0");
  expect_refused({cube.vertices.data(), 8, nullptr, 3}, ErrorCode::malformed, "only 2");
  expect_refused({nullptr, 0, nullptr, 1}, ErrorCode::malformed, "1 triangles");
}

TEST(CheckIndices, NamesTheFirstBadTriangleWhateverTheExecutor) {
  TriangleMesh mesh = test::wave(200, 200);
  mesh.triangles[70'000][2] = 0xffffffffu;
  mesh.triangles[41'234][1] = 1'000'000;
  mesh.triangles[41'235][0] = 2'000'000;
  test::with_each_executor([&](Executor& executor) {
    const Status status = mesh::check_indices(mesh, executor);
    ASSERT_FALSE(status);
    EXPECT_NE(status.error().message.find("triangle 41234 refers to vertex 1000000"), std::string::npos)
        << status.error().message;
  });
}

TEST(IsUsable, RefusesWhatIsNotFiniteOrTooLarge) {
  const Triangle good{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_TRUE(mesh::is_usable(good));
  EXPECT_TRUE(mesh::is_usable({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}));
  EXPECT_TRUE(mesh::is_usable({{1e18f, -1e18f, 1e18f}, {0, 0, 0}, {0, 0, 0}}));
  for (const float bad : {kNan, kInfinity, -kInfinity, std::nextafter(1e18f, kInfinity), -1.1e18f}) {
    for (int corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis) {
        Triangle triangle = good;
        (corner == 0 ? triangle.v0 : corner == 1 ? triangle.v1 : triangle.v2)[axis] = bad;
        EXPECT_FALSE(mesh::is_usable(triangle)) << bad << " at corner " << corner << ", axis " << axis;
      }
    }
  }
}

TEST(Bounds, LeavesOutUnusableTrianglesAndUnusedVertices) {
  EXPECT_TRUE(mesh::bounds({}, sequential).is_empty());
  TriangleMesh cube = test::cube();
  cube.vertices.push_back({100, 100, 100});
  EXPECT_EQ(mesh::bounds(cube, sequential), (Box{{0, 0, 0}, {1, 1, 1}}));
  cube.vertices.push_back({kNan, 5, 5});
  cube.triangles.push_back({0, 8, 9});
  EXPECT_EQ(mesh::bounds(cube, sequential), (Box{{0, 0, 0}, {1, 1, 1}}));
  cube.triangles.push_back({0, 1, 8});
  EXPECT_EQ(mesh::bounds(cube, sequential), (Box{{0, 0, 0}, {100, 100, 100}}));
  const TriangleMesh only_bad = test::make_mesh({{kNan, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  EXPECT_TRUE(mesh::bounds(only_bad, sequential).is_empty());
}

TEST(Hash, IsOfPositionsInOrder) {
  const TriangleMesh wave = test::wave(150, 150), apart = test::exploded(wave);
  const std::uint64_t expected = mesh::hash(wave, sequential);
  test::with_each_executor([&](Executor& executor) {
    EXPECT_EQ(mesh::hash(wave, executor), expected);
    EXPECT_EQ(mesh::hash(apart, executor), expected);
    EXPECT_EQ(mesh::hash({apart.vertices.data(), apart.vertices.size(), nullptr, apart.triangles.size()}, executor),
              expected);
    EXPECT_EQ(mesh::hash(test::TightView(wave, 20, 13, 3), executor), expected);
  });
  for (const std::size_t changed : {std::size_t(0), wave.triangles.size() / 2, wave.triangles.size() - 1}) {
    TriangleMesh other = wave;
    std::swap(other.triangles[changed][0], other.triangles[changed][1]);
    EXPECT_NE(mesh::hash(other, sequential), expected) << changed;
  }
  TriangleMesh shorter = wave;
  shorter.triangles.pop_back();
  EXPECT_NE(mesh::hash(shorter, sequential), expected);
  EXPECT_EQ(mesh::hash({}, sequential), mesh::hash({}, sequential));
}

}  // namespace
}  // namespace boxwood
