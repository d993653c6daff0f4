// The entry: what it refuses, progress and cancelling.
#include "builders/build.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "unit/builders/box_count.h"
#include "unit/builders/reference_shapes.h"

namespace boxwood {
namespace {

Error build_error(refs::ReferenceSet&& set, const builders::BuildOptions& options = {}) {
  SequentialExecutor executor;
  const auto tree = builders::build(std::move(set), options, {executor});
  EXPECT_FALSE(tree);
  return tree ? Error{} : tree.error();
}

TEST(Build, PassesOnErrorsOfOptions) {
  EXPECT_EQ(build_error(testing::reference_set(testing::soup(4, 1)), {"nonsense", {}}).code, ErrorCode::unknown_name);
  EXPECT_EQ(build_error(testing::reference_set(testing::soup(4, 1)), {"binned-sah", {{"bins", "1"}}}).code,
            ErrorCode::out_of_range);
  EXPECT_EQ(build_error({}, {"nonsense", {}}).code, ErrorCode::unknown_name) << "even when there is nothing to build";
}

TEST(Build, RefusesReferencesThatCannotBe) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Box bad_boxes[] = {{{0, nan, 0}, {1, 1, 1}},
                           {{0, 0, 0}, {1, 1, kInfinity}},
                           {{0, 0, 0}, {1, 1, nan}},
                           {{-kInfinity, 0, 0}, {1, 1, 1}},
                           {{0, 2, 0}, {1, 1, 1}},
                           {{0, 0, 0}, {1, 1, 2e18f}},
                           Box{}};
  for (const Box& box : bad_boxes) {
    testing::Boxes boxes = testing::soup(100000, 3);
    boxes[77777] = boxes[88888] = box;
    const Error error = build_error(testing::reference_set(boxes));
    EXPECT_EQ(error.code, ErrorCode::malformed);
    EXPECT_NE(error.message.find("reference 77777 (primitive 77777)"), std::string::npos) << error.message;
  }
}

TEST(Build, RefusesPrimitivesThatDoNotExist) {
  refs::ReferenceSet set = testing::reference_set(testing::soup(10, 3));
  set.references[4].primitive = 10;
  const Error error = build_error(std::move(set));
  EXPECT_EQ(error.code, ErrorCode::malformed);
  EXPECT_NE(error.message.find("reference 4 names primitive 10 of only 10"), std::string::npos) << error.message;
}

TEST(Build, RefusesMoreThanABuilderTakes) {
  builders::BuilderInfo info = builders::registry()[0];
  info.id = "small";
  info.largest_sensible = 10;
  EXPECT_TRUE(builders::check_size(info, testing::reference_set(testing::soup(10, 1))));
  const Status status = builders::check_size(info, testing::reference_set(testing::soup(11, 1)));
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::too_large);
  EXPECT_EQ(status.error().message, "builder 'small' takes at most 10 references, not 11");
}

TEST(Build, RefusesMorePrimitivesThanCanBeCounted) {
  refs::ReferenceSet set = testing::reference_set(testing::soup(10, 1));
  set.primitive_count = std::size_t{1} << 31;
  const Error error = build_error(std::move(set));
  EXPECT_EQ(error.code, ErrorCode::too_large);
  EXPECT_NE(error.message.find("2147483648"), std::string::npos) << error.message;
}

TEST(Build, ProgressGrowsToOneAndNeverRunsTwiceAtOnce) {
  for (const builders::BuilderInfo& info : builders::registry()) {
    ThreadExecutor executor(2);
    std::vector<double> shares;
    std::atomic<int> inside = 0;
    builders::BuildContext context{executor};
    context.progress = [&](double share) {
      EXPECT_EQ(inside.fetch_add(1), 0);
      shares.push_back(share);
      inside.fetch_sub(1);
    };
    const auto boxes = testing::soup(testing::box_count(info, 150000, 6000), 6);
    const auto tree = builders::build(testing::reference_set(boxes), {info.id, {}}, context);
    ASSERT_TRUE(tree);
    ASSERT_FALSE(shares.empty()) << info.id;
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end())) << info.id;
    EXPECT_GE(shares.front(), 0.0);
    EXPECT_EQ(shares.back(), 1.0) << info.id;
  }
}

TEST(Build, CancelledBeforehandReturnsAnError) {
  for (const builders::BuilderInfo& info : builders::registry()) {
    for (const std::size_t count : {std::size_t{1000}, std::size_t{150000}}) {
      SequentialExecutor executor;
      const std::atomic<bool> cancel = true;
      builders::BuildContext context{executor};
      context.cancel = &cancel;
      const auto tree = builders::build(testing::reference_set(testing::soup(count, 6)), {info.id, {}}, context);
      ASSERT_FALSE(tree) << info.id;
      EXPECT_NE(tree.error().message.find("cancelled"), std::string::npos);
    }
  }
}

TEST(Build, CancelledHalfWayReturnsAnError) {
  for (const char* id : {"binned-sah", "sweep-sah", "middle", "equal-counts", "spatial-split", "sbvh", "kd"}) {
    ThreadExecutor executor(2);
    std::atomic<bool> cancel = false;
    builders::BuildContext context{executor};
    context.cancel = &cancel;
    context.progress = [&](double) { cancel = true; };
    EXPECT_FALSE(builders::build(testing::reference_set(testing::soup(200000, 6)), {id, {}}, context)) << id;
  }
}

TEST(Build, RunsFromSeveralThreadsAtOnce) {
  const testing::Boxes boxes = testing::soup(20000, 8);
  ThreadExecutor executor(2);
  std::vector<std::uint64_t> hashes(4);
  std::vector<std::thread> threads;
  for (std::uint64_t& hash : hashes)
    threads.emplace_back([&] {
      const auto tree = builders::build(testing::reference_set(boxes), {}, {executor});
      hash = tree ? tree::hash(*tree) : 0;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_NE(hashes[0], 0u);
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

}  // namespace
}  // namespace boxwood
