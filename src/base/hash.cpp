// 64-bit hash in the style of MurmurHash2's 64-bit mixing (Appleby 2008): multiply, fold the high bits down, chain.
#include "boxwood/base.h"

namespace boxwood {
namespace {

constexpr std::uint64_t kMultiplier = 0x9e3779b97f4a7c15ull;

constexpr std::uint64_t mix(std::uint64_t x) {
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93ull;
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93ull;
  return x ^ x >> 32;
}

}  // namespace

std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed) noexcept {
  const char* p = static_cast<const char*>(data);
  std::uint64_t h = mix(seed + kMultiplier * (size + 1));
  for (; size >= 8; p += 8, size -= 8) {
    std::uint64_t word;
    std::memcpy(&word, p, 8);
    h = (h ^ mix(word)) * kMultiplier + (h >> 29);
  }
  std::uint64_t tail = 0;
  if (size) std::memcpy(&tail, p, size);
  return mix(h ^ mix(tail));
}

}  // namespace boxwood
