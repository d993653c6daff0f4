#include <fcntl.h>
#include <png.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>

#include "unit/io/io_test_support.h"

namespace boxwood::io::test {
namespace {

namespace fs = std::filesystem;

using WriteFile = InFolder;

TEST_F(WriteFile, MakesAndReplaces) {
  const fs::path path = folder_ / "a.txt";
  ASSERT_TRUE(write_file(path, "one"));
  EXPECT_EQ(content_of(path), "one");
  ASSERT_TRUE(write_file(path, ""));
  EXPECT_EQ(content_of(path), "");
  ASSERT_TRUE(write_file(path, [](const Sink& sink) -> Status {
    for (const char* part : {"in ", "three ", "parts"})
      if (Status status = sink(part, std::strlen(part)); !status) return status;
    return {};
  }));
  EXPECT_EQ(content_of(path), "in three parts");
  EXPECT_EQ(files_in_folder(), 1u);
}

TEST_F(WriteFile, RelativeNamesAndVeryLongOnes) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  const std::string longest(255, 'n');
  const Status short_status = write_file("relative.txt", "x");
  const Status long_status = write_file(longest, "y");
  fs::current_path(before);
  EXPECT_TRUE(short_status);
  EXPECT_TRUE(long_status);
  EXPECT_EQ(content_of(folder_ / "relative.txt"), "x");
  EXPECT_EQ(content_of(folder_ / longest), "y");
  expect_error(write_file(folder_ / (longest + "n"), "z"), ErrorCode::unwritable, {"the name is too long"});
}

TEST_F(WriteFile, AFailureKeepsTheOldContent) {
  const fs::path path = folder_ / "a.txt";
  ASSERT_TRUE(write_file(path, "old"));
  const Status failed = write_file(path, [](const Sink& sink) -> Status {
    if (Status status = sink("new", 3); !status) return status;
    return {ErrorCode::unsupported, "changed my mind"};
  });
  expect_error(failed, ErrorCode::unsupported, {"changed my mind"});
  EXPECT_EQ(content_of(path), "old");
  expect_error(write_file(path, [](const Sink&) -> Status { throw std::bad_alloc(); }), ErrorCode::out_of_memory,
               {"a.txt", "memory"});
  EXPECT_EQ(content_of(path), "old");
  EXPECT_THROW((void)write_file(path, [](const Sink&) -> Status { throw std::runtime_error("the caller's own"); }),
               std::runtime_error);
  EXPECT_EQ(content_of(path), "old");
  EXPECT_EQ(files_in_folder(), 1u);
}

// A limit on the file size makes real writes fail half-way, as a full disk does.
TEST_F(WriteFile, AFullDiskEvenWhenTheCallerIgnoresIt) {
  ASSERT_TRUE(write_file(folder_ / "a.txt", "old"));
  rlimit old_limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit = old_limit;
  limit.rlim_cur = 1000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  const std::string content(600, 'x');
  int calls = 0;
  const Status status = write_file(folder_ / "a.txt", [&](const Sink& sink) -> Status {
    for (; calls < 5; ++calls) (void)sink(content.data(), content.size());
    return {};
  });
  ::setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  expect_error(status, ErrorCode::unwritable, {"a.txt"});
  EXPECT_EQ(calls, 5);
  EXPECT_EQ(content_of(folder_ / "a.txt"), "old");
  EXPECT_EQ(files_in_folder(), 1u);
}

TEST_F(WriteFile, NoSpaceLeft) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  expect_error(write_file("/dev/full", "x"), ErrorCode::unwritable, {"'/dev/full'", "no space"});
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(WriteFile, PlacesThatCannotBeWritten) {
  expect_error(write_file(folder_ / "no" / "a.txt", "x"), ErrorCode::unwritable,
               {"a.txt", "the folder '" + (folder_ / "no").string() + "' does not exist"});
  expect_error(write_file(folder_, "x"), ErrorCode::unwritable, {"it is a folder"});
  expect_error(write_file(folder_ / "", "x"), ErrorCode::unwritable, {"it is a folder"});
  expect_error(write_file(file("plain", "") / "a.txt", "x"), ErrorCode::unwritable, {"not a folder"});
  expect_error(write_file("", "x"), ErrorCode::invalid_argument, {"without a name"});
  expect_error(write_file(folder_ / "a.txt", std::function<Status(const Sink&)>()), ErrorCode::invalid_argument,
               {"a.txt", "empty"});
  EXPECT_EQ(files_in_folder(), 1u);
}

TEST_F(WriteFile, AFolderThatIsReadOnly) {
  // The superuser may write everywhere but into the kernel's own folders.
  fs::path target = "/sys/boxwood_test.txt";
  if (::geteuid() != 0) {
    fs::create_directory(folder_ / "locked");
    fs::permissions(folder_ / "locked", fs::perms::owner_read | fs::perms::owner_exec);
    target = folder_ / "locked" / "a.txt";
  } else if (!fs::exists("/sys/kernel")) {  // a bare folder where nothing is mounted, as in a chroot
    GTEST_SKIP() << "nowhere is it read-only for the superuser";
  }
  expect_error(write_file(target, "x"), ErrorCode::unwritable, {"can't be written to"});
}

TEST_F(WriteFile, AWriteProtectedFile) {
  if (::geteuid() == 0) GTEST_SKIP() << "the superuser may write to every file";
  const fs::path path = file("a.txt", "old");
  fs::permissions(path, fs::perms::owner_read);
  expect_error(write_file(path, "new"), ErrorCode::unwritable, {"permission denied"});
  EXPECT_EQ(content_of(path), "old");
}

TEST_F(WriteFile, KeepsPermissionsAndFollowsLinks) {
  fs::create_directory(folder_ / "sub");
  const fs::path path = file("sub/a.txt", "old");
  fs::permissions(path, fs::perms(0640));
  fs::create_symlink("sub/a.txt", folder_ / "link");
  ASSERT_TRUE(write_file(folder_ / "link", "new"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(content_of(path), "new");
  EXPECT_EQ(fs::status(path).permissions(), fs::perms(0640));
  fs::create_symlink("sub/later.txt", folder_ / "dangling");
  ASSERT_TRUE(write_file(folder_ / "dangling", "made"));
  EXPECT_EQ(content_of(folder_ / "sub" / "later.txt"), "made");
  fs::create_symlink("circle", folder_ / "circle");
  expect_error(write_file(folder_ / "circle", "x"), ErrorCode::unwritable, {"symbolic links"});
}

TEST_F(WriteFile, DevicesAndPipesDirectly) {
  ASSERT_TRUE(write_file("/dev/null", "x"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));

  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  ASSERT_TRUE(write_file(pipe, "through"));
  char text[16] = {};
  EXPECT_EQ(::read(reader, text, sizeof(text)), 7);
  EXPECT_STREQ(text, "through");
  ::close(reader);
  EXPECT_EQ(files_in_folder(), 1u);
}

// Redirected streams are files; writing must go on where the stream is, not replace the file.
TEST_F(WriteFile, StreamsOfThisProcess) {
  const fs::path path = folder_ / "out.txt";
  const int stream = ::open(path.c_str(), O_WRONLY | O_CREAT, 0600);
  ASSERT_GE(stream, 0);
  ASSERT_EQ(::write(stream, "before ", 7), 7);
  ASSERT_TRUE(write_file("/dev/fd/" + std::to_string(stream), "now "));
  ASSERT_EQ(::write(stream, "after", 5), 5);
  EXPECT_EQ(content_of(path), "before now after");

  const int saved = ::dup(1);
  std::fflush(stdout);
  ::dup2(stream, 1);
  const Status status = write_file("/dev/stdout", "!");
  ::dup2(saved, 1);
  ::close(saved);
  ::close(stream);
  EXPECT_TRUE(status);
  EXPECT_EQ(content_of(path), "before now after!");
  expect_error(write_file("/dev/fd/987654", "x"), ErrorCode::unwritable, {"/dev/fd/987654"});
}

using WritePng = InFolder;

TEST_F(WritePng, RoundTrip) {
  Image image{17, 5, {}};
  for (int i = 0; i < 17 * 5 * 3; ++i) image.rgb.push_back(static_cast<std::uint8_t>(i * 37));
  ASSERT_TRUE(write_png(folder_ / "a.png", image));
  EXPECT_EQ(files_in_folder(), 1u);
  png_image png;
  std::memset(&png, 0, sizeof(png));
  png.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&png, (folder_ / "a.png").c_str())) << png.message;
  EXPECT_EQ(png.width, 17u);
  EXPECT_EQ(png.height, 5u);
  EXPECT_EQ(png.format, static_cast<png_uint_32>(PNG_FORMAT_RGB));
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(png));
  ASSERT_TRUE(png_image_finish_read(&png, nullptr, rgb.data(), 0, nullptr)) << png.message;
  EXPECT_EQ(rgb, image.rgb);
}

