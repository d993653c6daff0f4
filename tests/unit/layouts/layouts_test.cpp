// Encoders against their checker, and the checker against corrupted layouts.
#include <gtest/gtest.h>

#include "boxwood/builders.h"
#include "boxwood/layouts.h"
#include "boxwood/optimizers.h"
#include "support/meshes.h"

namespace boxwood::layouts {
namespace {

SequentialExecutor executor;

tree::BinaryTree build_tree(const MeshView& mesh, const char* builder = "binned-sah") {
  auto references = refs::make_references(mesh, executor);
  EXPECT_TRUE(references);
  auto tree = builders::build(std::move(*references), {.builder = builder}, {executor});
  EXPECT_TRUE(tree) << tree.error().message;
  return std::move(*tree);
}

Result<Layout> encode(LayoutId id, const tree::BinaryTree& tree, const MeshView& mesh) {
  if (id == LayoutId::linear) return encode_linear(tree, mesh, executor);
  auto wide = optimizers::collapse_to_wide(tree, {.width = width(id)}, executor);
  EXPECT_TRUE(wide) << wide.error().message;
  if (has_quads(id)) return encode_wide_quads(*wide, mesh, executor);
  return encode_wide(*wide, mesh, executor);
}

TEST(Layouts, EveryLayoutOfEveryMeshIsValid) {
  std::vector<TriangleMesh> meshes{test::icosphere(0), test::icosphere(4), test::soup(3000, 1), test::grid(20)};
  TriangleMesh one = test::soup(1, 2), two = test::soup(2, 3), equal = test::soup(1, 4);
  for (int i = 0; i < 99; ++i) equal.triangles.push_back(equal.triangles[0]);
  meshes.insert(meshes.end(), {one, two, equal});
  for (const TriangleMesh& mesh : meshes)
    for (const auto& row : registry())
      for (const char* builder : {"binned-sah", "middle"}) {
        const auto tree = build_tree(mesh, builder);
        const auto layout = encode(row.id, tree, mesh);
        ASSERT_TRUE(layout) << row.name << " " << mesh.name << ": " << layout.error().message;
        const Status valid = validate(*layout, tree.references.span(), false, mesh);
        EXPECT_TRUE(valid) << row.name << " " << mesh.name << ": " << valid.error().message;
        EXPECT_EQ(layout->reference_count, mesh.triangles.size());
        EXPECT_GT(layout->bytes(), 0u);
      }
}

TEST(Layouts, EmptyTree) {
  const TriangleMesh mesh;
  const tree::BinaryTree tree;
  for (const auto& row : registry()) {
    const auto layout = encode(row.id, tree, mesh);
    ASSERT_TRUE(layout) << row.name;
    EXPECT_EQ(layout->root, kNoRoot);
    EXPECT_TRUE(validate(*layout, {}, false, mesh));
  }
}

TEST(Layouts, CheckerFindsCorruption) {
  const TriangleMesh mesh = test::soup(500, 5);
  const auto tree = build_tree(mesh);
  for (const auto& row : registry()) {
    auto corrupted = [&](auto&& change) {
      auto layout = encode(row.id, tree, mesh);
      EXPECT_TRUE(layout);
      change(*layout);
      return validate(*layout, tree.references.span(), false, mesh);
    };
    auto expect_found = [&](auto&& change, const char* word) {
      const Status status = corrupted(change);
      ASSERT_FALSE(status) << row.name << " " << word;
      EXPECT_NE(status.error().message.find(word), std::string::npos) << status.error().message;
    };
    ASSERT_TRUE(corrupted([](Layout&) {}));
    expect_found([](Layout& l) { l.max_stack = 1; }, "max_stack");
    expect_found([](Layout& l) { ++l.node_count; }, "node_count");
    expect_found([](Layout& l) { reinterpret_cast<float*>(l.triangles.data())[0] += 0.25f; }, "differs");
    expect_found([](Layout& l) { l.bounds.upper.x = l.bounds.lower.x; }, "sticks out");
    if (row.id == LayoutId::linear) {
      expect_found([](Layout& l) { reinterpret_cast<LinearNode*>(l.nodes.data())[0].offset = 1 << 29; },
                   "past the array");
      expect_found([](Layout& l) { reinterpret_cast<LinearNode*>(l.nodes.data())[0].offset = 0; }, "does not follow");
    } else if (row.id == LayoutId::wide8 || row.id == LayoutId::wide16) {
      const auto children = [&](Layout& l) {
        return row.id == LayoutId::wide8 ? reinterpret_cast<WideNode<8>*>(l.nodes.data())[0].child
                                         : reinterpret_cast<WideNode<16>*>(l.nodes.data())[0].child;
      };
      expect_found([&](Layout& l) { children(l)[0] = leaf_word(1 << 27, 1); }, "past the blocks");
      expect_found([&](Layout& l) { children(l)[0] = 0; }, "before it");
      expect_found([](Layout& l) { reinterpret_cast<TriangleBlock*>(l.triangles.data())[0].primitive[0] = 5000; },
                   "past the mesh");
      expect_found(
          [](Layout& l) { reinterpret_cast<TriangleBlock*>(l.triangles.data())[0].primitive[0] = kInvalidPrimitive; },
          "unused lane");
    } else if (row.id == LayoutId::wide8_quads) {
      const auto words = [](Layout& l) { return reinterpret_cast<QuadBlock*>(l.triangles.data())[0].primitive; };
      expect_found(
          [](Layout& l) { reinterpret_cast<WideNode<8>*>(l.nodes.data())[0].child[0] = leaf_word(1 << 27, 1); },
          "past the blocks");
      expect_found([&](Layout& l) { words(l)[0] = 5000; }, "past the mesh");
      expect_found([&](Layout& l) { words(l)[0] |= 3 * kQuadTurnBit; }, "turned");
      expect_found([&](Layout& l) { words(l)[0] |= kQuadFlipBit; }, "differs");
      expect_found([&](Layout& l) { words(l)[0] = kInvalidPrimitive; }, "unused lane");
      expect_found([&](Layout& l) { words(l)[4] = 7; }, "differs");
    }
  }
}

TEST(Layouts, RefuseWhatTheyCanNotHold) {
  const TriangleMesh mesh = test::soup(100, 6);
  const auto tree = build_tree(mesh);
  auto wide = optimizers::collapse_to_wide(tree, {.width = 8}, executor);
  ASSERT_TRUE(wide);
  wide->width = 5;
  EXPECT_EQ(encode_wide(*wide, mesh, executor).error().code, ErrorCode::invalid_argument);
  wide->width = 8;
  wide->children[0].count = 33;
  EXPECT_EQ(encode_wide(*wide, mesh, executor).error().code, ErrorCode::too_large);
  EXPECT_EQ(encode_wide_quads(*wide, mesh, executor).error().code, ErrorCode::too_large);
  wide->width = 4;
  EXPECT_EQ(encode_wide_quads(*wide, mesh, executor).error().code, ErrorCode::invalid_argument);
  wide->width = 8;
  MeshView huge = mesh;
  huge.triangle_count = (std::size_t{1} << 29) + 1;
  EXPECT_EQ(encode_wide_quads(*wide, huge, executor).error().code, ErrorCode::too_large);
  TriangleMesh shorter = mesh;
  shorter.triangles.resize(50);
  EXPECT_EQ(encode_linear(tree, shorter, executor).error().code, ErrorCode::out_of_range);
  for (const int width : {4, 8, 16}) {
    auto whole = optimizers::collapse_to_wide(tree, {.width = width}, executor);
    ASSERT_TRUE(whole);
    EXPECT_EQ(encode_wide(*whole, shorter, executor).error().code, ErrorCode::out_of_range);
    MeshView fewer_vertices = mesh;
    --fewer_vertices.vertex_count;
    EXPECT_EQ(encode_wide(*whole, fewer_vertices, executor).error().code, ErrorCode::out_of_range);
    whole->first_child[0] = 0;
    whole->first_child[1] = std::uint32_t(whole->children.size());  // the root takes its children's children
    EXPECT_EQ(encode_wide(*whole, mesh, executor).error().code, ErrorCode::malformed);
  }
}

TEST(Layouts, Names) {
  for (const auto& row : registry()) {
    EXPECT_EQ(*find(row.name), row.id);
    EXPECT_STREQ(name(row.id), row.name);
  }
  const auto unknown = find("wide5");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("'wide5'"), std::string::npos);
  EXPECT_NE(unknown.error().message.find("linear, wide4, wide8"), std::string::npos);
}

}  // namespace
}  // namespace boxwood::layouts
