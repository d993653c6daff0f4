#include "render/occlusion_filter.h"

#include <algorithm>

namespace boxwood::render {

std::span<OpenPoint> OcclusionFilter::append_rows(std::size_t count) {
  const std::size_t ready = ready_rows();
  const std::size_t keep_from = std::max(first_row_, ready > kReach ? ready - kReach : 0);
  points_.erase(points_.begin(), points_.begin() + static_cast<std::ptrdiff_t>((keep_from - first_row_) * width_));
  first_row_ = keep_from;
  end_row_ += count;
  points_.resize((end_row_ - first_row_) * width_);
  return std::span(points_).last(count * width_);
}

std::size_t OcclusionFilter::ready_rows() const {
  if (end_row_ == height_) return height_;
  return end_row_ > kReach ? end_row_ - kReach : 0;
}

bool OcclusionFilter::same_surface(const OpenPoint& a, const OpenPoint& b) const {
  constexpr float kSmallestCosine = 0.9f, kLargestStep = 0.02f, kLargestDistance = 0.2f;
  const Vec3 between = b.position - a.position;
  return b.open >= 0 && dot(a.normal, b.normal) > kSmallestCosine &&
         std::fabs(dot(a.normal, between)) <= kLargestStep * radius_ && length(between) <= kLargestDistance * radius_;
}

std::optional<float> OcclusionFilter::open(std::size_t column, std::size_t row) const {
  const OpenPoint& center = at(column, row);
  if (center.open < 0) return {};
  const std::size_t left = column - std::min(column, kReach), right = std::min(column + kReach, width_ - 1);
  const std::size_t top = row - std::min(row, kReach), bottom = std::min(row + kReach, height_ - 1);
  float sum = center.open;
  int count = 1;
  for (std::size_t y = top; y <= bottom; ++y)
    for (std::size_t x = left; x <= right; ++x) {
      const OpenPoint& neighbour = at(x, y);
      if (&neighbour == &center || !same_surface(center, neighbour)) continue;
      sum += neighbour.open;
      ++count;
    }
  return sum / static_cast<float>(count);
}

}  // namespace boxwood::render
