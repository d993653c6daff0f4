#include "reproduce/tables.h"

namespace boxwood::program::reproduce {
namespace {

constexpr TableInfo kTables[] = {
    {"ebbvh-1", "ebbvh", "build times (EBBVH, Table 1)", &ebbvh_build_times},
    {"ebbvh-2", "ebbvh", "camera rays (EBBVH, Table 2)", &ebbvh_camera_rays},
    {"ebbvh-3", "ebbvh", "random rays (EBBVH, Table 3)", &ebbvh_random_rays},
    {"evh-1", "evh", "surface area reduction by splitting edges (EVH, Table 1)", &evh_area_reduction},
    {"evh-4", "evh", "references against time over the threshold t (EVH, Figure 4)", &evh_thresholds},
    {"evh-5", "evh", "a scene turned through 64 frames (EVH, Figure 5)", &evh_rotation},
    {"popov-1", "popov", "recursive cost against the centroid sweep (POPOV, Table 1)", &popov_recursive_cost},
    {"popov-2", "popov", "pre-splits and spatial splits, upright and turned (POPOV, Table 2)", &popov_presplit},
    {"popov-3", "popov", "the geometric partitioner (POPOV, Table 3)", &popov_geometric},
    {"popov-4", "popov", "the generic builder and KD trees (POPOV, Table 4)", &popov_generic},
    {"popov-6", "popov", "the overlap penalty (POPOV, Figure 6)", &popov_overlap_penalty},
    {"builders", "popov", "all builders: build time against ray speed", &compare_builders},
};

}  // namespace

std::span<const TableInfo> tables() {
  return kTables;
}

const TableInfo* find_table(std::string_view id) {
  for (const TableInfo& table : kTables)
    if (id == table.id) return &table;
  return nullptr;
}

}  // namespace boxwood::program::reproduce
