#include "reproduce/svg_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace boxwood::program::reproduce {
namespace {

constexpr double kWidth = 760, kHeight = 460, kLeft = 70, kRight = 190, kTop = 44, kBottom = 56;
// Okabe and Ito's colours, which most people can tell apart.
constexpr const char* kColors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};

/// One axis: values to places, and round values to write beside it.
class Axis {
 public:
  Axis(double lowest, double highest, bool logarithmic, double from, double to)
      : logarithmic_(logarithmic), from_(from), to_(to) {
    if (!(lowest <= highest)) lowest = 0, highest = 1;
    if (logarithmic) {
      low_ = std::floor(std::log10(lowest)), high_ = std::ceil(std::log10(highest));
      step_ = std::max(1.0, std::ceil((high_ - low_) / 8));
    } else {
      const double span = highest > lowest ? highest - lowest : std::max(std::fabs(highest), 1.0);
      const double raw = span / 6, power = std::pow(10.0, std::floor(std::log10(raw)));
      step_ = power * (raw / power < 1.5 ? 1 : raw / power < 3.5 ? 2 : raw / power < 7.5 ? 5 : 10);
      low_ = std::floor(lowest / step_) * step_, high_ = std::ceil(highest / step_) * step_;
    }
    if (!(high_ > low_)) high_ = low_ + step_;
  }

  double place(double value) const {
    const double v = logarithmic_ ? std::log10(value) : value;
    return from_ + (v - low_) / (high_ - low_) * (to_ - from_);
  }
  std::vector<double> ticks() const {
    std::vector<double> values;
    const int count = static_cast<int>(std::lround((high_ - low_) / step_));
    for (int i = 0; i <= count; ++i) {
      const double v = low_ + i * step_;
      values.push_back(logarithmic_ ? std::pow(10.0, v) : std::fabs(v) < 1e-9 * step_ ? 0 : v);
    }
    return values;
  }

 private:
  bool logarithmic_;
  double from_, to_, low_ = 0, high_ = 1, step_ = 1;
};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

std::string words(double x, double y, const std::string& text, const char* anchor, int size = 12,
                  const char* extra = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, size,
                     anchor, extra, escaped(text));
}

std::string frame(const Chart& chart, const Axis& x, const Axis& y) {
  const double right = kWidth - kRight, bottom = kHeight - kBottom;
  std::string out = words((kLeft + right) / 2, 24, chart.title, "middle", 15);
  for (const double tick : x.ticks()) {
    const double at = x.place(tick);
    out += fmt::format("<path d=\"M{0:.1f} {1}V{2}\" stroke=\"#dddddd\"/>\n", at, kTop, bottom);
    out += words(at, bottom + 18, fmt::format("{:g}", tick), "middle");
  }
  for (const double tick : y.ticks()) {
    const double at = y.place(tick);
    out += fmt::format("<path d=\"M{1} {0:.1f}H{2}\" stroke=\"#dddddd\"/>\n", at, kLeft, right);
    out += words(kLeft - 8, at + 4, fmt::format("{:g}", tick), "end");
  }
  out += fmt::format("<path d=\"M{} {}V{}H{}\" fill=\"none\" stroke=\"#333333\"/>\n", kLeft, kTop, bottom, right);
  out += words((kLeft + right) / 2, kHeight - 14, chart.x, "middle", 13);
  out += words(18, (kTop + bottom) / 2, chart.y, "middle", 13,
               fmt::format(" transform=\"rotate(-90 18 {:.1f})\"", (kTop + bottom) / 2).c_str());
  return out;
}

/// Words beside points that do not run into each other: each moves down until it is free of the earlier ones.
class Labels {
 public:
  std::string add(double x, double y, const std::string& text) {
    constexpr double kLine = 11, kCharacter = 5.6;
    const double width = kCharacter * static_cast<double>(text.size());
    const auto hits = [&](const Place& other) {
      return std::fabs(other.y - y) < kLine && x < other.x + other.width && other.x < x + width;
    };
    while (std::any_of(places_.begin(), places_.end(), hits)) y += kLine;
    places_.push_back({x, y, width});
    return words(x, y, text, "start", 10);
  }

 private:
  struct Place {
    double x, y, width;
  };
  std::vector<Place> places_;
};

std::string series_marks(const Chart::Series& series, const char* color, const Axis& x, const Axis& y, Labels& labels) {
  std::string out, path;
  for (std::size_t i = 0; i < series.points.size(); ++i) {
    const double px = x.place(series.points[i].first), py = y.place(series.points[i].second);
    path += fmt::format("{}{:.1f} {:.1f}", i ? "L" : "M", px, py);
    out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>\n", px, py, series.line ? 2.2 : 4,
                       color);
    if (i < series.labels.size()) out += labels.add(px + 6, py - 5, series.labels[i]);
  }
  if (series.line && !path.empty())
    out += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\"/>\n", path, color);
  return out;
}

}  // namespace

std::string svg(const Chart& chart) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  double low_x = kNone, high_x = -kNone, low_y = chart.from_zero ? 0 : kNone, high_y = -kNone;
  for (const Chart::Series& series : chart.series)
    for (const auto& [x, y] : series.points) {
      low_x = std::min(low_x, x), high_x = std::max(high_x, x);
      low_y = std::min(low_y, y), high_y = std::max(high_y, y);
    }
  const Axis x(low_x, high_x, chart.log_x, kLeft, kWidth - kRight);
  const Axis y(low_y, high_y, false, kHeight - kBottom, kTop);
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
      kWidth, kHeight);
  out += frame(chart, x, y);
  Labels labels;
  std::size_t legend = 0;
  for (std::size_t s = 0; s < chart.series.size(); ++s) {
    const char* const color = kColors[s % std::size(kColors)];
    out += series_marks(chart.series[s], color, x, y, labels);
    if (!chart.series[s].labels.empty()) continue;
    const double at = kTop + 12 + 18 * static_cast<double>(legend++);
    out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"12\" height=\"4\" fill=\"{}\"/>\n",
                       kWidth - kRight + 14, at - 6, color);
    out += words(kWidth - kRight + 32, at, chart.series[s].name, "start");
  }
  return out + "</svg>\n";
}

}  // namespace boxwood::program::reproduce