TEST_F(WritePng, NoiseNeedsNoMoreThanTheBound) {
  Image image{301, 203, {}};
  std::uint32_t state = 1;
  for (int i = 0; i < 301 * 203 * 3; ++i) {
    state = state * 1664525u + 1013904223u;
    image.rgb.push_back(static_cast<std::uint8_t>(state >> 24));
  }
  EXPECT_TRUE(write_png(folder_ / "noise.png", image));
  EXPECT_TRUE(write_png("/dev/null", image));
}

TEST_F(WritePng, RefusesPicturesThatContradictThemselves) {
  expect_error(write_png(folder_ / "a.png", {0, 4, {}}), ErrorCode::invalid_argument, {"a.png", "0 x 4"});
  expect_error(write_png(folder_ / "a.png", {4, -1, {}}), ErrorCode::invalid_argument, {"4 x -1"});
  expect_error(write_png(folder_ / "a.png", {2, 2, std::vector<std::uint8_t>(11)}), ErrorCode::invalid_argument,
               {"2 x 2", "12 bytes", "11"});
  expect_error(write_png(folder_ / "a.png", {2000000000, 2000000000, {}}), ErrorCode::too_large, {"2^30"});
  expect_error(write_png(folder_ / "no" / "a.png", {1, 1, {1, 2, 3}}), ErrorCode::unwritable, {"does not exist"});
  EXPECT_EQ(files_in_folder(), 0u);
}

}  // namespace
}  // namespace boxwood::io::test
