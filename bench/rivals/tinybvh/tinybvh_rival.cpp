// tinybvh's layouts for processors, BVH8_CPU (AVX2) and BVH4_CPU (SSE). It builds with threads of its own, so `threads`
// only chooses between these and none. Triangles go in as three vertices each through a slice: with vertices and
// indices as pointers, BuildHQ of version 1.6.7 is Build.
#include "tinybvh/tinybvh_rival.h"

#include <chrono>
#include <cmath>
#include <vector>

#define TINYBVH_IMPLEMENTATION
#include <tiny_bvh.h>

namespace boxwood::rivals {
namespace {

static_assert(sizeof(tinybvh::bvhvec4) == 16);

/// What their record says of a ray. It normalises directions and has no tmin, so distances are scaled and origins
/// moved.
struct Query {
  tinybvh::Ray ray;
  float scale, offset;

  explicit Query(const Ray& from) : scale(std::sqrt(dot(from.direction, from.direction))), offset(from.tmin) {
    const Vec3 origin = from.origin + from.direction * from.tmin;
    const float length = (from.tmax - from.tmin) * scale;
    ray = tinybvh::Ray(tinybvh::bvhvec3(origin.x, origin.y, origin.z),
                       tinybvh::bvhvec3(from.direction.x, from.direction.y, from.direction.z),
                       length < BVH_FAR ? length : BVH_FAR);
  }
};

template <class Structure>
class TinybvhRival final : public Rival {
 public:
  TinybvhRival(const MeshView& mesh, bool high_quality) : high_quality_(high_quality) {
    vertices_.reserve(3 * mesh.triangle_count);
    for (std::size_t i = 0; i < mesh.triangle_count; ++i) {
      const Triangle t = mesh.triangle(i);
      for (const Vec3 p : {t.v0, t.v1, t.v2}) vertices_.emplace_back(p.x, p.y, p.z, 0.0f);
    }
  }

  Result<double> build(int) override {
    const auto start = std::chrono::steady_clock::now();
    const tinybvh::bvhvec4slice slice(vertices_.data(), static_cast<std::uint32_t>(vertices_.size()));
    if (high_quality_)
      structure_.BuildHQ(slice);
    else
      structure_.Build(slice);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  std::size_t bytes() const override { return bytes_of(structure_); }

  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, Calls, Executor& executor) const override {
    executor.for_chunks(rays.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Query query(rays[i]);
        const float far = query.ray.hit.t;
        structure_.Intersect(query.ray);
        const tinybvh::Intersection& hit = query.ray.hit;
        hits[i] = hit.t < far ? Hit{hit.t / query.scale + query.offset, hit.u, hit.v, hit.prim} : Hit{};
      }
    });
  }
  void any_hits(std::span<const Ray> rays, std::span<std::uint8_t> occluded, Calls, Executor& executor) const override {
    executor.for_chunks(rays.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) occluded[i] = structure_.IsOccluded(Query(rays[i]).ray);
    });
  }

 private:
  static std::size_t bytes_of(const tinybvh::BVH8_CPU& bvh) { return std::size_t{64} * bvh.usedBlocks; }
  static std::size_t bytes_of(const tinybvh::BVH4_CPU& bvh) { return std::size_t{64} * bvh.usedBlocks; }

  std::vector<tinybvh::bvhvec4> vertices_;
  bool high_quality_;
  Structure structure_;
};

}  // namespace

Result<std::string> tinybvh_version() {
  return "tinybvh " + std::to_string(TINY_BVH_VERSION_MAJOR) + "." + std::to_string(TINY_BVH_VERSION_MINOR) + "." +
         std::to_string(TINY_BVH_VERSION_SUB);
}

Result<std::unique_ptr<Rival>> open_tinybvh(const MeshView& mesh, std::string_view id, bool) {
  const bool high_quality = id.ends_with("-hq");
  if (id.starts_with("tinybvh:bvh8"))
    return std::unique_ptr<Rival>(std::make_unique<TinybvhRival<tinybvh::BVH8_CPU>>(mesh, high_quality));
  return std::unique_ptr<Rival>(std::make_unique<TinybvhRival<tinybvh::BVH4_CPU>>(mesh, high_quality));
}

}  // namespace boxwood::rivals
