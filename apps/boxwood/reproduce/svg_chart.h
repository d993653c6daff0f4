// Line and point charts as SVG.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace boxwood::program::reproduce {

struct Chart {
  struct Series {
    std::string name;
    std::vector<std::pair<double, double>> points;
    std::vector<std::string> labels = {};  ///< beside the points, instead of a line in the legend; empty: none
    bool line = true;                      ///< points are connected
  };

  std::string name;  ///< of the file, without its ending
  std::string title, x, y;
  std::vector<Series> series;
  bool log_x = false;
  bool from_zero = true;  ///< the vertical axis begins at zero
};

/// A picture of 760 x 460 that any browser shows, light background. Charts without points are an empty frame.
std::string svg(const Chart& chart);

}  // namespace boxwood::program::reproduce
