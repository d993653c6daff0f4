// The scenes of the papers' tables: which meshes are taken for them, and the procedural scenes that stand in.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "reproduce/measure.h"

namespace boxwood::program::reproduce {

struct PaperScene {
  const char* paper;  ///< "ebbvh", "evh", "popov"
  const char* name;   ///< as in the paper's table
  /// Words of which the mesh's name must have one, separated by '|'.
  const char* words;
  std::size_t triangles;  ///< as the paper says; 0: it does not
  const char* stand_in;   ///< INPUT text
};

std::span<const PaperScene> paper_scenes();

/// The paper's scene that a mesh is: its name has one of the words and its number of triangles is within a tenth of the
/// paper's. Null: none.
const PaperScene* match(const std::string& paper, const Input& input);

/// What a table of this paper is measured on: `inputs`, matched, or the stand-ins when there are none.
Result<std::vector<Subject>> subjects(const std::string& paper, const std::vector<std::shared_ptr<const Input>>& inputs,
                                      const Session& session);

}  // namespace boxwood::program::reproduce
