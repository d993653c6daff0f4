// Colours: linear light, Oklab, and the bytes of a picture.
//
// Ramps and hues are drawn in Oklab's polar form (lightness, chroma, hue; Ottosson 2020, ottosson2020perceptual), where
// equal steps of a number look about equally large.
#pragma once

#include <array>
#include <cstdint>

#include "boxwood/base.h"

namespace boxwood::render {

/// Linear light, 0 to 1 in each channel when it can be shown.
struct Color {
  float red = 0, green = 0, blue = 0;
};
constexpr Color operator+(Color a, Color b) {
  return {a.red + b.red, a.green + b.green, a.blue + b.blue};
}
constexpr Color operator*(Color a, float s) {
  return {a.red * s, a.green * s, a.blue * s};
}
constexpr Color operator*(Color a, Color b) {
  return {a.red * b.red, a.green * b.green, a.blue * b.blue};
}
constexpr Color mix(Color a, Color b, float share_of_b) {
  return a * (1 - share_of_b) + b * share_of_b;
}

/// Oklab: lightness 0 to 1, then green to red and blue to yellow, each about -0.3 to 0.3.
Color from_oklab(double lightness, double green_red, double blue_yellow);
/// Lightness 0 to 1, chroma about 0 to 0.3, hue in degrees (30 red, 100 yellow, 145 green, 265 blue).
Color from_oklch(double lightness, double chroma, double hue);

using Rgb = std::array<std::uint8_t, 3>;
/// sRGB bytes; what can't be shown is clamped.
Rgb to_srgb(Color color);

/// The colours of heat maps: from dark blue over purple and orange to pale yellow, lightness rising in equal steps.
/// `share` from 0 to 1 (clamped).
Rgb heat_color(double share);

inline void set_pixel(Image& image, std::size_t pixel, Rgb color) {
  for (std::size_t i = 0; i < 3; ++i) image.rgb[3 * pixel + i] = color[i];
}

}  // namespace boxwood::render
