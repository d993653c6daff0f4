// Embree 3 (Wald, Woop, Benthin, Johnson and Ernst 2014) as a rival: single-ray calls over the same rays.
// The build runs in an arena of the asked-for number of threads instead of a device with "threads=N", because the
// latter limits oneTBB for the whole process for as long as the device lives, our own work included.
#include "embree/embree_rival.h"

#include <embree3/rtcore.h>
#include <oneapi/tbb/task_arena.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <array>
#include <atomic>
#include <chrono>

namespace boxwood::rivals {
namespace {

constexpr std::size_t kChunk = 4096;

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

RTCBuildQuality embree_quality(EmbreeQuality quality) {
  switch (quality) {
    case EmbreeQuality::low:
      return RTC_BUILD_QUALITY_LOW;
    case EmbreeQuality::high:
      return RTC_BUILD_QUALITY_HIGH;
    case EmbreeQuality::medium:
      break;
  }
  return RTC_BUILD_QUALITY_MEDIUM;
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

Error embree_error(RTCError error, const char* where) {
  static constexpr std::array<const char*, 7> kNames{
      "none",     "unknown", "invalid argument", "invalid operation", "out of memory", "unsupported processor",
      "cancelled"};
  const auto code = static_cast<std::size_t>(error);
  return {code == RTC_ERROR_OUT_OF_MEMORY ? ErrorCode::out_of_memory : ErrorCode::unsupported,
          std::string("Embree failed to ") + where + ": error '" + (code < kNames.size() ? kNames[code] : "unlisted") +
              "'"};
}

}  // namespace

struct EmbreeRival::State {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::atomic<std::int64_t> allocated{0};
  std::int64_t allocated_before_build = 0;

  ~State() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
  static bool count_memory(void* state, ssize_t bytes, bool) {
    static_cast<State*>(state)->allocated += bytes;
    return true;
  }
};

EmbreeRival::EmbreeRival(std::unique_ptr<State> state) : state_(std::move(state)) {}
EmbreeRival::EmbreeRival(EmbreeRival&&) noexcept = default;
EmbreeRival& EmbreeRival::operator=(EmbreeRival&&) noexcept = default;
EmbreeRival::~EmbreeRival() = default;

const char* name(EmbreeQuality quality) {
  return quality == EmbreeQuality::low ? "low" : quality == EmbreeQuality::medium ? "medium" : "high";
}

Result<EmbreeRival> EmbreeRival::open(const MeshView& mesh, EmbreeQuality quality, bool robust) {
  auto state = std::make_unique<State>();
  state->device = rtcNewDevice(nullptr);
  if (!state->device) return embree_error(rtcGetDeviceError(nullptr), "start");
  rtcSetDeviceMemoryMonitorFunction(state->device, State::count_memory, state.get());
  state->scene = rtcNewScene(state->device);
  rtcSetSceneBuildQuality(state->scene, embree_quality(quality));
  rtcSetSceneFlags(state->scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);

  RTCGeometry geometry = rtcNewGeometry(state->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryBuildQuality(geometry, embree_quality(quality));
  auto* positions = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.vertex_count));
  auto* corners = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.triangle_count));
  if (!positions || !corners) {
    rtcReleaseGeometry(geometry);
    return embree_error(rtcGetDeviceError(state->device), "take the mesh");
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
  rtcAttachGeometryByID(state->scene, geometry, 0);
  rtcReleaseGeometry(geometry);
  return EmbreeRival(std::move(state));
}

Result<double> EmbreeRival::build(int threads) {
  tbb::task_arena arena(threads);
  arena.initialize();
  state_->allocated_before_build = state_->allocated;
  const auto start = std::chrono::steady_clock::now();
  arena.execute([&] {
    const FlushDenormals flush;
    rtcCommitScene(state_->scene);
  });
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  if (const RTCError error = rtcGetDeviceError(state_->device); error != RTC_ERROR_NONE)
    return embree_error(error, "build");
  return seconds.count();
}

std::size_t EmbreeRival::bytes() const {
  const std::int64_t held = state_->allocated - state_->allocated_before_build;
  return held > 0 ? static_cast<std::size_t>(held) : 0;
}

void EmbreeRival::closest_hits(std::span<const Ray> rays, std::span<Hit> hits, Executor& executor) const {
  executor.for_chunks(rays.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    const FlushDenormals flush;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query;
    for (std::size_t i = begin; i < end; ++i) {
      fill(query.ray, rays[i]);
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(state_->scene, &context, &query);
      hits[i] = query.hit.geomID == RTC_INVALID_GEOMETRY_ID
                    ? Hit{}
                    : Hit{query.ray.tfar, query.hit.u, query.hit.v, query.hit.primID};
    }
  });
}

void EmbreeRival::any_hits(std::span<const Ray> rays, std::span<std::uint8_t> occluded, Executor& executor) const {
  executor.for_chunks(rays.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    const FlushDenormals flush;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay query;
    for (std::size_t i = begin; i < end; ++i) {
      fill(query, rays[i]);
      rtcOccluded1(state_->scene, &context, &query);
      occluded[i] = query.tfar < 0;
    }
  });
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
