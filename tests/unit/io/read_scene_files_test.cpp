// OBJ, STL and glTF: what assimp reads, and what is checked around it.
#include <cmath>

#include "support/effort.h"
#include "unit/io/scene_file_builder.h"

namespace boxwood::io::test {
namespace {

const Corners kFirst{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
const Corners kSecond{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 0, 1}};

std::vector<Corners> all_corners(const TriangleMesh& mesh) {
  std::vector<Corners> all;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) all.push_back(corners_of(mesh, i));
  return all;
}

using ReadObj = InFolder;

const std::string kObjVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

TEST_F(ReadObj, QuadsNegativeIndicesAndAllFormsOfCorners) {
  const auto loaded =
      read_mesh(file("a.obj", "# a comment\nmtllib none.mtl\n" + kObjVertices +
                                  "vt 0 0\nvn 0 0 1\nf 1 2 3 4\nf -4 -3 -2\nf 1/1/1 2/1/1 4/1/1\nf 1//1 2//1 3//1\n"
                                  "f 1/1 2/1 4/1\nf 1 2 \\\n 3\n"));
  ASSERT_TRUE(loaded) << loaded.error().message;
  const Corners second_half{Vec3{0, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  EXPECT_EQ(all_corners(loaded->mesh),
            (std::vector<Corners>{kFirst, second_half, kFirst, kSecond, kFirst, kSecond, kFirst}));
  EXPECT_EQ(loaded->polygons_triangulated, 1u);
  EXPECT_EQ(loaded->lines_and_points_skipped, 0u);
  EXPECT_EQ(loaded->mesh.name, "a.obj");
  EXPECT_TRUE(loaded->keeps_file_order);
}

TEST_F(ReadObj, DegenerateNonFiniteAndDuplicateTrianglesStayLinesAndPointsGo) {
  const auto loaded =
      read_mesh(file("a.obj", kObjVertices + "v nan 0 0\nv 0 1e60 -inf\nf 1 1 2\nf 5 2 3\nl 1 2\np 1\nf 6 2 3\n"
                                             "f 1 2 3\nf 1 2 3\nf 2 2 2\n"));
  ASSERT_TRUE(loaded) << loaded.error().message;
  ASSERT_EQ(loaded->mesh.triangles.size(), 6u);
  EXPECT_EQ(loaded->lines_and_points_skipped, 2u);
  const auto corners = all_corners(loaded->mesh);
  EXPECT_EQ(corners[0], (Corners{Vec3{0, 0, 0}, Vec3{0, 0, 0}, Vec3{1, 0, 0}}));
  EXPECT_TRUE(std::isnan(corners[1][0].x));
  EXPECT_EQ(corners[2][0].y, kInfinity);
  EXPECT_EQ(corners[2][0].z, -kInfinity);
  EXPECT_EQ(corners[3], kFirst);
  EXPECT_EQ(corners[4], kFirst);
}

TEST_F(ReadObj, OrderSurvivesMaterialsAndGroups) {
  for (const std::string keyword : {"usemtl", "g"}) {
    std::string text = kObjVertices;
    for (int i = 0; i < 20; ++i) text += keyword + (i % 3 ? " one\n" : " two\n") + (i % 2 ? "f 1 2 3\n" : "f 1 2 4\n");
    const auto loaded = read_mesh(file("a.obj", text));
    ASSERT_TRUE(loaded) << loaded.error().message;
    ASSERT_EQ(loaded->mesh.triangles.size(), 20u);
    for (std::size_t i = 0; i < 20; ++i)
      EXPECT_EQ(corners_of(loaded->mesh, i), i % 2 ? kFirst : kSecond) << keyword << i;
    EXPECT_TRUE(loaded->keeps_file_order) << loaded->order_note;
  }
}

TEST_F(ReadObj, SaysWhenAnObjectIsTakenUpAgain) {
  const auto loaded =
      read_mesh(file("a.obj", kObjVertices + "o chair\nusemtl wood\nf 1 2 3\no table \nusemtl glass\nf 1 2 4\n"
                                             "o chair\nusemtl steel\nf 2 3 4\no chair\nf 1 1 1\n"));
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->mesh.triangles.size(), 4u);
  EXPECT_NE(corners_of(loaded->mesh, 1), kSecond) << "assimp keeps the order now: the note is out of date";
  EXPECT_FALSE(loaded->keeps_file_order);
  EXPECT_NE(loaded->order_note.find("'chair' in line 11"), std::string::npos) << loaded->order_note;

  const auto plain = read_mesh(file("b.obj", kObjVertices + "o one\nf 1 2 3\no one\nf 1 2 4\no two\nf 1 2 3\n"));
  ASSERT_TRUE(plain) << plain.error().message;
  EXPECT_TRUE(plain->keeps_file_order) << plain->order_note;
}

TEST_F(ReadObj, BadFiles) {
  expect_error(read_mesh(file("a.obj", "These are the minutes of the meeting.\nf or the record\nv ery well\n")),
               ErrorCode::malformed, {"a.obj"});
  expect_error(read_mesh(file("a.obj", "These are the minutes of the meeting.\n")), ErrorCode::malformed,
               {"no triangles", ".obj"});
  expect_error(read_mesh(file("a.obj", "")), ErrorCode::malformed, {"it is empty"});
  expect_error(read_mesh(file("a.obj", kObjVertices + "f 1 2 5\n")), ErrorCode::malformed, {"out of range"});
  expect_error(read_mesh(file("a.obj", kObjVertices + "f 1 2 -5\n")), ErrorCode::malformed, {"out of range"});
  expect_error(read_mesh(file("a.obj", kObjVertices + "f 1 2 0\n")), ErrorCode::malformed, {"index"});
  expect_error(read_mesh(file("a.obj", kObjVertices + "l 1 2\np 1\n")), ErrorCode::malformed, {"only lines or points"});
  expect_error(read_mesh(folder_ / "missing.obj"), ErrorCode::not_found, {"missing.obj"});
  expect_error(read_mesh(file("a.unknown", "whatever")), ErrorCode::unsupported, {"a.unknown", "known mesh format"});
  std::filesystem::create_directory(folder_ / "folder.obj");
  expect_error(read_mesh(folder_ / "folder.obj"), ErrorCode::unreadable, {"it is a folder"});
  expect_error(read_mesh("/dev/null"), ErrorCode::malformed, {"it is empty"});
  if (std::filesystem::exists("/dev/zero")) expect_error(read_mesh("/dev/zero"), ErrorCode::unsupported, {"PLY"});
}

using ReadStl = InFolder;

TEST_F(ReadStl, Ascii) {
  std::string text = "solid one\n";
  const auto facet = [](const Corners& corners) {
    std::string lines = "facet normal 0 0 0\nouter loop\n";
    for (const Vec3& p : corners)
      lines += "vertex " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
    return lines + "endloop\nendfacet\n";
  };
  const Corners point{Vec3{1, 2, 3}, Vec3{1, 2, 3}, Vec3{1, 2, 3}};
  text += facet(kFirst) + facet(point) + "endsolid one\nsolid two\n" + facet(kSecond) + facet(kFirst);
  const auto loaded = read_mesh(file("a.stl", text + "endsolid two\n"));
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(all_corners(loaded->mesh), (std::vector<Corners>{kFirst, point, kSecond, kFirst}));
  EXPECT_TRUE(loaded->keeps_file_order) << loaded->order_note;
  expect_error(read_mesh(file("a.stl", text)), ErrorCode::malformed, {"truncated", "endsolid"});
}

TEST_F(ReadStl, Binary) {
  const Corners odd{Vec3{std::nanf(""), 0, 0}, Vec3{kInfinity, -1e38f, 1e-45f}, Vec3{0.1f, 0.2f, 0.3f}};
  const std::string text = binary_stl({kFirst, odd, kFirst, {kFirst[0], kFirst[0], kFirst[0]}});
  const auto loaded = read_mesh(file("a.stl", text));
  ASSERT_TRUE(loaded) << loaded.error().message;
  ASSERT_EQ(loaded->mesh.triangles.size(), 4u);
  EXPECT_EQ(corners_of(loaded->mesh, 0), kFirst);
  EXPECT_TRUE(std::isnan(corners_of(loaded->mesh, 1)[0].x));
  EXPECT_EQ(corners_of(loaded->mesh, 1)[1], odd[1]);
  EXPECT_EQ(corners_of(loaded->mesh, 1)[2], odd[2]);
  EXPECT_TRUE(loaded->keeps_file_order);
  for (std::size_t size = 84; size < text.size(); ++size)
    expect_error(read_mesh(file("a.stl", text.substr(0, size))), ErrorCode::malformed,
                 {"truncated", "4 triangles", "needs 284 bytes", "has " + std::to_string(size)});
  std::string absurd = text;
  absurd.replace(80, 4, "\xff\xff\xff\xff");
  expect_error(read_mesh(file("a.stl", absurd)), ErrorCode::malformed, {"4294967295 triangles"});
}

TEST_F(ReadStl, NoneAtAll) {
  expect_error(read_mesh(file("a.stl", "hello")), ErrorCode::malformed, {"a.stl", "no STL"});
  expect_error(read_mesh(file("a.stl", "solid")), ErrorCode::malformed, {"a.stl"});
  expect_error(read_mesh(file("a.stl", "solid x\nendsolid x\n")), ErrorCode::malformed, {"a.stl"});
  EXPECT_FALSE(read_mesh(file("a.stl", binary_stl({}))));
}

using ReadGltf = InFolder;

TEST_F(ReadGltf, TextAndBinary) {
  const GltfScene scene;
  for (const auto& path : {file("a.gltf", scene.gltf()), file("a.glb", scene.glb())}) {
    const auto loaded = read_mesh(path);
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_EQ(all_corners(loaded->mesh), (std::vector<Corners>{kFirst, kSecond}));
    EXPECT_TRUE(loaded->keeps_file_order) << loaded->order_note;
  }
}

TEST_F(ReadGltf, NestedTransformsInstancesAndMirrors) {
  GltfScene scene;
  scene.indices = {0, 1, 2};
  scene.scene = R"("scene":1,"scenes":[{"nodes":[5]},{"nodes":[0,3]}])";
  scene.nodes = R"([{"translation":[10,0,0],"children":[1,4]},
                    {"mesh":0,"scale":[2,3,4],"rotation":[0,0,0.70710678118654752,0.70710678118654752],"children":[2]},
                    {"mesh":0,"translation":[0.0001,0,0]},
                    {"mesh":0,"scale":[-1,1,1]},
                    {"mesh":0,"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,7,1]},
                    {"mesh":0}])";
  const auto loaded = read_mesh(file("a.gltf", scene.gltf()));
  ASSERT_TRUE(loaded) << loaded.error().message;
  ASSERT_EQ(loaded->mesh.triangles.size(), 4u) << "node 5 is in another scene";
  const auto expect_near = [&](std::size_t triangle, const Corners& expected) {
    const Corners corners = corners_of(loaded->mesh, triangle);
    for (int k = 0; k < 3; ++k)
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(corners[k][axis], expected[k][axis], 2e-6) << triangle << k << axis;
  };
  // (x, y, z) -> (10 - 3 y, 2 x, 4 z) for the first, the same behind a shift of 0.0001 along x for its child.
  expect_near(0, {Vec3{10, 0, 0}, Vec3{10, 2, 0}, Vec3{7, 0, 0}});
  expect_near(1, {Vec3{10, 0.0002f, 0}, Vec3{10, 2.0002f, 0}, Vec3{7, 0.0002f, 0}});
  expect_near(2, {Vec3{10, 0, 7}, Vec3{11, 0, 7}, Vec3{10, 1, 7}});
  EXPECT_EQ(corners_of(loaded->mesh, 3), (Corners{Vec3{0, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}})) << "order kept";
  EXPECT_FALSE(loaded->keeps_file_order);
  EXPECT_NE(loaded->order_note.find("more than once"), std::string::npos) << loaded->order_note;
}

TEST_F(ReadGltf, OrderOfSeveralMeshes) {
  GltfScene scene;
  scene.indices = {0, 1, 2};
  scene.meshes = R"([{"primitives":[{"attributes":{"POSITION":1},"indices":0},{"attributes":{"POSITION":1},"mode":0}]},
                     {"primitives":[{"attributes":{"POSITION":1},"mode":5}]}])";
  scene.nodes = R"([{"children":[1,2]},{"mesh":0},{"mesh":1}])";
  auto loaded = read_mesh(file("a.gltf", scene.gltf()));
  ASSERT_TRUE(loaded) << loaded.error().message;
  ASSERT_EQ(loaded->mesh.triangles.size(), 3u);
  EXPECT_EQ(corners_of(loaded->mesh, 0), kFirst);
  EXPECT_EQ(corners_of(loaded->mesh, 1), kFirst);
  EXPECT_EQ(loaded->lines_and_points_skipped, 4u);
  EXPECT_TRUE(loaded->keeps_file_order) << loaded->order_note;

  scene.nodes = R"([{"children":[1,2]},{"mesh":1},{"mesh":0}])";
  loaded = read_mesh(file("a.gltf", scene.gltf()));
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->mesh.triangles.size(), 3u);
  EXPECT_FALSE(loaded->keeps_file_order);
}

