// madmann91/bvh version 2: a binary tree of its DefaultBuilder, its traversal, and its precomputed triangles put in the
// order of the leaves, as its own benchmark does it. Its robust mode widens boxes; triangles are tested alike in both.
#include "madmann/madmann_rival.h"

#include <bvh/v2/bvh.h>
#include <bvh/v2/default_builder.h>
#include <bvh/v2/node.h>
#include <bvh/v2/ray.h>
#include <bvh/v2/stack.h>
#include <bvh/v2/thread_pool.h>
#include <bvh/v2/tri.h>
#include <bvh/v2/vec.h>

#include <chrono>
#include <vector>

namespace boxwood::rivals {
namespace {

using TheirNode = bvh::v2::Node<float, 3>;
using TheirBvh = bvh::v2::Bvh<TheirNode>;
using TheirVec = bvh::v2::Vec<float, 3>;
using TheirBox = bvh::v2::BBox<float, 3>;
using TheirRay = bvh::v2::Ray<float, 3>;
using TheirTriangle = bvh::v2::PrecomputedTri<float>;
using TheirBuilder = bvh::v2::DefaultBuilder<TheirNode>;

constexpr std::size_t kStack = 192;  // their stack does not grow

TheirVec vec(Vec3 a) {
  return TheirVec(a.x, a.y, a.z);
}

class MadmannRival final : public Rival {
 public:
  MadmannRival(const MeshView& mesh, TheirBuilder::Quality quality, bool robust) : quality_(quality), robust_(robust) {
    for (std::size_t i = 0; i < mesh.triangle_count; ++i) {
      const Triangle t = mesh.triangle(i);
      input_.emplace_back(vec(t.v0), vec(t.v1), vec(t.v2));
    }
  }

  Result<double> build(int threads) override {
    const auto start = std::chrono::steady_clock::now();
    std::vector<TheirBox> boxes;
    std::vector<TheirVec> centers;
    boxes.reserve(input_.size()), centers.reserve(input_.size());
    for (const auto& triangle : input_) {
      boxes.push_back(triangle.get_bbox());
      centers.push_back(triangle.get_center());
    }
    TheirBuilder::Config config;
    config.quality = quality_;
    if (threads == 1) {
      bvh_ = TheirBuilder::build(boxes.data(), centers.data(), boxes.size(), config);
    } else {
      bvh::v2::ThreadPool pool(static_cast<std::size_t>(threads));
      bvh_ = TheirBuilder::build(pool, boxes.data(), centers.data(), boxes.size(), config);
    }
    triangles_.reserve(bvh_.prim_ids.size());
    for (const std::size_t id : bvh_.prim_ids) triangles_.emplace_back(input_[id]);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  std::size_t bytes() const override {
    return bvh_.nodes.size() * sizeof(TheirNode) + triangles_.size() * sizeof(TheirTriangle) +
           bvh_.prim_ids.size() * sizeof(std::size_t);
  }

  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, Calls, Executor& executor) const override {
    executor.for_chunks(rays.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        hits[i] = robust_ ? trace<false, true>(rays[i]) : trace<false, false>(rays[i]);
    });
  }
  void any_hits(std::span<const Ray> rays, std::span<std::uint8_t> occluded, Calls, Executor& executor) const override {
    executor.for_chunks(rays.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        occluded[i] = (robust_ ? trace<true, true>(rays[i]) : trace<true, false>(rays[i])).is_hit();
    });
  }

 private:
  template <bool is_any, bool is_robust>
  Hit trace(const Ray& from) const {
    Hit hit;
    TheirRay ray(vec(from.origin), vec(from.direction), from.tmin, from.tmax);
    bvh::v2::SmallStack<TheirBvh::Index, kStack> stack;
    bvh_.intersect<is_any, is_robust>(ray, bvh_.get_root().index, stack, [&](std::size_t begin, std::size_t end) {
      bool found = false;
      for (std::size_t i = begin; i < end; ++i) {
        if (const auto weights = triangles_[i].intersect(ray)) {
          hit = {ray.tmax, weights->first, weights->second, static_cast<std::uint32_t>(bvh_.prim_ids[i])};
          found = true;
        }
      }
      return found;
    });
    return hit;
  }

  std::vector<bvh::v2::Tri<float, 3>> input_;
  std::vector<TheirTriangle> triangles_;
  TheirBvh bvh_;
  TheirBuilder::Quality quality_;
  bool robust_;
};

}  // namespace

Result<std::string> madmann_version() {
  return std::string("madmann91/bvh v2");
}

Result<std::unique_ptr<Rival>> open_madmann(const MeshView& mesh, std::string_view id, bool robust) {
  using Quality = TheirBuilder::Quality;
  const Quality quality = id == "madmann:low" ? Quality::Low : id == "madmann:medium" ? Quality::Medium : Quality::High;
  return std::unique_ptr<Rival>(std::make_unique<MadmannRival>(mesh, quality, robust));
}

}  // namespace boxwood::rivals
