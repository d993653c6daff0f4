// Timing on a machine that is not ours alone: passes in turns, each as long as a clock needs, and a pass during which
// the process did not have its processors is made again.
#pragma once

#include <functional>
#include <vector>

#include "boxwood/base.h"

namespace boxwood::program {

/// Median, smallest and largest of repeated measurements.
struct Spread {
  double median = 0, lowest = 0, highest = 0;
};
Spread spread_of(std::vector<double> values);

/// One thing to time.
struct TimedCell {
  std::function<Result<double>()> run;  ///< gives the seconds it took
  std::function<void()> prepare = {};   ///< before each pass, not timed; may be empty
  int threads = 1;                      ///< processors that `run` keeps busy
  double estimate = 0;                  ///< seconds of a run, from a warm-up; 0: unknown

  std::vector<double> seconds = {};  ///< of one run, one value per round
  std::size_t repeated = 0;          ///< passes made again
  std::size_t disturbed = 0;         ///< rounds whose best pass still lacked a processor
};

/// All cells once in each round, every other round backwards. A pass runs a cell until it has lasted 10 ms. It is made
/// again, up to three times, when the process got less than 98 % of one processor's time (several: 90 % of theirs), or
/// the hypervisor took more than 3 % (steal in /proc/stat). `progress`, if any, is told the share that is done.
Status measure_in_turns(std::vector<TimedCell>& cells, int rounds, const std::function<void(double)>& progress = {});

/// a / b round by round.
std::vector<double> ratios(const std::vector<double>& a, const std::vector<double>& b);

/// Of positive numbers; 0 when there are none.
double geometric_mean(const std::vector<double>& values);

}  // namespace boxwood::program
