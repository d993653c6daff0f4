// Decoding and arranging: what comes back is what went in.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "boxwood/builders.h"
#include "boxwood/layouts.h"
#include "boxwood/optimizers.h"
#include "support/meshes.h"

namespace boxwood::layouts {
namespace {

SequentialExecutor executor;

struct Encoded {
  tree::BinaryTree tree;
  Layout layout;
};

Encoded encode(LayoutId id, const TriangleMesh& mesh, const char* builder) {
  auto references = refs::make_references(mesh, executor);
  EXPECT_TRUE(references);
  auto tree = builders::build(std::move(*references), {.builder = builder}, {executor});
  EXPECT_TRUE(tree);
  if (id == LayoutId::linear) {
    auto layout = encode_linear(*tree, mesh, executor);
    return {std::move(*tree), std::move(*layout)};
  }
  auto wide = optimizers::collapse_to_wide(*tree, {.width = width(id)}, executor);
  EXPECT_TRUE(wide);
  auto layout = has_quads(id) ? encode_wide_quads(*wide, mesh, executor) : encode_wide(*wide, mesh, executor);
  EXPECT_TRUE(layout);
  return {std::move(*tree), std::move(*layout)};
}

std::vector<TriangleMesh> meshes() {
  TriangleMesh equal = test::soup(1, 4);
  for (int i = 0; i < 99; ++i) equal.triangles.push_back(equal.triangles[0]);
  return {test::icosphere(3), test::soup(700, 1), test::grid(12), test::soup(1, 2), equal};
}

TEST(Decode, TrianglesAndReferencesComeBack) {
  for (const TriangleMesh& mesh : meshes())
    for (const auto& row : registry())
      for (const char* builder : {"binned-sah", "sbvh"}) {
        const std::string label = std::string(row.name) + " " + builder + " " + mesh.name;
        const Encoded encoded = encode(row.id, mesh, builder);
        const auto decoded = decode(encoded.layout);
        ASSERT_TRUE(decoded) << label;
        ASSERT_EQ(decoded->mesh().triangle_count, mesh.triangles.size()) << label;
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
          const Triangle expected = mesh.view().triangle(i), found = decoded->mesh().triangle(i);
          ASSERT_EQ(std::memcmp(&expected, &found, sizeof expected), 0) << label << " triangle " << i;
        }
        EXPECT_EQ(decoded->tree.first_child.size(), row.id == LayoutId::linear
                                                        ? std::max<std::size_t>(encoded.layout.node_count / 2, 1) + 1
                                                        : encoded.layout.node_count + 1)
            << label;
        EXPECT_TRUE(decoded->tree.bounds == encoded.layout.bounds);
      }
}

TEST(Decode, EncodingAgainGivesAValidLayoutOfTheSameSize) {
  for (const TriangleMesh& mesh : meshes())
    for (const LayoutId id : {LayoutId::wide4, LayoutId::wide8, LayoutId::wide8_quads, LayoutId::wide16}) {
      const Encoded encoded = encode(id, mesh, "sbvh");
      const auto decoded = decode(encoded.layout);
      ASSERT_TRUE(decoded);
      const auto again = has_quads(id) ? encode_wide_quads(decoded->tree, decoded->mesh(), executor)
                                       : encode_wide(decoded->tree, decoded->mesh(), executor);
      ASSERT_TRUE(again);
      EXPECT_EQ(again->bytes(), encoded.layout.bytes());
      EXPECT_EQ(again->leaf_count, encoded.layout.leaf_count);
      const Status valid = validate(*again, encoded.tree.references.span(), true, mesh);
      EXPECT_TRUE(valid) << name(id) << " " << mesh.name << ": " << valid.error().message;
    }
}

TEST(Decode, Empty) {
  for (const auto& row : registry()) {
    Layout layout;
    layout.id = row.id;
    const auto decoded = decode(layout);
    ASSERT_TRUE(decoded);
    EXPECT_TRUE(decoded->tree.children.empty());
    EXPECT_EQ(decoded->mesh().triangle_count, 0u);
  }
}

/// Keeps the root first and parents before children, everything else backwards.
Arrangement backwards(const Layout& layout, std::size_t width) {
  Arrangement how;
  const auto decoded = decode(layout);
  const auto& first = decoded->tree.first_child;
  std::vector<std::uint32_t> stack{0};
  how.lanes.resize(layout.node_count * width);
  while (!stack.empty()) {
    const std::uint32_t node = stack.back();
    stack.pop_back();
    how.nodes.push_back(node);
    const std::size_t used = first[node + 1] - first[node];
    for (std::size_t i = 0; i < width; ++i) how.lanes[node * width + i] = std::uint8_t(i < used ? used - 1 - i : i);
    for (std::uint32_t c = first[node]; c < first[node + 1]; ++c)
      if (decoded->tree.children[c].count == 0) stack.push_back(decoded->tree.children[c].first);
  }
  return how;
}

TEST(Arrange, ValidAndTwiceBackwardsIsForwards) {
  for (const TriangleMesh& mesh : meshes())
    for (const LayoutId id : {LayoutId::wide4, LayoutId::wide8, LayoutId::wide8_quads, LayoutId::wide16}) {
      const auto width = static_cast<std::size_t>(layouts::width(id));
      const Encoded encoded = encode(id, mesh, "binned-sah");
      const auto once = arrange(encoded.layout, backwards(encoded.layout, width));
      ASSERT_TRUE(once);
      const Status valid = validate(*once, encoded.tree.references.span(), false, mesh);
      EXPECT_TRUE(valid) << name(id) << " " << mesh.name << ": " << valid.error().message;
      // First and last child of the root have changed places.
      const auto before = decode(encoded.layout), after = decode(*once);
      EXPECT_TRUE(before->tree.children.front().bounds == after->tree.children[after->tree.first_child[1] - 1].bounds);
      const auto twice = arrange(*once, backwards(*once, width));
      ASSERT_TRUE(twice);
      EXPECT_TRUE(before->tree.children.front().bounds == decode(*twice)->tree.children.front().bounds);
    }
}

TEST(Arrange, Refusals) {
  const TriangleMesh mesh = test::grid(4);
  const Encoded linear = encode(LayoutId::linear, mesh, "middle"), wide = encode(LayoutId::wide8, mesh, "middle");
  EXPECT_NE(arrange(linear.layout, {}).error().message.find("linear"), std::string::npos);
  EXPECT_NE(arrange(wide.layout, {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17}, {}})
                .error()
                .message.find("18 nodes"),
            std::string::npos);
}

}  // namespace
}  // namespace boxwood::layouts
