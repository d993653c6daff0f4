// Smooths ambient occlusion over the pixels around, without mixing surfaces that are not one.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "boxwood/math.h"

namespace boxwood::render {

/// What a pixel shows: a point of a surface, its normal and the share of directions that are open. No surface: open <
/// 0.
struct OpenPoint {
  Vec3 position, normal;
  float open = -1;
};

/// A window over the rows of a picture that come from the top in pieces: rows are appended, smoothed as soon as the
/// rows below them are there, and forgotten when nobody needs them, so that memory does not grow with the picture's
/// height.
class OcclusionFilter {
 public:
  static constexpr std::size_t kSide = 5;  ///< of the square of pixels that are averaged

  /// `radius` is how far the occlusion rays went: what lies within a small part of it counts as the same surface.
  OcclusionFilter(std::size_t width, std::size_t height, float radius)
      : width_(width), height_(height), radius_(radius) {}

  /// Room for the next `count` rows, to be filled by the caller. Rows that are of no use any more go: those of which
  /// all that was ready before this call has been asked for.
  std::span<OpenPoint> append_rows(std::size_t count);
  /// Rows above this one can be asked for.
  std::size_t ready_rows() const;
  /// The average over the square of pixels around, of those on the same smooth surface; nothing where there is no
  /// surface.
  std::optional<float> open(std::size_t column, std::size_t row) const;

 private:
  static constexpr std::size_t kReach = kSide / 2;

  const OpenPoint& at(std::size_t column, std::size_t row) const {
    return points_[(row - first_row_) * width_ + column];
  }
  bool same_surface(const OpenPoint& a, const OpenPoint& b) const;

  std::size_t width_, height_;
  float radius_;
  std::size_t first_row_ = 0, end_row_ = 0;  ///< the rows that are held
  std::vector<OpenPoint> points_;
};

}  // namespace boxwood::render
