// Embree 3 or 4 (Wald, Woop, Benthin, Johnson and Ernst 2014) as a rival: single-ray calls, or coherent packets of
// eight, over the same rays. The build runs in an arena of the asked-for number of threads instead of a device with
// "threads=N", because the latter limits oneTBB for the whole process for as long as the device lives, our own work
// included.
#include "embree/embree_rival.h"

#if BOXWOOD_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <oneapi/tbb/task_arena.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstring>

namespace boxwood::rivals {
namespace {

constexpr unsigned kPacket = 8;

#if BOXWOOD_EMBREE_MAJOR >= 4
/// What goes with every call: in Embree 4 arguments, apart for the two queries.
class Arguments {
 public:
  explicit Arguments(Calls calls) {
    rtcInitIntersectArguments(&intersect_);
    rtcInitOccludedArguments(&occluded_);
    if (calls == Calls::packets) intersect_.flags = occluded_.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  }
  void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray, &intersect_); }
  void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray, &occluded_); }
  void intersect(const int* valid, RTCScene scene, RTCRayHit8& rays) {
    rtcIntersect8(valid, scene, &rays, &intersect_);
  }
  void occluded(const int* valid, RTCScene scene, RTCRay8& rays) { rtcOccluded8(valid, scene, &rays, &occluded_); }

 private:
  RTCIntersectArguments intersect_;
  RTCOccludedArguments occluded_;
};
#else
/// What goes with every call: in Embree 3 a context.
class Arguments {
 public:
  explicit Arguments(Calls calls) {
    rtcInitIntersectContext(&context_);
    if (calls == Calls::packets) context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  }
  void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &context_, &ray); }
  void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &context_, &ray); }
  void intersect(const int* valid, RTCScene scene, RTCRayHit8& rays) { rtcIntersect8(valid, scene, &context_, &rays); }
  void occluded(const int* valid, RTCScene scene, RTCRay8& rays) { rtcOccluded8(valid, scene, &context_, &rays); }

 private:
  RTCIntersectContext context_;
};
#endif

/// Embree wants denormals flushed to zero; our kernels must not run that way. Restores what was set before.
class FlushDenormals {
 public:
  FlushDenormals() : saved_(_mm_getcsr()) {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
  }
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

RTCBuildQuality quality_of(std::string_view id) {
  if (id == "embree:low") return RTC_BUILD_QUALITY_LOW;
  return id == "embree:high" ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
}

void fill(RTCRay& out, const Ray& ray) {
  out.org_x = ray.origin.x, out.org_y = ray.origin.y, out.org_z = ray.origin.z;
  out.dir_x = ray.direction.x, out.dir_y = ray.direction.y, out.dir_z = ray.direction.z;
  out.tnear = ray.tmin, out.tfar = ray.tmax;
  out.time = 0;
  out.mask = 0xffffffffu;
  out.id = 0;
  out.flags = 0;
}

/// Up to eight rays; lanes without one are not valid.
void fill(RTCRay8& out, int* valid, std::span<const Ray> rays) {
  for (unsigned i = 0; i < kPacket; ++i) {
    valid[i] = i < rays.size() ? -1 : 0;
    const Ray& ray = rays[i < rays.size() ? i : 0];
    out.org_x[i] = ray.origin.x, out.org_y[i] = ray.origin.y, out.org_z[i] = ray.origin.z;
    out.dir_x[i] = ray.direction.x, out.dir_y[i] = ray.direction.y, out.dir_z[i] = ray.direction.z;
    out.tnear[i] = ray.tmin, out.tfar[i] = ray.tmax;
    out.time[i] = 0;
    out.mask[i] = 0xffffffffu;
    out.id[i] = i;
    out.flags[i] = 0;
  }
}

Error embree_error(RTCError error, const char* where) {
  static constexpr std::array<const char*, 7> kNames{
      "none",     "unknown", "invalid argument", "invalid operation", "out of memory", "unsupported processor",
      "cancelled"};
  const auto code = static_cast<std::size_t>(error);
  return {code == RTC_ERROR_OUT_OF_MEMORY ? ErrorCode::out_of_memory : ErrorCode::unsupported,
          std::string("Embree failed to ") + where + ": error '" + (code < kNames.size() ? kNames[code] : "unlisted") +
              "'"};
}

class EmbreeRival final : public Rival {
 public:
  EmbreeRival() = default;
  EmbreeRival(const EmbreeRival&) = delete;
  EmbreeRival& operator=(const EmbreeRival&) = delete;
  ~EmbreeRival() override {
    if (scene_) rtcReleaseScene(scene_);
    if (device_) rtcReleaseDevice(device_);
  }

  Status take(const MeshView& mesh, RTCBuildQuality quality, bool robust);
  Result<double> build(int threads) override;
  std::size_t bytes() const override {
    const std::int64_t held = allocated_ - allocated_before_build_;
    return held > 0 ? static_cast<std::size_t>(held) : 0;
  }
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, Calls calls, Executor& executor) const override;
  void any_hits(std::span<const Ray> rays, std::span<std::uint8_t> occluded, Calls calls,
                Executor& executor) const override;