TEST_F(ReadGltf, DegenerateAndNonFiniteTrianglesStay) {
  GltfScene scene;
  scene.positions[3].x = std::nanf("");
  scene.indices = {0, 0, 0, 0, 1, 3, 0, 1, 1, 0, 1, 2};
  const auto loaded = read_mesh(file("a.glb", scene.glb()));
  ASSERT_TRUE(loaded) << loaded.error().message;
  ASSERT_EQ(loaded->mesh.triangles.size(), 4u);
  EXPECT_TRUE(std::isnan(corners_of(loaded->mesh, 1)[2].x));
  EXPECT_EQ(corners_of(loaded->mesh, 3), kFirst);
}

TEST_F(ReadGltf, IndexOutOfRangeIsNoSilentLoss) {
  GltfScene scene;
  scene.indices = {0, 1, 2, 0, 1, 4, 0, 1, 3};
  expect_error(read_mesh(file("a.gltf", scene.gltf())), ErrorCode::malformed,
               {"announces 3 triangles", "only 2", "do not exist"});
}

TEST_F(ReadGltf, EveryCutIsAnError) {
  const std::string glb = GltfScene().glb(), gltf = GltfScene().gltf();
  for (std::size_t size = 1; size < glb.size(); ++size) {
    const auto loaded = read_mesh(file("cut.glb", glb.substr(0, size)));
    ASSERT_FALSE(loaded) << size;
    EXPECT_EQ(loaded.error().message.find("it is truncated") != std::string::npos, size >= 4) << loaded.error().message;
  }
  for (std::size_t size = 1; size < gltf.size(); ++size)
    expect_error(read_mesh(file("cut.gltf", gltf.substr(0, size))), ErrorCode::malformed, {"JSON"});
}

