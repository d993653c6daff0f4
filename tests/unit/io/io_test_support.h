// What the tests of this stage share: a folder of their own, files from bytes, a look at errors.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "boxwood/io.h"

namespace boxwood::io::test {

/// A fixture with an empty folder that goes away with it.
class InFolder : public ::testing::Test {
 protected:
  InFolder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(::testing::TempDir()) / ("boxwood_" + std::string(test->test_suite_name()) + "_" +
                                                             test->name() + "_" + std::to_string(::getpid()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~InFolder() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  std::filesystem::path file(const std::string& name, std::string_view content) const {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::remove(path);  // to cut a file to length zero instead makes some file systems wait for the disk
    std::ofstream(path, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
    return path;
  }

  static std::string content_of(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  std::size_t files_in_folder() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }

  std::filesystem::path folder_;
};

/// The result failed with this code and one sentence that has all of `parts`.
template <class T>
void expect_error(const Result<T>& result, ErrorCode code, const std::vector<std::string>& parts) {
  ASSERT_FALSE(result) << "expected an error that says " << (parts.empty() ? "" : parts[0]);
  const std::string& message = result.error().message;
  EXPECT_EQ(result.error().code, code) << message;
  for (const std::string& part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks: " << part;
  EXPECT_EQ(message.find_first_of("\r\n\t"), std::string::npos) << message;
}

/// The bytes of a value, in this machine's order (little-endian) or the other one.
template <class T>
std::string bytes_of(T value, bool big_endian = false) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return big_endian ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

inline std::array<Vec3, 3> corners_of(const TriangleMesh& mesh, std::size_t triangle) {
  const Triangle t = mesh.view().triangle(triangle);
  return {t.v0, t.v1, t.v2};
}

using Corners = std::array<Vec3, 3>;

}  // namespace boxwood::io::test
