// The rival's interface for a build without Embree: everything that could start it is an error with one sentence.
#include "embree/embree_rival.h"

namespace boxwood::rivals {
namespace {

Error missing() {
  return {ErrorCode::unsupported,
          "Embree 3 was not found when this program was built; install it (on Debian: libembree-dev) and build again"};
}

}  // namespace

struct EmbreeRival::State {};

EmbreeRival::EmbreeRival(std::unique_ptr<State> state) : state_(std::move(state)) {}
EmbreeRival::EmbreeRival(EmbreeRival&&) noexcept = default;
EmbreeRival& EmbreeRival::operator=(EmbreeRival&&) noexcept = default;
EmbreeRival::~EmbreeRival() = default;

const char* name(EmbreeQuality) {
  return "missing";
}
Result<EmbreeRival> EmbreeRival::open(const MeshView&, EmbreeQuality, bool) {
  return missing();
}
Result<double> EmbreeRival::build(int) {
  return missing();
}
std::size_t EmbreeRival::bytes() const {
  return 0;
}
void EmbreeRival::closest_hits(std::span<const Ray>, std::span<Hit>, Executor&) const {}
void EmbreeRival::any_hits(std::span<const Ray>, std::span<std::uint8_t>, Executor&) const {}
Result<std::string> embree_version() {
  return missing();
}

}  // namespace boxwood::rivals
