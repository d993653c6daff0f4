// The kernels of every instruction set against those of the baseline, bit for bit.
#include "builders/kernels/reference_kernels.h"

#include <gtest/gtest.h>

#include <cstring>

#include "builders/parts/area_scale.h"
#include "unit/builders/reference_shapes.h"

namespace boxwood::builders {
namespace {

/// Random boxes, some without extent, some at zeros of both signs.
testing::Boxes boxes_of(std::size_t count, std::uint32_t seed) {
  testing::Boxes boxes = testing::soup(count, seed);
  for (std::size_t i = 0; i < count; i += 7) boxes[i].upper = boxes[i].lower;
  for (std::size_t i = 3; i < count; i += 11) boxes[i] = {{-0.0f, 0, -1}, {0, -0.0f, 0}};
  return boxes;
}

Box4 centroids_of(const refs::ReferenceSet& set) {
  Box4 box = Box4::empty();
  for (const refs::Reference& reference : set.references) box.grow(centroid2(Box4::of(reference), xyz_mask()));
  return box;
}

/// All bits of lanes 0 to 2.
bool same(const Box4& a, const Box4& b) {
  const Box x = a.box(), y = b.box();
  return std::memcmp(&x, &y, sizeof x) == 0;
}

class ReferenceKernelsTest : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    const auto all = all_reference_kernels();
    for (const auto& kernels : all) best_.push_back(kernels);
    baseline_ = best_.back();
    best_.pop_back();
    if (best_.empty()) GTEST_SKIP() << "this processor has the baseline only, " << baseline_.name;
  }

  std::vector<ReferenceKernels> best_;
  ReferenceKernels baseline_;
};

INSTANTIATE_TEST_SUITE_P(Counts, ReferenceKernelsTest, ::testing::Values(1, 2, 3, 15, 16, 17, 100, 1001));

TEST_P(ReferenceKernelsTest, FillTheSameBinsAndFindTheSameSplit) {
  const auto set = testing::reference_set(boxes_of(std::size_t(GetParam()), 5));
  for (const int bins : {2, 5, 16, 256}) {
    const BinGrid grid = BinGrid::over(centroids_of(set), bins, -1);
    const auto fill = [&](const ReferenceKernels& kernels, BinTable& table) {
      std::memset(&table, 0, sizeof table);
      table.count = bins;
      for (auto& boxes : table.boxes)
        for (auto& box : boxes.axis) std::fill_n(box, 8, kInfinity);
      kernels.bin(grid, set.references.data(), set.references.size(), table);
    };
    BinTable expected, table;
    fill(baseline_, expected);
    const BinSplit wanted = baseline_.best_split(grid, expected, 0.5f);
    for (const ReferenceKernels& kernels : best_) {
      SCOPED_TRACE(std::string(kernels.name) + ", " + std::to_string(bins) + " bins");
      fill(kernels, table);
      EXPECT_EQ(std::memcmp(&table, &expected, sizeof table), 0);
      const BinSplit split = kernels.best_split(grid, table, 0.5f);
      ASSERT_EQ(split.axis, wanted.axis);
      if (split.axis < 0) continue;
      EXPECT_EQ(split.bin, wanted.bin);
      EXPECT_EQ(split.cost, wanted.cost);
      EXPECT_EQ(split.left_count, wanted.left_count);
      EXPECT_TRUE(same(split.left, wanted.left) && same(split.right, wanted.right));
    }
  }
}

TEST_P(ReferenceKernelsTest, PartTheSameWay) {
  const auto set = testing::reference_set(boxes_of(std::size_t(GetParam()), 6));
  const std::size_t count = set.references.size();
  for (const bool has_boxes : {false, true})
    for (int axis = 0; axis < 3; ++axis) {
      RangeSplit split;
      split.axis = axis;
      split.threshold = set.references[count / 2].centroid2(axis);
      split.has_boxes = has_boxes;
      std::size_t left = 0;
      for (const auto& reference : set.references) left += reference.centroid2(axis) < split.threshold;
      const auto part = [&](const ReferenceKernels& kernels, AlignedBuffer<refs::Reference>& out) {
        out = AlignedBuffer<refs::Reference>(count);
        return kernels.part(split, set.references.data(), count, out.data(), out.data() + left);
      };
      AlignedBuffer<refs::Reference> expected, parted;
      const ReferenceSides wanted = part(baseline_, expected);
      for (const ReferenceKernels& kernels : best_) {
        SCOPED_TRACE(kernels.name);
        const ReferenceSides sides = part(kernels, parted);
        EXPECT_EQ(std::memcmp(parted.data(), expected.data(), expected.bytes()), 0);
        EXPECT_TRUE(same(sides.left.centroids2, wanted.left.centroids2));
        EXPECT_TRUE(same(sides.right.centroids2, wanted.right.centroids2));
        EXPECT_TRUE(same(sides.left.bounds, wanted.left.bounds) && same(sides.right.bounds, wanted.right.bounds));
      }
      // The baseline against the plain rule.
      Box box;
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(expected[i].centroid2(axis) < split.threshold, i < left);
        if (i < left) box.grow(expected[i].box());
      }
      if (has_boxes || left == 0) continue;
      EXPECT_EQ(wanted.left.bounds.box(), box);
    }
}

TEST(MortonCodes, AreThoseOfTheGridOnEveryInstructionSet) {
  auto boxes = boxes_of(1001, 7);
  boxes.push_back({{-1e18f, -1e18f, -1e18f}, {1e18f, 1e18f, -1e18f}});
  boxes.push_back({{1e-42f, -1e-42f, 0}, {3e-42f, 1e-42f, 1e-44f}});
  const auto set = testing::reference_set(boxes);
  for (const Box& grid_box : {Box{{-2, -2, -2}, {2, 2, 2}}, Box{{-2e18f, -2e18f, -2e18f}, {2e18f, 2e18f, 2e18f}},
                              Box{{0, 0, 0}, {1, 0, 1e-42f}}})
    for (const int bits : {1, 10, 21}) {
      const MortonGrid grid(grid_box, bits);
      for (const ReferenceKernels& kernels : all_reference_kernels()) {
        std::vector<KeyedIndex> codes(boxes.size() - 2, KeyedIndex{1, 1, 1});
        kernels.morton_codes(grid, set.references.data(), 2, boxes.size(), codes.data());
        for (std::size_t i = 0; i < codes.size(); ++i) {
          ASSERT_EQ(codes[i].key, grid.code(set.references[i + 2].centroid2()))
              << kernels.name << " " << bits << " " << i;
          ASSERT_EQ(codes[i].index, i + 2);
          ASSERT_EQ(codes[i].other, 0u);
        }
      }
    }
}

}  // namespace
}  // namespace boxwood::builders
