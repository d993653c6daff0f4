// Who takes part in a duel over one mesh: our trees at three levels and Embree's at three qualities, built in turns.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench_types.h"
#include "boxwood/accel.h"
#include "duel/contests.h"
#include "input.h"

namespace boxwood::program::duel {

struct Plan {
  std::string fast, balanced, best;  ///< builders of the three levels
  std::string layout;
  int width = 0, height = 0;
  std::uint64_t seed = 1;
  int repeat = 3;
  std::size_t most_judged = 0;     ///< differing rays per set that brute force decides
  std::string embree;              ///< "Embree 3.13.5"; empty: not there
  std::vector<int> thread_counts;  ///< of builds: 1, and all when that is more
};

/// A tree of ours, or a scene of Embree's; the latter has no `rival` where Embree is not there.
struct Own {
  std::string name;
  AccelOptions options = {};  ///< without the executor
  std::shared_ptr<const Accel> accel = {};
};
struct Theirs {
  std::string id;
  bool robust = false;
  std::shared_ptr<const rivals::Rival> rival = {};
};

struct Fighters {
  std::shared_ptr<Executor> one, all;
  std::shared_ptr<SwitchedExecutor> executor;  ///< of all of ours
  Own fast, balanced, best;
  Theirs low{"embree:low"}, medium{"embree:medium"}, high{"embree:high"}, robust{"embree:medium", true};
};

/// Seconds of the whole build, after which `own.accel` runs on `executor`.
Result<double> build(Own& own, const Input& input, const std::shared_ptr<Executor>& executor);

/// Builds `balanced` and `fast` in turns with MEDIUM and LOW, in every round and with each number of threads, the
/// others once; builds that take over two seconds are measured once. Adds the cells about building and memory.
Result<Fighters> build_fighters(const Plan& plan, const Input& input, const Session& session, std::vector<Cell>& cells);

}  // namespace boxwood::program::duel
