#include "render/value_plane.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace boxwood::render {

void ValuePlane::set(std::size_t pixel, std::uint64_t value) {
  const auto v = static_cast<std::uint32_t>(std::min<std::uint64_t>(value, kLargest));
  std::uint8_t* bytes = &image_.rgb[3 * pixel];
  bytes[0] = v >> 16 & 0xff, bytes[1] = v >> 8 & 0xff, bytes[2] = v & 0xff;
}

void ValuePlane::set_nothing(std::size_t pixel) {
  std::fill_n(&image_.rgb[3 * pixel], 3, std::uint8_t{0xff});
}

std::uint32_t ValuePlane::operator[](std::size_t pixel) const {
  const std::uint8_t* bytes = &image_.rgb[3 * pixel];
  return static_cast<std::uint32_t>(bytes[0]) << 16 | static_cast<std::uint32_t>(bytes[1]) << 8 | bytes[2];
}

ValuePlane::Summary ValuePlane::summarize() const {
  Summary summary{.smallest = kLargest};
  std::uint64_t sum = 0;
  for (std::size_t pixel = 0; pixel < size(); ++pixel) {
    const std::uint32_t value = (*this)[pixel];
    if (value == kNothing) continue;
    ++summary.count;
    sum += value;
    summary.smallest = std::min(summary.smallest, value), summary.largest = std::max(summary.largest, value);
  }
  if (summary.count == 0) return {};
  summary.mean = static_cast<double>(sum) / static_cast<double>(summary.count);
  return summary;
}

std::uint32_t ValuePlane::quantile(double share) const {
  constexpr std::size_t kBins = 4096;
  std::vector<std::size_t> high(kBins), low(kBins);
  std::size_t count = 0;
  for (std::size_t pixel = 0; pixel < size(); ++pixel) {
    const std::uint32_t value = (*this)[pixel];
    if (value == kNothing) continue;
    ++high[value / kBins];
    ++count;
  }
  if (count == 0) return 0;
  // How many values stand before the one looked for in sorted order.
  const double place = std::ceil(std::clamp(share, 0.0, 1.0) * static_cast<double>(count)) - 1;
  std::size_t before = std::min(static_cast<std::size_t>(std::fmax(place, 0)), count - 1);
  const auto find_bin = [&before](const std::vector<std::size_t>& bins) {
    std::size_t bin = 0;
    for (; before >= bins[bin]; ++bin) before -= bins[bin];
    return static_cast<std::uint32_t>(bin);
  };
  const std::uint32_t high_bin = find_bin(high);
  for (std::size_t pixel = 0; pixel < size(); ++pixel) {
    const std::uint32_t value = (*this)[pixel];
    if (value != kNothing && value / kBins == high_bin) ++low[value % kBins];
  }
  return high_bin * static_cast<std::uint32_t>(kBins) + find_bin(low);
}

}  // namespace boxwood::render
