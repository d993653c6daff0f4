#include "render/color.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace boxwood::render {
namespace {

constexpr int kHeatSteps = 1024;

/// One stop of the heat ramp; between stops chroma and hue are linear, and lightness is linear over the whole ramp.
struct HeatStop {
  double chroma, hue;
};
constexpr HeatStop kHeatStops[] = {{0.09, 270}, {0.17, 288}, {0.19, 330}, {0.18, 380},
                                   {0.17, 415}, {0.16, 440}, {0.12, 468}};
constexpr double kDarkest = 0.20, kLightest = 0.96;

Rgb ramp_color(double share) {
  constexpr int kLast = std::size(kHeatStops) - 1;
  const double place = share * kLast;
  const int stop = std::min(static_cast<int>(place), kLast - 1);
  const HeatStop a = kHeatStops[stop], b = kHeatStops[stop + 1];
  const double s = place - stop;
  return to_srgb(from_oklch(kDarkest + (kLightest - kDarkest) * share, std::lerp(a.chroma, b.chroma, s),
                            std::lerp(a.hue, b.hue, s)));
}

std::array<Rgb, kHeatSteps> make_heat_table() {
  std::array<Rgb, kHeatSteps> table;
  for (int i = 0; i < kHeatSteps; ++i) table[i] = ramp_color(static_cast<double>(i) / (kHeatSteps - 1));
  return table;
}

std::uint8_t to_byte(float linear) {
  const double l = std::clamp(linear, 0.0f, 1.0f);
  const double encoded = l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(encoded * 255 + 0.5);
}

}  // namespace

Color from_oklch(double lightness, double chroma, double hue) {
  const double angle = hue * (std::numbers::pi / 180);
  return from_oklab(lightness, chroma * std::cos(angle), chroma * std::sin(angle));
}

Color from_oklab(double lightness, double a, double b) {
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  return {static_cast<float>(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          static_cast<float>(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          static_cast<float>(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

Rgb to_srgb(Color color) {
  return {to_byte(color.red), to_byte(color.green), to_byte(color.blue)};
}

Rgb heat_color(double share) {
  static const std::array<Rgb, kHeatSteps> table = make_heat_table();
  return table[static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * (kHeatSteps - 1) + 0.5)];
}

}  // namespace boxwood::render
