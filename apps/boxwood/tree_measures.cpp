#include "tree_measures.h"

#include "boxwood/render.h"

namespace boxwood::program {
namespace {

constexpr std::size_t kLines = std::size_t{1} << 16;
constexpr std::uint64_t kSeed = 1;

}  // namespace

TreeMeasures measure_tree(const tree::BinaryTree& tree, const MeshView& mesh, const tree::CostModel& cost,
                          std::size_t samples, Executor& executor) {
  TreeMeasures measures;
  measures.end_point_overlap = metrics::end_point_overlap(tree, mesh, cost, samples, executor);
  measures.leaf_count_variability =
      metrics::leaf_count_variability(tree, render::line_rays(tree.bounds(), kLines, kSeed), executor);
  measures.sibling_overlap = metrics::sibling_overlap(tree);
  measures.references_per_primitive = metrics::references_per_primitive(tree);
  return measures;
}

Json measures_json(const TreeMeasures& measures) {
  Json json;
  json["end_point_overlap"] = measures.end_point_overlap.value;
  json["end_point_overlap_error"] = measures.end_point_overlap.error;
  json["leaf_count_variability"] = measures.leaf_count_variability.value;
  json["leaf_count_variability_error"] = measures.leaf_count_variability.error;
  json["sibling_overlap_area"] = measures.sibling_overlap.area;
  json["sibling_overlap_volume"] = measures.sibling_overlap.volume;
  json["references_per_primitive"] = measures.references_per_primitive;
  return json;
}

}  // namespace boxwood::program
