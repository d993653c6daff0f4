// What a sample of rays does in an encoded tree, child by child: how many rays meet it, in how many of these cases
// there is a hit below it, and what an any-hit query pays there before it has found one or gives up. The ground of
// Ogaki and Derouet-Jourdan's child order (2016, bib key ogaki2016). Ours differs: a ray is followed into every child
// it meets, also behind a hit, so what is measured of a child does not depend on its place; costs below it do, and are
// what the present order makes them. Scalar code with the kernels' tests; sums of whole numbers, the same for every
// executor.
#include <atomic>
#include <new>
#include <vector>

#include "boxwood/queries.h"
#include "layouts/blocks.h"
#include "queries/triangle_test.h"

namespace boxwood::queries {
namespace {

using layouts::Layout;
using layouts::WideNode;

struct Sums {
  std::atomic<std::uint32_t> met{0}, successes{0};
  std::atomic<std::uint64_t> cost{0};

  void add(bool success, std::uint64_t price) {
    met.fetch_add(1, std::memory_order_relaxed);
    if (success) successes.fetch_add(1, std::memory_order_relaxed);
    cost.fetch_add(price, std::memory_order_relaxed);
  }
};

/// A node whose children are being searched.
struct Frame {
  std::uint32_t node, waiting;  // children still to search, as bits
  bool success;
  std::uint64_t cost;  // of an any-hit query that takes the children in their order, up to the first hit
};

template <int W>
std::uint32_t meet_children(const WideNode<W>& node, const RaySetup& ray) {
  std::uint32_t met = 0;
  for (int i = 0; i < W; ++i) {
    float near = ray.tmin, far = ray.tmax;
    for (int axis = 0; axis < 3; ++axis) {
      near = maximum(near, node.planes[ray.entry_plane[axis]][i] * ray.reciprocal[axis] + ray.entry_add[axis]);
      far = minimum(far, node.planes[ray.exit_plane[axis]][i] * ray.reciprocal[axis] + ray.exit_add[axis]);
    }
    met |= std::uint32_t(near <= far) << i;
  }
  return met;
}

bool is_hit(const Triangle& t, const RaySetup& ray) {
  const PermutedTriangle triangle{{t.v0[ray.kx], t.v1[ray.kx], t.v2[ray.kx]},
                                  {t.v0[ray.ky], t.v1[ray.ky], t.v2[ray.ky]},
                                  {t.v0[ray.kz], t.v1[ray.kz], t.v2[ray.kz]}};
  ShearedTriangle sheared;
  if (!robust_test(triangle, ray, sheared)) return false;
  const float at = Location(triangle, ray).t();
  return at >= ray.tmin && at <= ray.tmax;
}

template <int W, class Block>
class Recorder {
 public:
  Recorder(const Layout& layout, std::span<Sums> sums) : layout_(layout), sums_(sums) {}

  std::uint64_t total_cost = 0, any_hit_cost = 0;

  void follow(const Ray& ray) {
    RaySetup setup;
    if (layout_.root == layouts::kNoRoot || !set_up(ray, layout_.bounds, setup)) return;
    open(layout_.root, setup);
    while (true) {
      Frame& frame = frames_.back();
      if (frame.waiting == 0) {
        const Frame done = frame;
        frames_.pop_back();
        if (frames_.empty()) return void(any_hit_cost += done.cost);
        finish(done.success, done.cost);
        continue;
      }
      const auto lane = std::uint32_t(std::countr_zero(frame.waiting));
      const std::uint32_t word = nodes()[frame.node].child[lane];
      if (word & layouts::kLeafBit)
        search_leaf(word, setup);
      else
        open(word, setup);
    }
  }

 private:
  const WideNode<W>* nodes() const { return reinterpret_cast<const WideNode<W>*>(layout_.nodes.data()); }

  void open(std::uint32_t node, const RaySetup& ray) {
    total_cost += kNodePrice;
    frames_.push_back({node, meet_children(nodes()[node], ray), false, kNodePrice});
  }

  /// The child of the last frame that is first in line has been searched.
  void finish(bool success, std::uint64_t cost) {
    Frame& frame = frames_.back();
    const auto lane = std::uint32_t(std::countr_zero(frame.waiting));
    sums_[std::size_t(frame.node) * W + lane].add(success, cost);
    frame.waiting &= frame.waiting - 1;
    if (!frame.success) frame.cost += cost;
    frame.success |= success;
  }

  void search_leaf(std::uint32_t word, const RaySetup& ray) {
    bool success = false;
    layouts::for_leaf_triangles<Block>(
        layout_, word, [&](std::uint32_t, const Triangle& triangle) { success = success || is_hit(triangle, ray); });
    total_cost += kBlockPrice * layouts::leaf_blocks(word);
    finish(success, kBlockPrice * layouts::leaf_blocks(word));
  }

  const Layout& layout_;
  std::span<Sums> sums_;
  std::vector<Frame> frames_;
};

template <int W, class Block>
void record(const Layout& layout, std::span<const Ray> rays, std::span<Sums> sums, VisitCounts& counts,
            Executor& executor) {
  std::atomic<std::uint64_t> total{0}, any{0};
  executor.for_chunks(rays.size(), 256, [&](std::size_t, std::size_t begin, std::size_t end) {
    Recorder<W, Block> recorder(layout, sums);
    for (std::size_t i = begin; i < end; ++i) recorder.follow(rays[i]);
    total.fetch_add(recorder.total_cost, std::memory_order_relaxed);
    any.fetch_add(recorder.any_hit_cost, std::memory_order_relaxed);
  });
  counts.total_cost = total;
  counts.any_hit_cost = any;
}

}  // namespace

Result<VisitCounts> count_visits(const Layout& layout, std::span<const Ray> rays, Executor& executor) try {
  VisitCounts counts;
  counts.width = layouts::width(layout.id);
  std::vector<Sums> sums(layout.node_count * std::size_t(counts.width));
  switch (layout.id) {
    case layouts::LayoutId::linear:
      return Error{ErrorCode::unsupported, "visits are counted in wide layouts, not in linear"};
    case layouts::LayoutId::wide4:
      record<4, layouts::TriangleBlock>(layout, rays, sums, counts, executor);
      break;
    case layouts::LayoutId::wide8:
      record<8, layouts::TriangleBlock>(layout, rays, sums, counts, executor);
      break;
    case layouts::LayoutId::wide8_quads:
      record<8, layouts::QuadBlock>(layout, rays, sums, counts, executor);
      break;
    case layouts::LayoutId::wide16:
      record<16, layouts::TriangleBlock>(layout, rays, sums, counts, executor);
      break;
  }
  counts.children.reserve(sums.size());
  for (const Sums& sum : sums) counts.children.push_back({sum.met, sum.successes, sum.cost});
  return counts;
} catch (const std::bad_alloc&) {
  return Error{ErrorCode::out_of_memory,
               "not enough memory to count the visits of " + std::to_string(layout.node_count) + " nodes"};
}

}  // namespace boxwood::queries
