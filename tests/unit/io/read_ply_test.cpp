#include <cmath>
#include <limits>

#include "unit/io/io_test_support.h"

namespace boxwood::io::test {
namespace {

using ReadPly = InFolder;

const std::string kTetrahedron =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n3 0 2 3\n3 1 2 3\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

void expect_tetrahedron(const Result<LoadedMesh>& loaded) {
  ASSERT_TRUE(loaded) << loaded.error().message;
  const std::vector<Vec3> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  EXPECT_EQ(loaded->mesh.vertices, vertices);
  EXPECT_EQ(loaded->mesh.triangles, triangles);
  EXPECT_TRUE(loaded->keeps_file_order);
  EXPECT_EQ(loaded->order_note, "");
  EXPECT_EQ(loaded->polygons_triangulated, 0u);
  EXPECT_EQ(loaded->lines_and_points_skipped, 0u);
}

TEST_F(ReadPly, Ascii) {
  const auto loaded = read_mesh(file("tetrahedron.ply", kTetrahedron));
  expect_tetrahedron(loaded);
  EXPECT_EQ(loaded->mesh.name, "tetrahedron.ply");
}

TEST_F(ReadPly, ContentDecidesOverEnding) {
  expect_tetrahedron(read_mesh(file("tetrahedron.obj", kTetrahedron)));
}

TEST_F(ReadPly, LineEndingsOfOtherSystems) {
  for (const std::string ending : {"\r\n", "\r"}) {
    std::string text;
    for (const char c : kTetrahedron) text += c == '\n' ? ending : std::string(1, c);
    expect_tetrahedron(read_mesh(file("a.ply", text)));
  }
}

TEST_F(ReadPly, CommentsAndMissingLastLineBreak) {
  std::string text = replaced(kTetrahedron, "element vertex", "comment element face 9\nobj_info x\n\nelement vertex");
  text.pop_back();
  expect_tetrahedron(read_mesh(file("a.ply", text)));
}

// Doubles, colours, a list before and an element between the ones that matter, properties out of order.
std::string rich_binary(bool big) {
  std::string text =
      "ply\r\nformat binary_" + std::string(big ? "big" : "little") +
      "_endian 1.0\r\nelement vertex 4\r\nproperty uint8 red\r\nproperty float64 z\r\n"
      "property list ushort short tags\r\nproperty double x\r\nproperty int16 y\r\n"
      "element material 2\r\nproperty list uint32 float32 values\r\nproperty int32 id\r\n"
      "element face 3\r\nproperty uchar flag\r\nproperty list int8 uint16 vertex_index\r\n"
      "property list uchar float uv\r\nelement edge 1\r\nproperty int a\r\nproperty int b\r\nend_header\r\n";
  const double x[] = {0, 1, 0, 1.0 / 3}, z[] = {0, 0, 0, 1};
  const std::int16_t y[] = {0, 0, 1, -300};
  for (int i = 0; i < 4; ++i) {
    text += bytes_of(std::uint8_t{255}) + bytes_of(z[i], big) + bytes_of(static_cast<std::uint16_t>(i), big);
    for (int k = 0; k < i; ++k) text += bytes_of(std::int16_t{-1}, big);
    text += bytes_of(x[i], big) + bytes_of(y[i], big);
  }
  text += bytes_of(std::uint32_t{0}, big) + bytes_of(std::int32_t{7}, big);
  text += bytes_of(std::uint32_t{2}, big) + bytes_of(1.5f, big) + bytes_of(2.5f, big) + bytes_of(std::int32_t{8}, big);
  const std::vector<std::vector<std::uint16_t>> faces{{0, 1, 2, 3}, {2, 1}, {3, 2, 1}};
  for (const auto& face : faces) {
    text += '\1' + bytes_of(static_cast<std::int8_t>(face.size()));
    for (const std::uint16_t index : face) text += bytes_of(index, big);
    text += bytes_of(std::uint8_t{1}) + bytes_of(0.25f, big);
  }
  return text + bytes_of(0, big) + bytes_of(1, big);
}

TEST_F(ReadPly, BinaryOfBothByteOrdersWithEverythingElseAround) {
  for (const bool big : {false, true}) {
    const auto loaded = read_mesh(file("a.ply", rich_binary(big)));
    ASSERT_TRUE(loaded) << loaded.error().message;
    const std::vector<Vec3> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {static_cast<float>(1.0 / 3), -300, 1}};
    const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {0, 2, 3}, {3, 2, 1}};
    EXPECT_EQ(loaded->mesh.vertices, vertices);
    EXPECT_EQ(loaded->mesh.triangles, triangles);
    EXPECT_EQ(loaded->polygons_triangulated, 1u);
    EXPECT_EQ(loaded->lines_and_points_skipped, 2u) << "one face of two corners, one edge";
  }
}