TEST_F(ReadGltf, NodesThatWouldOverflowAStack) {
  GltfScene scene;
  scene.nodes = R"([{"mesh":0,"children":[1]},{"children":[0]}])";
  expect_error(read_mesh(file("a.gltf", scene.gltf())), ErrorCode::malformed, {"own ancestor"});
  scene.nodes = "[";
  for (std::size_t i = 1; i <= boxwood::test::effort(50000, 10); ++i)
    scene.nodes += R"({"children":[)" + std::to_string(i) + "]},";
  scene.nodes += R"({"mesh":0}])";
  expect_error(read_mesh(file("a.gltf", scene.gltf())), ErrorCode::unsupported, {"1000 levels"});
  scene.nodes = "[";
  for (int i = 1; i <= 40; ++i) scene.nodes += R"({"children":[)" + std::to_string(i) + "," + std::to_string(i) + "]},";
  scene.nodes += R"({"mesh":0}])";
  expect_error(read_mesh(file("a.gltf", scene.gltf())), ErrorCode::too_large, {"ten million"});
  scene.nodes = std::string(boxwood::test::effort(1000000, 10), '[');
  expect_error(read_mesh(file("a.gltf", scene.gltf())), ErrorCode::unsupported, {"512 levels"});
}

TEST_F(ReadGltf, OtherBadFiles) {
  expect_error(read_mesh(file("a.gltf", "hello")), ErrorCode::malformed, {"byte 0 of its JSON"});
  expect_error(read_mesh(file("a.glb", "hello, this is no GLB")), ErrorCode::unsupported, {"a.glb"});
  expect_error(
      read_mesh(file("a.gltf", R"({"asset":{"version":"2.0"},"extensionsRequired":["EXT_meshopt_compression"]})")),
      ErrorCode::unsupported, {"EXT_meshopt_compression"});
  GltfScene scene;
  scene.meshes = R"([{"primitives":[{"attributes":{"POSITION":1},"mode":1}]}])";
  expect_error(read_mesh(file("a.gltf", scene.gltf())), ErrorCode::malformed, {"only lines or points"});
  scene.nodes = R"([{"mesh":9}])";
  expect_error(read_mesh(file("a.gltf", scene.gltf())), ErrorCode::malformed, {"a.gltf"});
}

