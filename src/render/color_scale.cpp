#include "render/color_scale.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "render/bitmap_font.h"
#include "render/color.h"

namespace boxwood::render {
namespace {

constexpr Rgb kText{245, 245, 245}, kQuietText{185, 190, 200};

/// Where everything stands, in pixels.
struct Panel {
  int x, y, width, height;
  int bar_x, bar_y, bar_width, bar_height;
  int label_y, note_y, caption_y;
  int scale;
};

/// One decimal, independent of the locale.
std::string one_decimal(double value) {
  const auto tenths = static_cast<std::uint64_t>(std::floor(value * 10 + 0.5));
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10);
}

std::string tick_label(const ColorScale& scale, std::uint32_t value, std::uint32_t largest) {
  return std::to_string(value) + (value == scale.upper && largest > scale.upper ? "+" : "");
}

Panel place(const Image& image, int scale, int widest_text, int widest_label, int labels) {
  const int padding = 7 * scale, margin = 8 * scale;
  Panel p{};
  p.scale = scale;
  // Wide enough for the texts and for labels that do not touch; on large pictures a third of the width.
  const int bar_width =
      std::max({widest_text - widest_label, (labels - 1) * (widest_label + 6 * scale), image.width / 3});
  p.bar_width = bar_width, p.bar_height = 10 * scale;
  p.width = bar_width + widest_label + 2 * padding;
  int y = padding;
  p.caption_y = y, y += (kGlyphAscent + kGlyphDescent + 4) * scale;
  p.bar_y = y, y += p.bar_height + 4 * scale;
  p.label_y = y, y += (kGlyphAscent + 6) * scale;
  p.note_y = y, y += (kGlyphAscent + kGlyphDescent) * scale;
  p.height = y + padding - 2 * scale;
  p.x = margin, p.y = image.height - margin - p.height;
  p.bar_x = p.x + padding + widest_label / 2;
  for (int* row : {&p.caption_y, &p.bar_y, &p.label_y, &p.note_y}) *row += p.y;
  return p;
}

bool fits(const Panel& panel, const Image& image) {
  return panel.x + panel.width + panel.x <= image.width && panel.y >= image.height / 2;
}

void darken(Image& image, const Panel& p) {
  for (int y = p.y; y < p.y + p.height; ++y)
    for (int x = p.x; x < p.x + p.width; ++x) {
      std::uint8_t* pixel = &image.rgb[3 * (static_cast<std::size_t>(y) * image.width + x)];
      for (int channel = 0; channel < 3; ++channel) pixel[channel] = static_cast<std::uint8_t>(pixel[channel] / 5 + 12);
    }
}

void fill(Image& image, int x, int y, int width, int height, Rgb color) {
  for (int row = y; row < y + height; ++row)
    for (int column = x; column < x + width; ++column)
      set_pixel(image, static_cast<std::size_t>(row) * image.width + column, color);
}

void draw_bar(Image& image, const Panel& p, const ColorScale& scale, std::uint32_t largest) {
  fill(image, p.bar_x - p.scale, p.bar_y - p.scale, p.bar_width + 2 * p.scale, p.bar_height + 2 * p.scale, kQuietText);
  for (int i = 0; i < p.bar_width; ++i)
    fill(image, p.bar_x + i, p.bar_y, 1, p.bar_height, heat_color((i + 0.5) / p.bar_width));
  for (std::uint32_t value = 0; value <= scale.upper; value += scale.step) {
    const auto x = static_cast<int>(static_cast<std::int64_t>(p.bar_width - 1) * value / scale.upper);
    fill(image, p.bar_x + x - (p.scale - 1) / 2, p.bar_y + p.bar_height + p.scale, p.scale, 2 * p.scale, kQuietText);
    // Centred on the digits: the plus hangs out to the right.
    const int label_width = text_width(std::to_string(value), p.scale);
    draw_text(image, p.bar_x + x - label_width / 2, p.label_y, tick_label(scale, value, largest), p.scale, kText);
  }
}

}  // namespace

ColorScale ColorScale::up_to(std::uint32_t value) {
  value = std::max(value, 1u);
  constexpr std::uint32_t kMostSteps = 5;
  const auto steps = [value](std::uint32_t step) { return (value + step - 1) / step; };
  for (std::uint32_t power = 1;; power *= 10)
    for (const std::uint32_t factor : {1u, 2u, 5u})
      if (steps(factor * power) <= kMostSteps)
        return {.upper = steps(factor * power) * factor * power, .step = factor * power};
}

bool draw_color_scale(Image& image, const ColorScale& scale, std::string_view caption,
                      const ValuePlane::Summary& summary) {
  const std::string note = "mean " + one_decimal(summary.mean) + ", largest " + std::to_string(summary.largest);
  const int largest_magnification = std::clamp(std::min(image.width, image.height) / 320, 1, 16);
  for (int magnification = largest_magnification; magnification >= 1; --magnification) {
    const int widest_text = std::max(text_width(caption, magnification), text_width(note, magnification));
    const int widest_label = text_width(std::to_string(scale.upper) + "+", magnification);
    const auto labels = static_cast<int>(scale.upper / scale.step) + 1;
    const Panel panel = place(image, magnification, widest_text, widest_label, labels);
    if (!fits(panel, image)) continue;
    darken(image, panel);
    draw_text(image, panel.x + 7 * magnification, panel.caption_y, caption, magnification, kText);
    draw_bar(image, panel, scale, summary.largest);
    draw_text(image, panel.x + 7 * magnification, panel.note_y, note, magnification, kQuietText);
    return true;
  }
  return false;
}

}  // namespace boxwood::render