TEST_F(ReadPly, EveryCutOfABinaryFileIsTruncated) {
  const std::string whole = rich_binary(false);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto loaded = read_mesh(file("cut.ply", whole.substr(0, size)));
    ASSERT_FALSE(loaded) << size;
    EXPECT_EQ(loaded.error().code, ErrorCode::malformed) << size << loaded.error().message;
  }
}

TEST_F(ReadPly, FacesBeforeVertices) {
  const auto loaded =
      read_mesh(file("a.ply",
                     "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_index\n"
                     "element vertex 3\nproperty float y\nproperty float x\nproperty float z\nend_header\n"
                     "3 2 1 0  1 2 3 4 5 6 7 8 9"));
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(corners_of(loaded->mesh, 0), (Corners{Vec3{8, 7, 9}, Vec3{5, 4, 6}, Vec3{2, 1, 3}}));
}

TEST_F(ReadPly, FloatsOfAllKinds) {
  const auto loaded = read_mesh(file("a.ply", replaced(kTetrahedron, "0 0 0\n1 0 0\n0 1 0\n0 0 1",
                                                       "+1.5e0 -0 1e-50\nnan inf -inf\n1e50 -1e400 1e-400\n"
                                                       "0.1 16777217 1e-45")));
  ASSERT_TRUE(loaded) << loaded.error().message;
  const auto& v = loaded->mesh.vertices;
  EXPECT_EQ(v[0], (Vec3{1.5f, 0, 0}));
  EXPECT_TRUE(std::signbit(v[0].y));
  EXPECT_TRUE(std::isnan(v[1].x));
  EXPECT_EQ(v[1].y, kInfinity);
  EXPECT_EQ(v[1].z, -kInfinity);
  EXPECT_EQ(v[2], (Vec3{kInfinity, -kInfinity, 0}));
  EXPECT_EQ(v[3], (Vec3{0.1f, 16777216.f, std::numeric_limits<float>::denorm_min()}));
}

// A decimal just above the middle of two floats, which a detour through double rounds onto the middle and then down.
TEST_F(ReadPly, FloatsAreRoundedOnce) {
  const auto loaded =
      read_mesh(file("a.ply", replaced(kTetrahedron, "0 0 0\n", "1.00000005960464477539062500001 0 0\n")));
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->mesh.vertices[0].x, std::nextafter(1.f, 2.f));
}

TEST_F(ReadPly, DegenerateAndDuplicateTrianglesStay) {
  const auto loaded = read_mesh(file("a.ply", replaced(kTetrahedron, "3 0 1 3\n3 0 2 3", "3 0 1 2\n3 2 2 2")));
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->mesh.triangles.size(), 4u);
  EXPECT_EQ(loaded->mesh.triangles[2], (std::array<std::uint32_t, 3>{2, 2, 2}));
}

TEST_F(ReadPly, LongPolygonThroughManyBuffers) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uint uchar vertex_indices\nend_header\n" +
      std::string(36, '\0') + bytes_of(std::uint32_t{600000});
  for (int i = 0; i < 600000; ++i) text += static_cast<char>(i % 3);
  const auto loaded = read_mesh(file("a.ply", text));
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->mesh.triangles.size(), 599998u);
  EXPECT_EQ(loaded->mesh.triangles.back(), (std::array<std::uint32_t, 3>{0, 599998 % 3, 599999 % 3}));
  EXPECT_EQ(loaded->polygons_triangulated, 1u);
}

TEST_F(ReadPly, IndexOutOfRangeNamesFaceAndIndex) {
  expect_error(read_mesh(file("a.ply", replaced(kTetrahedron, "3 0 1 3", "3 0 4 3"))), ErrorCode::malformed,
               {"a.ply", "face 1 ", "vertex 4,", "there are 4"});
  expect_error(read_mesh(file("a.ply", replaced(kTetrahedron, "3 0 1 3", "3 0 -1 3"))), ErrorCode::malformed,
               {"face 1 ", "vertex -1,"});
  expect_error(read_mesh(file("a.ply", replaced(kTetrahedron, "3 0 1 3", "3 0 0.5 3"))), ErrorCode::malformed,
               {"face 1 ", "vertex 0.5,"});
  expect_error(read_mesh(file("a.ply", replaced(kTetrahedron, "3 0 1 3", "3 0 nan 3"))), ErrorCode::malformed,
               {"face 1 ", "nan"});
}

