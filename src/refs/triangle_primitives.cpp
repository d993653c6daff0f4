// Parts of triangles for builders that split: clipped exactly (math/clip.h) and boxed outwards, so that no ray gets
// lost between two parts.
#include "boxwood/refs.h"
#include "math/clip.h"

namespace boxwood::refs {
namespace {

class TrianglePrimitives final : public Primitives {
 public:
  explicit TrianglePrimitives(const MeshView& mesh) : mesh_(mesh) {}

  Box clip(const Reference& reference, const Box& box) const override {
    const Box both = intersection(reference.box(), box);
    if (both.is_empty() || both == reference.box()) return both;
    ConvexPolygon part(mesh_.triangle(reference.primitive));
    part.clip(both);
    return intersection(part.bounds(), both);
  }

  void cut(const Reference& reference, int axis, float position, Box& left, Box& right) const override {
    const Triangle triangle = mesh_.triangle(reference.primitive);
    const Box whole = triangle.bounds(), box = reference.box();
    Box below = box, above = box;
    below.upper[axis] = above.lower[axis] = position;
    ConvexPolygon part(triangle);
    // A reference that was never split has the triangle's own box: nothing to clip.
    if (!box.contains(whole)) part.clip(box);
    if (part.is_empty()) {  // the box touches the triangle by less than a rounding error
      left = below, right = above;
      return;
    }
    ConvexPolygon upper_part = part;
    part.clip(axis, position, true);
    upper_part.clip(axis, position, false);
    // A side without corners may hold a rounding error's worth of the triangle, so the other side then gets all.
    left = intersection(intersection(part.bounds(), whole), upper_part.is_empty() ? box : below);
    right = intersection(intersection(upper_part.bounds(), whole), part.is_empty() ? box : above);
  }

  void chop(const Reference& reference, int axis, std::span<const float> positions,
            std::span<Box> parts) const override {
    const Triangle triangle = mesh_.triangle(reference.primitive);
    const Box box = reference.box();
    ConvexPolygon part(triangle);
    if (!box.contains(triangle.bounds())) part.clip(box);
    part.chop(axis, positions, parts);
    for (Box& one : parts) one = intersection(one, box);
  }

  AlignedBuffer<mesh::EdgeLink> edge_links(mesh::Weld weld, Executor& executor) const override {
    return mesh::edge_links(mesh_, weld, executor);
  }
  AlignedBuffer<mesh::EdgeNeighbours> edge_neighbours(mesh::Weld weld, Executor& executor) const override {
    return mesh::edge_neighbours(mesh_, weld, executor);
  }
  bool share_edge(std::uint32_t a, std::uint32_t b, mesh::Weld weld) const override {
    return mesh::share_edge(mesh_, a, b, weld);
  }

 private:
  MeshView mesh_;
};

}  // namespace

std::shared_ptr<const Primitives> triangle_primitives(const MeshView& mesh) {
  return std::make_shared<TrianglePrimitives>(mesh);
}

}  // namespace boxwood::refs
