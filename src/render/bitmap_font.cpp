#include "render/bitmap_font.h"

#include <algorithm>
#include <iterator>

namespace boxwood::render {
namespace {

constexpr int kRows = kGlyphAscent + kGlyphDescent;

/// Rows from the top; in each, the bit of value 16 is the leftmost of five pixels.
struct Glyph {
  char character;
  std::uint8_t rows[kRows];
};

// clang-format off
constexpr Glyph kGlyphs[] = {
    {' ', { 0,  0,  0,  0,  0,  0,  0,  0,  0}},
    {'%', {25, 25,  2,  4,  8, 19, 19,  0,  0}},
    {'(', { 2,  4,  8,  8,  8,  4,  2,  0,  0}},
    {')', { 8,  4,  2,  2,  2,  4,  8,  0,  0}},
    {'+', { 0,  0,  4,  4, 31,  4,  4,  0,  0}},
    {',', { 0,  0,  0,  0,  0, 12, 12,  4,  8}},
    {'-', { 0,  0,  0,  0, 31,  0,  0,  0,  0}},
    {'.', { 0,  0,  0,  0,  0, 12, 12,  0,  0}},
    {'0', {14, 17, 17, 17, 17, 17, 14,  0,  0}},
    {'1', { 4, 12,  4,  4,  4,  4, 14,  0,  0}},
    {'2', {14, 17,  1,  6,  8, 16, 31,  0,  0}},
    {'3', {14, 17,  1,  6,  1, 17, 14,  0,  0}},
    {'4', { 2,  6, 10, 18, 31,  2,  2,  0,  0}},
    {'5', {31, 16, 30,  1,  1, 17, 14,  0,  0}},
    {'6', { 6,  8, 16, 30, 17, 17, 14,  0,  0}},
    {'7', {31,  1,  2,  4,  8,  8,  8,  0,  0}},
    {'8', {14, 17, 17, 14, 17, 17, 14,  0,  0}},
    {'9', {14, 17, 17, 15,  1,  2, 12,  0,  0}},
    {':', { 0,  0, 12, 12,  0, 12, 12,  0,  0}},
    {'a', { 0,  0, 14,  1, 15, 17, 15,  0,  0}},
    {'b', {16, 16, 22, 25, 17, 17, 30,  0,  0}},
    {'c', { 0,  0, 14, 16, 16, 17, 14,  0,  0}},
    {'d', { 1,  1, 13, 19, 17, 17, 15,  0,  0}},
    {'e', { 0,  0, 14, 17, 31, 16, 14,  0,  0}},
    {'f', { 6,  9,  8, 28,  8,  8,  8,  0,  0}},
    {'g', { 0,  0, 15, 17, 17, 17, 15,  1, 14}},
    {'h', {16, 16, 22, 25, 17, 17, 17,  0,  0}},
    {'i', { 4,  0, 12,  4,  4,  4, 14,  0,  0}},
    {'j', { 2,  0,  6,  2,  2,  2,  2, 18, 12}},
    {'k', {16, 16, 18, 20, 24, 20, 18,  0,  0}},
    {'l', {12,  4,  4,  4,  4,  4, 14,  0,  0}},
    {'m', { 0,  0, 26, 21, 21, 21, 21,  0,  0}},
    {'n', { 0,  0, 22, 25, 17, 17, 17,  0,  0}},
    {'o', { 0,  0, 14, 17, 17, 17, 14,  0,  0}},
    {'p', { 0,  0, 30, 17, 17, 17, 30, 16, 16}},
    {'q', { 0,  0, 15, 17, 17, 17, 15,  1,  1}},
    {'r', { 0,  0, 22, 25, 16, 16, 16,  0,  0}},
    {'s', { 0,  0, 15, 16, 14,  1, 30,  0,  0}},
    {'t', { 8,  8, 28,  8,  8,  9,  6,  0,  0}},
    {'u', { 0,  0, 17, 17, 17, 19, 13,  0,  0}},
    {'v', { 0,  0, 17, 17, 17, 10,  4,  0,  0}},
    {'w', { 0,  0, 17, 17, 21, 21, 10,  0,  0}},
    {'x', { 0,  0, 17, 10,  4, 10, 17,  0,  0}},
    {'y', { 0,  0, 17, 17, 17, 17, 15,  1, 14}},
    {'z', { 0,  0, 31,  2,  4,  8, 31,  0,  0}},
};
// clang-format on
constexpr Glyph kMissing{0, {31, 17, 17, 17, 17, 17, 31, 0, 0}};

const Glyph& find_glyph(char character) {
  const auto* found = std::find_if(std::begin(kGlyphs), std::end(kGlyphs),
                                   [character](const Glyph& glyph) { return glyph.character == character; });
  return found == std::end(kGlyphs) ? kMissing : *found;
}

void draw_square(Image& image, int x, int y, int side, Rgb color) {
  for (int row = std::max(y, 0); row < std::min(y + side, image.height); ++row)
    for (int column = std::max(x, 0); column < std::min(x + side, image.width); ++column)
      set_pixel(image, static_cast<std::size_t>(row) * image.width + column, color);
}

}  // namespace

int text_width(std::string_view text, int scale) {
  return text.empty() ? 0 : (static_cast<int>(text.size()) * kGlyphAdvance - (kGlyphAdvance - kGlyphWidth)) * scale;
}

void draw_text(Image& image, int x, int y, std::string_view text, int scale, Rgb color) {
  for (const char character : text) {
    const Glyph& glyph = find_glyph(character);
    for (int row = 0; row < kRows; ++row)
      for (int column = 0; column < kGlyphWidth; ++column)
        if (glyph.rows[row] >> (kGlyphWidth - 1 - column) & 1)
          draw_square(image, x + column * scale, y + row * scale, scale, color);
    x += kGlyphAdvance * scale;
  }
}

}  // namespace boxwood::render
