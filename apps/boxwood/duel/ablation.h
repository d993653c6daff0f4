// What each technique is worth: the same tree with one thing left out at a time, traced in turns with the whole.
#pragma once

#include <string>
#include <vector>

#include "duel/fighters.h"

namespace boxwood::program::duel {

/// One technique left out on one mesh. Costs are in per cent of the whole: 10 means that without it a ray takes a tenth
/// longer, a build that much longer, the tree that much more memory.
struct AblationRow {
  std::string technique;
  double build_cost = 0, memory_cost = 0;
  struct RayCost {
    std::string rays;
    Spread cost;
  };
  std::vector<RayCost> rays;
};

struct AblationResult {
  std::string scene;
  std::size_t triangles = 0;
  std::vector<AblationRow> rows;
  std::vector<std::string> left_out;  ///< a sentence for each technique that `whole` does not use
};

/// `whole`: what is ablated. Rays are those of the plan, in fast mode, with one thread.
Result<AblationResult> ablate(const Plan& plan, const AccelOptions& whole, const Input& input, const Session& session);

}  // namespace boxwood::program::duel
