// The rays of a duel over one mesh: who traces them how fast, and whether the answers agree.
#pragma once

#include <string>
#include <vector>

#include "agreement.h"
#include "duel/fighters.h"

namespace boxwood::program::duel {

/// Robust mode's answers to one ray set against Embree's in ROBUST.
struct Agreement {
  std::string scene, rays;
  bool asks_any = false;
  rivals::Verdicts verdicts;
};

struct SceneResult {
  std::string scene, input, camera;
  std::size_t triangles = 0;
  std::vector<Cell> cells;
  std::vector<Agreement> agreements;
  double seconds = 0;  ///< all of it
};

/// Builds, makes the rays, traces. `turned_view`: the camera of primary rays.
Result<SceneResult> fight(const Plan& plan, const Input& input, const Session& session);

}  // namespace boxwood::program::duel
