#include "timing.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

namespace boxwood::program {
namespace {

constexpr double kShortestPass = 0.01;     // seconds
constexpr double kShareOfOne = 0.98;       // of one processor's time
constexpr double kShareOfSeveral = 0.90;   // work ends unevenly
constexpr double kMostStolen = 0.03;       // of the wall time
constexpr double kLeastStolenTicks = 1.5;  // one tick more or less is rounding
constexpr int kMostAttempts = 4;

double seconds_of(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Time that the hypervisor gave to others, in clock ticks over all processors; 0 where it is not told.
double stolen_ticks() {
  std::ifstream file("/proc/stat");
  std::string word;
  double ticks = 0;
  file >> word;
  for (int column = 0; column < 8; ++column)
    if (!(file >> ticks)) return 0;
  return word == "cpu" ? ticks : 0;
}

struct Pass {
  double seconds = 0;  // of one run
  double share = 0;    // of the processors' time it should have had
  bool was_disturbed = false;
};

Result<Pass> make_pass(const TimedCell& cell, int runs) {
  const double stolen_before = stolen_ticks();
  const double cpu_before = seconds_of(CLOCK_PROCESS_CPUTIME_ID), before = seconds_of(CLOCK_MONOTONIC);
  double seconds = 0;
  for (int i = 0; i < runs; ++i) {
    const auto run = cell.run();
    if (!run) return run.error();
    seconds += *run;
  }
  const double wall = std::max(seconds_of(CLOCK_MONOTONIC) - before, 1e-9);
  const double cpu = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu_before;
  const double stolen = stolen_ticks() - stolen_before;
  static const int processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int wanted = std::clamp(cell.threads, 1, processors);
  Pass pass{seconds / runs, cpu / (wall * wanted), false};
  const double per_second = static_cast<double>(sysconf(_SC_CLK_TCK));
  pass.was_disturbed = pass.share < (wanted == 1 ? kShareOfOne : kShareOfSeveral) ||
                       (stolen > kLeastStolenTicks && stolen > kMostStolen * wall * per_second);
  return pass;
}

Status measure_once(TimedCell& cell) {
  if (cell.prepare) cell.prepare();
  const int runs =
      cell.estimate > 0 ? static_cast<int>(std::clamp(std::ceil(kShortestPass / cell.estimate), 1.0, 1e6)) : 1;
  Pass best;
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    const auto pass = make_pass(cell, runs);
    if (!pass) return pass.error();
    if (attempt > 0) ++cell.repeated;
    const bool is_better = attempt == 0 || (!pass->was_disturbed && best.was_disturbed) || pass->share > best.share;
    if (is_better) best = *pass;
    if (!best.was_disturbed) break;
  }
  cell.disturbed += best.was_disturbed;
  cell.seconds.push_back(best.seconds);
  return {};
}

}  // namespace

Status measure_in_turns(std::vector<TimedCell>& cells, int rounds, const std::function<void(double)>& progress) {
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (Status status = measure_once(cells[round % 2 ? cells.size() - 1 - i : i]); !status) return status;
    if (progress) progress(static_cast<double>(round + 1) / rounds);
  }
  return {};
}

Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  if (n == 0) return {};
  return {n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]), values.front(), values.back()};
}

std::vector<double> ratios(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> list;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) list.push_back(a[i] / std::max(b[i], 1e-12));
  return list;
}

double geometric_mean(const std::vector<double>& values) {
  if (values.empty()) return 0;
  double sum = 0;
  for (const double value : values) sum += std::log(value);
  return std::exp(sum / static_cast<double>(values.size()));
}

}  // namespace boxwood::program
