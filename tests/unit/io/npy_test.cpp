#include <cmath>

#include "io/npy_header.h"
#include "unit/io/io_test_support.h"

namespace boxwood::io::test {
namespace {

using ReadRays = InFolder;

// A file as numpy.save writes it; every part can be wrong.
std::string npy(const std::string& dictionary, const std::string& data, int version = 1, std::size_t padding = 0) {
  const std::string text = dictionary + std::string(padding, ' ') + "\n";
  std::string bytes = "\x93NUMPY" + std::string{static_cast<char>(version), '\0'};
  bytes += version == 1 ? bytes_of(static_cast<std::uint16_t>(text.size()))
                        : bytes_of(static_cast<std::uint32_t>(text.size()));
  return bytes + text + data;
}

std::string dictionary(const std::string& type, const std::string& shape, const std::string& order = "False") {
  return "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }";
}

// Element (row, column) is 10 * row + column + 0.5.
template <class T>
std::string numbers(int rows, int columns, bool big = false, bool by_column = false) {
  std::string data;
  for (int i = 0; i < rows * columns; ++i) {
    const int row = by_column ? i % rows : i / columns, column = by_column ? i / rows : i % columns;
    data += bytes_of(static_cast<T>(10 * row + column + 0.5), big);
  }
  return data;
}

void expect_rays(const Result<std::vector<Ray>>& rays, std::size_t rows, int columns) {
  ASSERT_TRUE(rays) << rays.error().message;
  ASSERT_EQ(rays->size(), rows);
  for (std::size_t i = 0; i < rows; ++i) {
    const float f = static_cast<float>(10 * i) + 0.5f;
    EXPECT_EQ((*rays)[i].origin, (Vec3{f, f + 1, f + 2}));
    EXPECT_EQ((*rays)[i].direction, (Vec3{f + 3, f + 4, f + 5}));
    EXPECT_EQ((*rays)[i].tmin, columns == 8 ? f + 6 : 0);
    EXPECT_EQ((*rays)[i].tmax, columns == 8 ? f + 7 : kInfinity);
  }
}

TEST_F(ReadRays, AllTypesOrdersAndVersions) {
  for (const int columns : {6, 8})
    for (const bool big : {false, true})
      for (const bool by_column : {false, true})
        for (const int version : {1, 2, 3}) {
          const std::string shape = "(3, " + std::to_string(columns) + ")", order = by_column ? "True" : "False";
          const std::string prefix = big ? ">" : "<";
          expect_rays(read_rays(file("a.npy", npy(dictionary(prefix + "f4", shape, order),
                                                  numbers<float>(3, columns, big, by_column), version, 20))),
                      3, columns);
          expect_rays(read_rays(file("a.npy", npy(dictionary(prefix + "f8", shape, order),
                                                  numbers<double>(3, columns, big, by_column), version, 3))),
                      3, columns);
        }
}

TEST_F(ReadRays, OtherSpellingsOfTheHeader) {
  const std::string data = numbers<float>(2, 6);
  for (const char* header : {"{\"shape\":(2,6),\"fortran_order\":False,\"descr\":\"<f4\"}",
                             "{ 'descr' : '=f4' , 'fortran_order' : False , 'shape' : ( 2L , 6L , ) }"})
    expect_rays(read_rays(file("a.npy", npy(header, data))), 2, 6);
  expect_rays(read_rays(file("a.npy", npy(dictionary("<f4", "(2, 6)"), data + "more behind"))), 2, 6);
}

TEST_F(ReadRays, NoRaysAtAll) {
  expect_rays(read_rays(file("a.npy", npy(dictionary("<f4", "(0, 6)"), ""))), 0, 6);
  expect_rays(read_rays(file("a.npy", npy(dictionary("<f8", "(0, 8)", "True"), ""))), 0, 8);
}

TEST_F(ReadRays, ValuesAreNotJudged) {
  std::string data;
  for (const double value : {std::nan(""), -HUGE_VAL, 1e300, 1e-300, 0.1, -0.0}) data += bytes_of(value);
  const auto rays = read_rays(file("a.npy", npy(dictionary("<f8", "(1, 6)"), data)));
  ASSERT_TRUE(rays) << rays.error().message;
  EXPECT_TRUE(std::isnan((*rays)[0].origin.x));
  EXPECT_EQ((*rays)[0].origin.y, -kInfinity);
  EXPECT_EQ((*rays)[0].origin.z, kInfinity);
  EXPECT_EQ((*rays)[0].direction, (Vec3{0, 0.1f, 0}));
  EXPECT_TRUE(std::signbit((*rays)[0].direction.z));
}

TEST_F(ReadRays, WrongTypesAndShapesAreNamed) {
  for (const char* type : {"<f2", "<i4", "|b1", "<c8", "|O", "f4", "<f44", ""})
    expect_error(read_rays(file("a.npy", npy(dictionary(type, "(1, 6)"), numbers<double>(1, 6)))), ErrorCode::malformed,
                 {"a.npy", "type " + std::string(type), "float32"});
  const std::string structured =
      "{'descr': [('t', '<f4'), ('uv', [('u', '<f4')])], 'fortran_order': False, 'shape': (1,)}";
  expect_error(read_rays(file("a.npy", npy(structured, "12345678"))), ErrorCode::malformed, {"[('t', '<f4'), ('uv'"});
  for (const char* shape : {"()", "(6,)", "(1, 7)", "(6, 1)", "(1, 6, 1)"})
    expect_error(read_rays(file("a.npy", npy(dictionary("<f4", shape), numbers<double>(1, 8)))), ErrorCode::malformed,
                 {"shape is " + std::string(shape), "(N, 6) or (N, 8)"});
}

TEST_F(ReadRays, TruncatedAndAbsurd) {
  const std::string whole = npy(dictionary("<f4", "(2, 6)"), numbers<float>(2, 6));
  for (std::size_t size = 1; size < whole.size(); ++size) {
    const auto rays = read_rays(file("a.npy", whole.substr(0, size)));
    ASSERT_FALSE(rays) << size;
    EXPECT_EQ(rays.error().code, ErrorCode::malformed) << rays.error().message;
    EXPECT_EQ(rays.error().message.find("truncated") != std::string::npos, size >= 6) << rays.error().message;
  }
  expect_error(read_rays(file("a.npy", npy(dictionary("<f4", "(1000000000000, 6)"), "1234"))), ErrorCode::malformed,
               {"truncated", "24000000000000 bytes", "has 4"});
  expect_error(read_rays(file("a.npy", npy(dictionary("<f8", "(18446744073709551615, 8)"), "1234"))),
               ErrorCode::malformed, {"2^64"});
  expect_error(read_rays(file("a.npy", npy(dictionary("<f8", "(18446744073709551616, 8)"), "1234"))),
               ErrorCode::malformed, {"header is not one of NumPy's"});
  expect_error(read_rays(file("a.npy", "\x93NUMPY" + std::string{2, 0} + bytes_of(std::uint32_t{0xfffffff0}))),
               ErrorCode::malformed, {"4294967280 bytes"});
}

TEST_F(ReadRays, FilesThatAreNone) {
  expect_error(read_rays(folder_ / "missing.npy"), ErrorCode::not_found, {"missing.npy"});
  expect_error(read_rays(folder_), ErrorCode::unreadable, {"it is a folder"});
  expect_error(read_rays(file("a.npy", "")), ErrorCode::malformed, {"it is empty"});
  expect_error(read_rays(file("a.npy", "0 0 0 1 0 0\n")), ErrorCode::malformed, {"no NumPy file"});
  expect_error(read_rays(file("a.npz", "PK\3\4 and so on")), ErrorCode::malformed, {".npz"});
  expect_error(read_rays(file("a.npy", "\x93NUMPY" + std::string{4, 0, 1, 0} + "{}")), ErrorCode::malformed, {"4.0"});
  for (const char* header :
       {"", "{}", "{'descr': '<f4'}", "[1]", "{'descr': <f4, 'fortran_order': False, 'shape': (1, 6)}",
        "{'descr': '<f4', 'fortran_order': Maybe, 'shape': (1, 6)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (-1, 6)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (1 6)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 6), 'more': 1}",
        "{'descr': [[[, 'fortran_order': False, 'shape': (1, 6)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 6)"})
    expect_error(read_rays(file("a.npy", npy(header, numbers<float>(1, 6)))), ErrorCode::malformed,
                 {"header is not one of NumPy's"});
}

TEST_F(ReadRays, FromAPipe) {
  for (const char* order : {"False", "True"}) {
    const std::string text =
        npy(dictionary("<f4", "(3, 8)", order), numbers<float>(3, 8, false, std::string_view(order) == "True"));
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    ASSERT_EQ(::write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
    ::close(ends[1]);
    expect_rays(read_rays("/dev/fd/" + std::to_string(ends[0])), 3, 8);
    ::close(ends[0]);
  }
}

using WriteNpy = InFolder;

TEST_F(WriteNpy, HeadersAreAlignedAndExact) {
  for (std::uint64_t count = 1; count < 10'000'000'000; count *= 10) {
    const std::string header = make_npy_header("'<f4'", {count, 8});
    EXPECT_EQ(header.size() % 64, 0u);
    EXPECT_EQ(header.back(), '\n');
    EXPECT_EQ(static_cast<unsigned char>(header[8]) + 256u * static_cast<unsigned char>(header[9]), header.size() - 10);
  }
  const std::string expected = "\x93NUMPY" + std::string({1, 0, 118, 0}) +
                               "{'descr': '|b1', 'fortran_order': False, 'shape': (5,), }" + std::string(60, ' ') +
                               "\n";
  EXPECT_EQ(make_npy_header("'|b1'", std::vector<std::uint64_t>{5}), expected);
}

TEST_F(WriteNpy, RaysRoundTrip) {
  std::vector<Ray> rays;
  for (int i = 0; i < 10001; ++i) {
    const float f = static_cast<float>(i);
    rays.push_back({{f, -f, f / 3}, f / 7, {1 / (f + 1), 0, -1}, i % 2 ? kInfinity : f});
  }
  ASSERT_TRUE(write_rays(folder_ / "a.npy", rays));
  EXPECT_EQ(std::filesystem::file_size(folder_ / "a.npy"), 128 + 32 * rays.size());
  const auto read = read_rays(folder_ / "a.npy");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), rays.size());
  EXPECT_EQ(std::memcmp(read->data(), rays.data(), rays.size() * sizeof(Ray)), 0);
  ASSERT_TRUE(write_rays(folder_ / "a.npy", {}));
  EXPECT_TRUE(read_rays(folder_ / "a.npy"));
}

TEST_F(WriteNpy, Hits) {
  const std::vector<HitRecord> hits{{1.5f, 0.25f, 0.75f, 7}, {kInfinity, 0, 0, 4294967295u}};
  ASSERT_TRUE(write_hits(folder_ / "a.npy", hits));
  const std::string content = content_of(folder_ / "a.npy");
  ASSERT_EQ(content.size(), 128u + 32);
  EXPECT_NE(content.find("{'descr': [('t', '<f4'), ('u', '<f4'), ('v', '<f4'), ('primitive', '<u4')], "
                         "'fortran_order': False, 'shape': (2,), }"),
            std::string::npos);
  EXPECT_EQ(content.substr(128), bytes_of(1.5f) + bytes_of(0.25f) + bytes_of(0.75f) + bytes_of(7u) +
                                     bytes_of(kInfinity) + bytes_of(0.f) + bytes_of(0.f) + "\xff\xff\xff\xff");
}

TEST_F(WriteNpy, OcclusionIsZeroOrOne) {
  const std::vector<std::uint8_t> occluded{0, 1, 255, 0};
  ASSERT_TRUE(write_occlusion(folder_ / "a.npy", occluded));
  const std::string content = content_of(folder_ / "a.npy");
  EXPECT_NE(content.find("'descr': '|b1'"), std::string::npos);
  EXPECT_NE(content.find("'shape': (4,)"), std::string::npos);
  EXPECT_EQ(content.substr(content.size() - 4), (std::string{0, 1, 1, 0}));
}

TEST_F(WriteNpy, UnwritablePlaces) {
  const auto path = folder_ / "no" / "a.npy";
  expect_error(write_hits(path, {}), ErrorCode::unwritable, {"a.npy", "does not exist"});
  expect_error(write_rays(path, {}), ErrorCode::unwritable, {"does not exist"});
  expect_error(write_occlusion(path, {}), ErrorCode::unwritable, {"does not exist"});
}

}  // namespace
}  // namespace boxwood::io::test
