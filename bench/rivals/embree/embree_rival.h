// Embree behind a plain interface, to trace the same rays in the same process. Nothing of Embree is in this header;
// when Embree was not found at configure time, `open` says so.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "boxwood/base.h"
#include "boxwood/mesh.h"
#include "boxwood/parallel.h"
#include "boxwood/queries.h"

namespace boxwood::rivals {

/// Embree's build qualities: RTC_BUILD_QUALITY_LOW (Morton codes), MEDIUM (binned SAH), HIGH (spatial splits). Set for
/// the scene and for its geometry.
enum class EmbreeQuality { low, medium, high };
const char* name(EmbreeQuality quality);

/// One mesh in an Embree scene.
class EmbreeRival {
 public:
  /// A device with the mesh copied in, not built yet. `robust` sets RTC_SCENE_FLAG_ROBUST. Errors: Embree was not there
  /// when this was compiled, or its device refuses to start.
  static Result<EmbreeRival> open(const MeshView& mesh, EmbreeQuality quality, bool robust);
  EmbreeRival(EmbreeRival&&) noexcept;
  EmbreeRival& operator=(EmbreeRival&&) noexcept;
  ~EmbreeRival();

  /// rtcCommitScene in a oneTBB arena of `threads` threads; gives the seconds it took. Once only.
  Result<double> build(int threads);
  /// Memory allocated by the build and still held, without the copied vertex and index buffers.
  std::size_t bytes() const;

  /// rtcIntersect1 and rtcOccluded1 in a plain loop over the rays, one chunk of rays at a time on the executor.
  /// Includes the copying between our records and Embree's.
  void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, Executor& executor) const;
  void any_hits(std::span<const Ray> rays, std::span<std::uint8_t> occluded, Executor& executor) const;

 private:
  struct State;
  explicit EmbreeRival(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// "Embree 3.13.5"; an error with a sentence for people when Embree is not there.
Result<std::string> embree_version();

}  // namespace boxwood::rivals
