// Filling cells: a measured value, or why there is none.
#pragma once

#include <optional>
#include <string>

#include "reproduce/measure.h"
#include "reproduce/paper_table.h"

namespace boxwood::program::reproduce {

/// A method with the name it has in a table.
struct NamedMethod {
  const char* name;
  Method method;
};

inline Cell paper_cell(std::optional<double> paper) {
  return Cell{.ours = {}, .paper = paper, .our_ratio = {}, .paper_ratio = {}, .note = {}};
}

/// Sets `cell.ours` to what `measure()` (a Result<double>) gives, or its note when the build is left out.
template <class Measure>
Status fill(Laboratory& laboratory, const Subject& subject, const Method& method, Cell& cell, Measure measure) {
  cell.note = laboratory.left_out(subject, method);
  if (!cell.note.empty()) return {};
  const Result<double> value = measure();
  if (!value) return value.error();
  cell.ours = *value;
  return {};
}

/// "BUNNY (bunny)" when a mesh was taken for a paper's scene.
inline std::string scene_label(const Subject& subject) {
  if (subject.paper_scene.empty() || subject.label.find(subject.paper_scene) != std::string::npos) return subject.label;
  return fmt::format("{} ({})", subject.paper_scene, subject.label);
}

/// Those that are scenes of the paper, or all when none is: tables whose builds are dear don't measure more than the
/// paper did.
std::vector<Subject> of_paper(const std::vector<Subject>& subjects);

/// What was measured on, for a table's head.
std::string subject_note(const std::vector<Subject>& subjects);
/// How rays were made and timed.
std::string ray_note(const Effort& effort);

/// POPOV's prices, which all tables use.
inline std::map<std::string, std::string> popov_cost(std::map<std::string, std::string> settings = {}) {
  settings["cost.traversal"] = "2";
  settings["cost.intersection"] = "3";
  return settings;
}

}  // namespace boxwood::program::reproduce
