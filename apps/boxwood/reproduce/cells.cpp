#include "reproduce/cells.h"

#include <algorithm>
#include <iterator>

namespace boxwood::program::reproduce {

std::vector<Subject> of_paper(const std::vector<Subject>& subjects) {
  std::vector<Subject> list;
  std::copy_if(subjects.begin(), subjects.end(), std::back_inserter(list),
               [](const Subject& subject) { return !subject.paper_scene.empty(); });
  return list.empty() ? subjects : list;
}

std::string subject_note(const std::vector<Subject>& subjects) {
  const bool stand_ins =
      std::any_of(subjects.begin(), subjects.end(), [](const Subject& subject) { return subject.input->is_scene; });
  if (stand_ins)
    return "Measured on procedural stand-ins, not on the paper's scenes: only the order within a scene compares.";
  return "Measured on the given meshes; scenes of the paper have its values beside ours.";
}

std::string ray_note(const Effort& effort) {
  return fmt::format(
      "Layout linear, robust mode, one thread; {}x{} primary rays, {} random rays (origin uniform in the scene's box, "
      "direction uniform), median of {}.",
      effort.width, effort.height, effort.random_rays, effort.repeat);
}

}  // namespace boxwood::program::reproduce