TEST_F(ReadGltf, EndingsInCapitals) {
  EXPECT_TRUE(read_mesh(file("A.GLTF", GltfScene().gltf())));
  EXPECT_TRUE(read_mesh(file("A.GLB", GltfScene().glb())));
  EXPECT_TRUE(read_mesh(file("A.STL", binary_stl({kFirst}))));
  expect_error(read_mesh(file("A.PLY", "no")), ErrorCode::malformed, {"'ply'"});
}

using ReadAnything = InFolder;

TEST_F(ReadAnything, PrintsNothing) {
  std::vector<std::filesystem::path> paths;
  GltfScene scene;
  paths.push_back(file("a.glb", scene.glb()));
  scene.indices[0] = 9;
  paths.push_back(file("b.glb", scene.glb()));
  for (const char* ending : {"obj", "stl", "gltf", "glb", "fbx", "dae", "3ds", "off", "x3d", "blend", "unknown"})
    for (const char* content : {"solid x\nf 1 2 3\n", "<?xml version=\"1.0\"?><COLLADA/>", "OFF\n1 1 1\n9 9 9\n"})
      paths.push_back(file("c" + std::to_string(paths.size()) + "." + ending, content));
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  int failed = 0;
  for (const auto& path : paths) failed += !read_mesh(path);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_GT(failed, 20);
}

TEST_F(ReadAnything, OtherFormatsOfOnePartKeepTheOrder) {
  const auto loaded = read_mesh(file("a.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n"));
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(all_corners(loaded->mesh), (std::vector<Corners>{kFirst, kSecond}));
  EXPECT_TRUE(loaded->keeps_file_order) << loaded->order_note;
}

// Collada: a scene whose file says that z is up and that one unit is an inch. Coordinates stay what they are in the
// file; transforms of its nodes count.
TEST_F(ReadAnything, UnitsAndAxesStayUntouched) {
  const std::string text =
      R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="inch" meter="0.0254"/><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v">
<input semantic="POSITION" source="#p"/></vertices><triangles count="1">
<input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node>
<scale>5 5 5</scale><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
  const auto loaded = read_mesh(file("a.dae", text));
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(all_corners(loaded->mesh), (std::vector<Corners>{{Vec3{0, 0, 0}, Vec3{5, 0, 0}, Vec3{0, 5, 0}}}));
}

}  // namespace
}  // namespace boxwood::io::test
