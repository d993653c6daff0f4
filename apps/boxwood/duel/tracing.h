// Who traces which rays how fast: the part of a duel and of an ablation that they share.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "duel/fighters.h"

namespace boxwood::program::duel {

/// How rays are handed over: one call each, all in one call, or coherent packets of eight (Embree's).
enum class Way { single, batch, packets };

/// Rays and what is asked of them.
struct Set {
  const char* name;
  bool any;
  std::vector<Ray> rays;
};

/// Ours or theirs, tracing in one way; then what came out.
struct Tracer {
  const Own* own = nullptr;
  const Theirs* theirs = nullptr;
  Way way = Way::single;
  queries::Mode mode = queries::Mode::fast;
  std::vector<double> seconds = {};  ///< one per round
  std::size_t repeated = 0, disturbed = 0;

  bool exists() const { return own ? own->accel != nullptr : theirs->rival != nullptr; }
  std::string name() const;
};

struct Answers {
  std::vector<Hit> hits;
  std::vector<std::uint8_t> occluded;
};

/// Seconds for the whole set. Batches of ours run on their own executor, all of theirs on `executor`.
Result<double> trace(const Tracer& tracer, const Set& set, Executor& executor, Answers& answers);

/// A warm-up of each, then all in turns, on `executor` of one thread.
Status measure(const Set& set, std::span<Tracer* const> tracers, int rounds, Executor& executor);

/// Primary, random, diffuse and occlusion rays of the plan's size and seed; the last two may be empty.
struct Sets {
  Set primary{"primary", false, {}}, random{"random", false, {}}, diffuse{"diffuse", false, {}},
      occlusion{"occlusion", true, {}};
};
Result<Sets> make_sets(const Plan& plan, const Input& input, const Accel& accel, const Session& session);

/// Puts the rays into the same random order on every machine.
void shuffle(std::vector<Ray>& rays, std::uint64_t seed);

}  // namespace boxwood::program::duel
