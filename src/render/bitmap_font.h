// A bitmap font of our own for the numbers and captions in pictures: lower-case letters, digits, a little punctuation.
#pragma once

#include <string_view>

#include "boxwood/base.h"
#include "render/color.h"

namespace boxwood::render {

inline constexpr int kGlyphWidth = 5;
inline constexpr int kGlyphAdvance = 6;  ///< from one character to the next
inline constexpr int kGlyphAscent = 7;   ///< rows above the base line; the top of digits and tall letters
inline constexpr int kGlyphDescent = 2;  ///< rows below it

/// Width of a text in pixels at a whole-number magnification.
int text_width(std::string_view text, int scale);

/// Draws a text with its top left corner at (x, y). Pixels outside the image are left out; a character the font does
/// not have becomes an empty frame.
void draw_text(Image& image, int x, int y, std::string_view text, int scale, Rgb color);

}  // namespace boxwood::render
