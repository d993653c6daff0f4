// The search of boxwood tune: builders, pre-splits, builders' options, layouts and trees optimized for the rays, as far
// as the time goes.
#pragma once

#include <string>
#include <vector>

#include "boxwood/accel.h"
#include "input.h"
#include "session.h"

namespace boxwood::program {

/// Rays to tune for and rays to measure with, which nothing is tuned for.
struct TuneRays {
  std::vector<Ray> closest, any;
  std::size_t size() const { return closest.size() + any.size(); }
};
struct TuneRaySets {
  TuneRays trained, tested;
};

/// What is tried.
struct TuneChoice {
  builders::BuildOptions build = AccelOptions{}.build;  ///< a builder or a quality level
  std::string presplit, optimizer;                      ///< empty: the level's, or none
  std::string layout = queries::default_layout();
  bool optimized = false;  ///< Accel::optimize behind it, for the rays to tune for

  std::string text() const;          ///< "sbvh, presplit evh:t=14, wide8, optimized"
  std::string command_line() const;  ///< "--builder sbvh --set bins=64 --layout wide8"
  std::string code() const;          ///< the same as C++
};

/// What came out. Speeds are over the rays to measure with.
struct TuneResult {
  TuneChoice choice;
  double build_seconds = 0;  ///< references, pre-split, tree, layout and optimizing
  double mrays = 0;
  double ratio = 1;  ///< of `mrays` to the first result's, the median of runs in turns with it
  std::size_t bytes = 0;
  bool is_on_front = false;  ///< no other builds as fast, traces as fast and is as small
};

struct TuneLimits {
  double seconds = 60;
  queries::Mode mode = queries::Mode::robust;
};

/// Tries what there is time for, the most promising first: at least the library's default, which is the first result.
/// In the order tried.
Result<std::vector<TuneResult>> search(const Input& input, const TuneRaySets& rays, const TuneLimits& limits,
                                       const Session& session);

/// The place of the result to take: of those that trace within a twentieth of the fastest the one that builds fastest.
std::size_t recommended(const std::vector<TuneResult>& results);

}  // namespace boxwood::program