TEST_F(ReadPly, AbsurdCountsAllocateNothing) {
  for (const char* count : {"2000000000", "4294967295", "99999999999", "18446744073709551615"})
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
      for (const char* element : {"element vertex 4", "element face 4"}) {
        const std::string name = std::string(element).substr(0, std::string(element).size() - 1);
        const std::string text = replaced(replaced(kTetrahedron, element, name + count), "ascii", format);
        const auto loaded = read_mesh(file("a.ply", text));
        ASSERT_FALSE(loaded);
        const bool beyond = std::string_view(count) != "2000000000";
        EXPECT_EQ(loaded.error().code, beyond ? ErrorCode::too_large : ErrorCode::malformed) << loaded.error().message;
      }
  expect_error(read_mesh(file("a.ply", replaced(kTetrahedron, "element face 4", "element face 3000000000"))),
               ErrorCode::too_large, {"3000000000 faces", "2^31 - 1"});
  expect_error(read_mesh(file("a.ply", replaced(kTetrahedron, "element face",
                                                "element other 18446744073709551615\nproperty int a\nelement face"))),
               ErrorCode::malformed, {"truncated", "'other'"});
  expect_error(read_mesh(file("a.ply", replaced(kTetrahedron, "3 0 1 3", "4000000000 0 1 3"))), ErrorCode::malformed,
               {});
}

TEST_F(ReadPly, AnElementWithoutPropertiesTakesNoTime) {
  expect_tetrahedron(read_mesh(
      file("a.ply", replaced(kTetrahedron, "element face", "element nothing 18446744073709551615\nelement face"))));
}

struct BadHeader {
  const char* from;
  const char* to;
  const char* says;
};

TEST_F(ReadPly, BadHeaders) {
  const BadHeader kCases[] = {
      {"ply\n", "plu\n", "does not begin with the line 'ply'"},
      {"format ascii 1.0\n", "", "no format line"},
      {"format ascii 1.0", "format ascii 2.0", "line 2 of its header"},
      {"format ascii 1.0", "format text 1.0", "'text'"},
      {"format ascii 1.0\n", "format ascii 1.0\nformat ascii 1.0\n", "second time"},
      {"element vertex 4", "element vertex -4", "'-4'"},
      {"element vertex 4", "element vertex 18446744073709551616", "'18446744073709551616'"},
      {"element vertex 4", "element vertex", "line 3"},
      {"element vertex 4", "elephant vertex 4", "'elephant'"},
      {"element vertex 4", "element points 4", "no vertices"},
      {"element vertex 4", "property float w\nelement vertex 4", "before any element"},
      {"element face", "element vertex", "second time"},
      {"element face", "element polygon", "no triangles, only 4 points"},
      {"element face", "element tristrips", "strips"},
      {"property float y", "property float x", "second time"},
      {"property float y", "property float w", "no property 'y'"},
      {"property float y", "property list uchar float y", "no property 'y'"},
      {"property float y", "property half y", "'half'"},
      {"property float y", "property float", "line 5"},
      {"list uchar int", "list float int", "not an integer"},
      {"list uchar int", "list uchar float", "not integers"},
      {"list uchar int", "int", "no list 'vertex_indices'"},
      {"vertex_indices", "corners", "no list 'vertex_indices'"},
      {"end_header", "end_of_header", "'end_of_header'"},
      {"end_header\n", "", "line 9"},
  };
  for (const BadHeader& bad : kCases) {
    SCOPED_TRACE(bad.to);
    const auto loaded = read_mesh(file("bad.ply", replaced(kTetrahedron, bad.from, bad.to)));
    ASSERT_FALSE(loaded);
    EXPECT_NE(loaded.error().message.find(bad.says), std::string::npos) << loaded.error().message;
    EXPECT_EQ(loaded.error().message.find("cannot read '" + (folder_ / "bad.ply").string() + "': "), 0u);
  }
}

TEST_F(ReadPly, BadBodies) {
  expect_error(read_mesh(file("a.ply", replaced(kTetrahedron, "0 1 0", "0 one 0"))), ErrorCode::malformed,
               {"'one' is not a number", "'vertex' 2"});
  expect_error(read_mesh(file("a.ply", replaced(kTetrahedron, "3 0 1 3", "-3 0 1 3"))), ErrorCode::malformed,
               {"'face' 1", "length -3"});
  expect_error(read_mesh(file("a.ply", replaced(kTetrahedron, "3 1 2 3", "3 1 2"))), ErrorCode::malformed,
               {"truncated", "'face' 3 of 4"});
  expect_error(read_mesh(file("a.ply", replaced(kTetrahedron, "0 1 0", std::string(10000, '7')))), ErrorCode::malformed,
               {"4095"});
  expect_error(read_mesh(file("a.ply", replaced(kTetrahedron, "element face 4", "element face 0"))),
               ErrorCode::malformed, {"no triangles"});
  expect_error(read_mesh(file("a.ply", replaced(kTetrahedron, "element vertex 4", "element vertex 0"))),
               ErrorCode::malformed, {"there are 0"});
  expect_error(read_mesh(file("a.ply", "ply\n" + std::string(100000, 'x'))), ErrorCode::malformed,
               {"longer than 2048"});
}

