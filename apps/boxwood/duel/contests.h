// The rows of the duel with Embree: what is compared with what, and what all scenes together say.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "session.h"
#include "timing.h"

namespace boxwood::program::duel {

/// One row. Cells of a group count for every contest of that group that takes their rays and size.
struct Contest {
  const char* id;
  const char* group;
  const char* rays;  ///< only cells of these; empty: all
  const char* title;
  double at_least, aim;            ///< of the geometric mean
  double no_scene_under = 0;       ///< and of every scene's mean; 0: none
  std::size_t triangles_over = 0;  ///< only scenes larger than that
  bool is_bytes = false;           ///< bytes per triangle: less is better, and `at_least` is at most
};
std::span<const Contest> contests();

/// One comparison over one scene.
struct Cell {
  std::string group, scene, rays;
  std::string ours, rival;                ///< who: "best single", "embree:high"
  double our_value = 0, rival_value = 0;  ///< medians: Mrays/s, Mtriangles/s, or bytes per triangle
  std::vector<double> values;             ///< ours over the rival's, round by round; bytes: ours once
  std::size_t triangles = 0, ray_count = 0;
  std::size_t repeated = 0, disturbed = 0;  ///< of both, as of TimedCell

  double value() const { return spread_of(values).median; }
};

struct Summary {
  const Contest* contest = nullptr;
  std::vector<const Cell*> cells;
  double mean = 0;                 ///< geometric, of the cells' medians
  double lowest = 0, highest = 0;  ///< of the same over one round each
  const Cell* worst = nullptr;

  bool meets(double limit) const;
  /// "aim", "yes", "no", or "-" without cells.
  const char* verdict() const;
};
std::vector<Summary> summarise(const std::vector<Cell>& cells);

/// The cells of a contest on one scene: their geometric mean, if there are any.
std::optional<double> scene_value(const Summary& summary, const std::string& scene);

}  // namespace boxwood::program::duel
