// The functions behind the scene registry; options are checked already and rotation is not theirs.
#pragma once

#include "boxwood/mesh.h"

namespace boxwood::mesh::procedural {

Scene make_organic(const SceneOptions& options);
Scene make_atrium(const SceneOptions& options);
Scene make_foliage(const SceneOptions& options);
Scene make_spaceship(const SceneOptions& options);
Scene make_city(const SceneOptions& options);
Scene make_shells(const SceneOptions& options);
Scene make_soup(const SceneOptions& options);

}  // namespace boxwood::mesh::procedural