 private:
  static bool count_memory(void* rival, ssize_t bytes, bool) {
    static_cast<EmbreeRival*>(rival)->allocated_ += bytes;
    return true;
  }

  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  std::atomic<std::int64_t> allocated_{0};
  std::int64_t allocated_before_build_ = 0;
};

Status EmbreeRival::take(const MeshView& mesh, RTCBuildQuality quality, bool robust) {
  device_ = rtcNewDevice(nullptr);
  if (!device_) return embree_error(rtcGetDeviceError(nullptr), "start");
  rtcSetDeviceMemoryMonitorFunction(device_, count_memory, this);
  scene_ = rtcNewScene(device_);
  rtcSetSceneBuildQuality(scene_, quality);
  rtcSetSceneFlags(scene_, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);

  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryBuildQuality(geometry, quality);
  auto* positions = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.vertex_count));
  auto* corners = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangle_count));
  if (!positions || !corners) {
    rtcReleaseGeometry(geometry);
    return embree_error(rtcGetDeviceError(device_), "take the mesh");
  }
  for (std::size_t i = 0; i < mesh.vertex_count; ++i) {
    const Vec3 p = mesh.vertex(i);
    std::memcpy(positions + 3 * i, &p, 12);
  }
  for (std::size_t i = 0; i < mesh.triangle_count; ++i) {
    const auto c = mesh.corners(i);
    std::memcpy(corners + 3 * i, c.data(), 12);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_, geometry, 0);
  rtcReleaseGeometry(geometry);
  return {};
}

Result<double> EmbreeRival::build(int threads) {
  tbb::task_arena arena(threads);
  arena.initialize();
  allocated_before_build_ = allocated_;
  const auto start = std::chrono::steady_clock::now();
  arena.execute([&] {
    const FlushDenormals flush;
    rtcCommitScene(scene_);
  });
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE) return embree_error(error, "build");
  return seconds.count();
}

void EmbreeRival::closest_hits(std::span<const Ray> rays, std::span<Hit> hits, Calls calls, Executor& executor) const {
  executor.for_chunks(rays.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    const FlushDenormals flush;
    Arguments arguments(calls);
    if (calls == Calls::packets) {
      RTCRayHit8 packet;
      alignas(32) int valid[kPacket];
      for (std::size_t i = begin; i < end; i += kPacket) {
        const std::size_t count = std::min<std::size_t>(kPacket, end - i);
        fill(packet.ray, valid, rays.subspan(i, count));
        for (unsigned k = 0; k < kPacket; ++k) packet.hit.geomID[k] = packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
        arguments.intersect(valid, scene_, packet);
        for (std::size_t k = 0; k < count; ++k)
          hits[i + k] = packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID
                            ? Hit{}
                            : Hit{packet.ray.tfar[k], packet.hit.u[k], packet.hit.v[k], packet.hit.primID[k]};
      }
      return;
    }
    RTCRayHit query;
    for (std::size_t i = begin; i < end; ++i) {
      fill(query.ray, rays[i]);
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      arguments.intersect(scene_, query);
      hits[i] = query.hit.geomID == RTC_INVALID_GEOMETRY_ID
                    ? Hit{}
                    : Hit{query.ray.tfar, query.hit.u, query.hit.v, query.hit.primID};
    }
  });
}

void EmbreeRival::any_hits(std::span<const Ray> rays, std::span<std::uint8_t> occluded, Calls calls,
                           Executor& executor) const {
  executor.for_chunks(rays.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    const FlushDenormals flush;
    Arguments arguments(calls);
    if (calls == Calls::packets) {
      RTCRay8 packet;
      alignas(32) int valid[kPacket];
      for (std::size_t i = begin; i < end; i += kPacket) {
        const std::size_t count = std::min<std::size_t>(kPacket, end - i);
        fill(packet, valid, rays.subspan(i, count));
        arguments.occluded(valid, scene_, packet);
        for (std::size_t k = 0; k < count; ++k) occluded[i + k] = packet.tfar[k] < 0;
      }
      return;
    }
    RTCRay query;
    for (std::size_t i = begin; i < end; ++i) {
      fill(query, rays[i]);
      arguments.occluded(scene_, query);
      occluded[i] = query.tfar < 0;
    }
  });
}

}  // namespace

Result<std::unique_ptr<Rival>> open_embree(const MeshView& mesh, std::string_view id, bool robust) {
  auto rival = std::make_unique<EmbreeRival>();
  if (Status status = rival->take(mesh, quality_of(id), robust); !status) return status.error();
  return std::unique_ptr<Rival>(std::move(rival));
}

Result<std::string> embree_version() {
  RTCDevice device = rtcNewDevice(nullptr);
  if (!device) return embree_error(rtcGetDeviceError(nullptr), "start");
  const std::string version = std::to_string(rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION_MAJOR)) + "." +
                              std::to_string(rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION_MINOR)) + "." +
                              std::to_string(rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION_PATCH));
  rtcReleaseDevice(device);
  return "Embree " + version;
}

}  // namespace boxwood::rivals
