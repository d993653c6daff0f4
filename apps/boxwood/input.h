// INPUT of the command line: a mesh file, or scene:NAME[,triangles=N][,seed=S][,rotate=X:Y:Z]....
//
// Every command that takes one also takes --rotate X:Y:Z, which turns it and the camera with it.
#pragma once

#include <string>
#include <vector>

#include "boxwood/base.h"
#include "boxwood/mesh.h"
#include "session.h"

namespace boxwood::program {

/// Help text of every INPUT argument.
inline constexpr const char* kInputHelp = "Mesh file, or scene:NAME[,triangles=N][,seed=S][,rotate=X:Y:Z]...";

/// What is asked for: INPUT and --rotate.
struct InputOptions {
  std::string rotate;

  /// Refuses what can't be read as wrong usage.
  void add_to(CLI::App& command);
};

struct Input {
  std::string text;  ///< as given
  TriangleMesh mesh;
  Box bounds;
  std::uint64_t hash = 0;
  View view;                           ///< the scene's own, or computed from the bounds; before --rotate
  Vec3 rotation{}, rotation_center{};  ///< of --rotate, which has turned the mesh
  bool is_scene = false;
  mesh::SceneOptions scene;  ///< when it is one
  double read_seconds = 0;
  bool keeps_file_order = true;
  std::string order_note;
  std::size_t polygons_triangulated = 0, lines_and_points_skipped = 0;

  /// A view turned as the mesh was: the one to take pictures with.
  View turned(const View& unturned) const { return mesh::rotate(unturned, rotation, rotation_center); }

  /// Key "mesh" of every report.
  Json json() const;
  /// One line: name, counts, hash.
  std::string line() const;
};

/// Reads or makes it. A mesh without triangles is an error.
Result<Input> load_input(const std::string& text, const InputOptions& options, const Session& session);
/// The same for work that needs geometry: a mesh without a single finite triangle is an error too.
Result<Input> load_usable_input(const std::string& text, const InputOptions& options, const Session& session);

/// Warns about triangles that were left out because they are not finite.
void warn_excluded(const Input& input, std::size_t excluded, const Session& session);

}  // namespace boxwood::program
