// How well the measures of trees predict what rays cost: Pearson's correlation over builders.
#pragma once

#include <functional>

#include "bench_types.h"

namespace boxwood::program {

/// What is said of one builder's tree and of rays through it.
struct Subject {
  const Contestant* contestant;
  const Row* row;

  /// C_T times inner nodes entered plus C_I times triangles tested, per ray.
  double cost_per_ray() const;
  double nanoseconds_per_ray() const;
};

/// One predictor.
struct Measure {
  const char* key;   ///< in JSON and CSV
  const char* head;  ///< of its column
  int decimals;
  std::function<double(const Subject&)> value;
};
const std::vector<Measure>& measures();

/// Pearson's r of two equally long lists; nothing when there are fewer than three values or all of one list are equal.
std::optional<double> pearson(const std::vector<double>& x, const std::vector<double>& y);

/// Subjects that differ in their builder only: one layout, mode, ray kind, terminating or not.
struct Group {
  RayKind kind;
  std::string layout;
  queries::Mode mode;
  bool terminating;
  std::vector<Subject> subjects;

  std::string title() const;
  /// Of each of measures(), with what is predicted: cost or time.
  std::vector<std::optional<double>> correlations(const std::function<double(const Subject&)>& predicted) const;
};
std::vector<Group> groups(const BenchResult& result);

}  // namespace boxwood::program