TEST_F(ReadPly, FilesThatAreNone) {
  expect_error(read_mesh(folder_ / "missing.ply"), ErrorCode::not_found, {"missing.ply", "no such file"});
  expect_error(read_mesh(folder_), ErrorCode::unreadable, {"it is a folder"});
  expect_error(read_mesh(file("empty.ply", "")), ErrorCode::malformed, {"it is empty"});
  expect_error(read_mesh(file("text.ply", "just some words")), ErrorCode::malformed, {"'ply'"});
  expect_error(read_mesh(file("text.ply", "p")), ErrorCode::malformed, {"'ply'"});
  expect_error(read_mesh(""), ErrorCode::invalid_argument, {"without a name"});
}

TEST_F(ReadPly, FromAPipe) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  ASSERT_EQ(::write(ends[1], kTetrahedron.data(), kTetrahedron.size()), static_cast<ssize_t>(kTetrahedron.size()));
  ::close(ends[1]);
  expect_tetrahedron(read_mesh("/dev/fd/" + std::to_string(ends[0])));
  ::close(ends[0]);
}

TEST_F(ReadPly, FromAPipeWithAnAbsurdCount) {
  const std::string text = replaced(replaced(kTetrahedron, "element vertex 4", "element vertex 2147483647"), "ascii",
                                    "binary_little_endian");
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  ASSERT_EQ(::write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  ::close(ends[1]);
  expect_error(read_mesh("/dev/fd/" + std::to_string(ends[0])), ErrorCode::malformed, {"truncated", "'vertex'"});
  ::close(ends[0]);
}

using WritePly = InFolder;

TEST_F(WritePly, RoundTripKeepsEveryBit) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 10000; ++i) {
    const float f = static_cast<float>(i);
    mesh.vertices.push_back({f / 7, -f * 1e30f, i % 100 == 0 ? std::nanf("") : 1e-40f * f});
    mesh.triangles.push_back({i, (i * 7) % 10000, (i * 31) % 10000});
  }
  ASSERT_TRUE(write_ply(folder_ / "a.ply", mesh));
  EXPECT_EQ(files_in_folder(), 1u);
  const auto loaded = read_mesh(folder_ / "a.ply");
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->mesh.triangles, mesh.triangles);
  ASSERT_EQ(loaded->mesh.vertices.size(), mesh.vertices.size());
  EXPECT_EQ(std::memcmp(loaded->mesh.vertices.data(), mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3)), 0);
}

TEST_F(WritePly, StridesAndMeshesWithoutIndices) {
  const std::vector<float> positions{0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0, 9, 5, 5, 5};
  MeshView view{positions.data(), 4, nullptr, 1, 16};
  ASSERT_TRUE(write_ply(folder_ / "a.ply", view));
  auto loaded = read_mesh(folder_ / "a.ply");
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->mesh.vertices.size(), 4u);
  EXPECT_EQ(corners_of(loaded->mesh, 0), (Corners{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}));

  const std::vector<std::uint32_t> indices{3, 2, 1, 77, 0, 1, 2};
  view.indices = indices.data();
  view.triangle_count = 2;
  view.triangle_stride = 16;
  ASSERT_TRUE(write_ply(folder_ / "a.ply", view));
  loaded = read_mesh(folder_ / "a.ply");
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{3, 2, 1}, {0, 1, 2}}));
}

TEST_F(WritePly, RefusesWhatCouldNotBeReadBack) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 3}}, ""};
  expect_error(write_ply(folder_ / "a.ply", mesh), ErrorCode::malformed, {"a.ply", "triangle 1 ", "vertex 3,"});
  MeshView view = mesh;
  view.vertex_stride = 8;
  expect_error(write_ply(folder_ / "a.ply", view), ErrorCode::invalid_argument, {"stride is 8"});
  view = mesh;
  view.triangle_stride = 4;
  expect_error(write_ply(folder_ / "a.ply", view), ErrorCode::invalid_argument, {"stride is 4"});
  view = mesh;
  view.positions = nullptr;
  expect_error(write_ply(folder_ / "a.ply", view), ErrorCode::invalid_argument, {"no positions"});
  view = mesh;
  view.triangle_count = std::size_t{1} << 31;
  expect_error(write_ply(folder_ / "a.ply", view), ErrorCode::too_large, {"2^31 - 1"});
  EXPECT_EQ(files_in_folder(), 0u) << "a failed write leaves nothing behind";
}

TEST_F(WritePly, AnEmptyMeshIsAValidFileWithoutTriangles) {
  ASSERT_TRUE(write_ply(folder_ / "a.ply", TriangleMesh{}));
  expect_error(read_mesh(folder_ / "a.ply"), ErrorCode::malformed, {"no triangles"});
}

}  // namespace
}  // namespace boxwood::io::test
