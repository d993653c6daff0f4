// Other ray tracing libraries behind one plain interface, to trace the same rays in the same process. Nothing of theirs
// is in this header; a library that was not found at configure time says so where it is asked for.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "boxwood/base.h"
#include "boxwood/mesh.h"
#include "boxwood/parallel.h"
#include "boxwood/queries.h"

namespace boxwood::rivals {

/// One ray in a call, or eight rays of the array's order in a call that says that they are coherent.
enum class Calls { single, packets };

/// One mesh in another library.
class Rival {
 public:
  virtual ~Rival() = default;

  /// Builds its acceleration structure with that many threads; gives the seconds it took. Once only.
  virtual Result<double> build(int threads) = 0;
  /// Memory of what the build made, without copied vertices and indices where these are apart.
  virtual std::size_t bytes() const = 0;
  /// Both in a plain loop over the rays, one chunk of them at a time on the executor. Copying between our records and
  /// theirs is part of it. `calls` must be one that its RivalInfo has.
  virtual void closest_hits(std::span<const Ray> rays, std::span<Hit> hits, Calls calls, Executor& executor) const = 0;
  virtual void any_hits(std::span<const Ray> rays, std::span<std::uint8_t> occluded, Calls calls,
                        Executor& executor) const = 0;
};

/// One way to build with a library.
struct RivalInfo {
  const char* id;       ///< "embree:medium"
  const char* summary;  ///< one line
  bool has_robust;      ///< has a mode against leaks beside its default one
  bool has_packets;     ///< has Calls::packets
};

struct Library {
  const char* id;  ///< "embree"
  std::span<const RivalInfo> rivals;
  /// "Embree 3.13.5"; an error with a sentence for people when it was not there at configure time, or does not start.
  Result<std::string> (*version)();
  /// A mesh taken in, not built yet. `id` is that of one of `rivals`; `robust` only where it has_robust.
  Result<std::unique_ptr<Rival>> (*open)(const MeshView& mesh, std::string_view id, bool robust);
};

/// Every library there is code for, installed or not.
std::span<const Library> libraries();
/// Opens by id. Errors: there is no such rival; its library is not there; what it refuses.
Result<std::unique_ptr<Rival>> open(const MeshView& mesh, std::string_view id, bool robust);

/// Rays in a chunk of a rival's loop.
inline constexpr std::size_t kChunk = 4096;

}  // namespace boxwood::rivals
