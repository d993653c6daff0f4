// Small meshes whose properties are known by construction, and executors to compare.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "boxwood/mesh.h"

namespace boxwood::test {

inline TriangleMesh make_mesh(std::vector<Vec3> vertices, std::vector<std::array<std::uint32_t, 3>> triangles) {
  return {std::move(vertices), std::move(triangles), "hand-made"};
}

/// Closed cube from 0 to 1 with 8 shared vertices, outward.
inline TriangleMesh cube() {
  std::vector<Vec3> v;
  for (int i = 0; i < 8; ++i) v.push_back({float(i & 1), float(i >> 1 & 1), float(i >> 2 & 1)});
  return make_mesh(std::move(v), {{0, 1, 5},
                                  {0, 5, 4},
                                  {2, 6, 7},
                                  {2, 7, 3},
                                  {0, 2, 3},
                                  {0, 3, 1},
                                  {4, 5, 7},
                                  {4, 7, 6},
                                  {0, 4, 6},
                                  {0, 6, 2},
                                  {1, 3, 7},
                                  {1, 7, 5}});
}

/// Wavy height field of columns x rows cells: 2 * columns * rows triangles with shared vertices.
inline TriangleMesh wave(int columns, int rows) {
  TriangleMesh mesh;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      mesh.vertices.push_back({float(i), float(i * 7 % 5) * 0.1f + float(j * 3 % 7) * 0.2f, float(j)});
  const auto width = std::uint32_t(columns + 1);
  for (std::uint32_t j = 0; j < std::uint32_t(rows); ++j) {
    for (std::uint32_t i = 0; i < std::uint32_t(columns); ++i) {
      const std::uint32_t a = j * width + i;
      mesh.triangles.push_back({a, a + 1, a + width});
      mesh.triangles.push_back({a + 1, a + width + 1, a + width});
    }
  }
  return mesh;
}

/// The same triangles with three vertices of their own each.
inline TriangleMesh exploded(const TriangleMesh& mesh) {
  TriangleMesh result;
  for (const auto& t : mesh.triangles) {
    const auto first = std::uint32_t(result.vertices.size());
    for (const std::uint32_t v : t) result.vertices.push_back(mesh.vertices[v]);
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

/// The same mesh in heap blocks that end with the last element's last byte, at odd addresses and strides, so that the
/// address sanitizer sees any byte read too many.
class TightView {
 public:
  TightView(const TriangleMesh& mesh, std::size_t vertex_stride, std::size_t triangle_stride, std::size_t offset)
      : positions_(pack(mesh.vertices, vertex_stride, offset)),
        indices_(pack(mesh.triangles, triangle_stride, offset)) {
    view_ = {positions_.get() + offset, mesh.vertices.size(), indices_.get() + offset,
             mesh.triangles.size(),     vertex_stride,        triangle_stride};
  }
  operator MeshView() const { return view_; }

 private:
  template <class T>
  static std::unique_ptr<char[]> pack(const std::vector<T>& items, std::size_t stride, std::size_t offset) {
    static_assert(sizeof(T) == 12);
    const std::size_t bytes = items.empty() ? 0 : (items.size() - 1) * stride + 12;
    auto block = std::make_unique<char[]>(offset + bytes);
    for (std::size_t i = 0; i < items.size(); ++i) std::memcpy(block.get() + offset + i * stride, &items[i], 12);
    return block;
  }

  std::unique_ptr<char[]> positions_, indices_;
  MeshView view_;
};

/// Runs chunks last to first, which would show any dependence on their order.
class BackwardExecutor final : public Executor {
 public:
  void for_chunks(std::size_t count, std::size_t chunk_size,
                  FunctionRef<void(std::size_t, std::size_t, std::size_t)> f) override {
    for (std::size_t chunk = (count + chunk_size - 1) / chunk_size; chunk-- > 0;)
      f(chunk, chunk * chunk_size, std::min(count, (chunk + 1) * chunk_size));
  }
  void invoke(FunctionRef<void()> a, FunctionRef<void()> b) override { b(), a(); }
  int threads() const noexcept override { return 1; }
};

/// Calls f with a sequential, a backward, a two-thread and an eight-thread executor.
inline void with_each_executor(const std::function<void(Executor&)>& f) {
  SequentialExecutor sequential;
  BackwardExecutor backward;
  ThreadExecutor two(2), eight(8);
  f(sequential), f(backward), f(two), f(eight);
}

}  // namespace boxwood::test
