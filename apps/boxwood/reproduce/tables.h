// The tables that can be made again. One function each; the list is in tables.cpp.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "reproduce/measure.h"
#include "reproduce/paper_table.h"
#include "reproduce/svg_chart.h"

namespace boxwood::program::reproduce {

struct TableResult {
  PaperTable table;
  std::vector<Chart> charts = {};
};

using MakeTable = Result<TableResult> (*)(Laboratory&, const std::vector<Subject>&);

struct TableInfo {
  const char* id;       ///< "popov-3"
  const char* paper;    ///< whose scenes it is measured on: "ebbvh", "evh", "popov"
  const char* summary;  ///< one line
  MakeTable make;
};

std::span<const TableInfo> tables();
const TableInfo* find_table(std::string_view id);

Result<TableResult> ebbvh_build_times(Laboratory& laboratory, const std::vector<Subject>& subjects);
Result<TableResult> ebbvh_camera_rays(Laboratory& laboratory, const std::vector<Subject>& subjects);
Result<TableResult> ebbvh_random_rays(Laboratory& laboratory, const std::vector<Subject>& subjects);
Result<TableResult> evh_area_reduction(Laboratory& laboratory, const std::vector<Subject>& subjects);
Result<TableResult> evh_thresholds(Laboratory& laboratory, const std::vector<Subject>& subjects);
Result<TableResult> evh_rotation(Laboratory& laboratory, const std::vector<Subject>& subjects);
Result<TableResult> popov_recursive_cost(Laboratory& laboratory, const std::vector<Subject>& subjects);
Result<TableResult> popov_presplit(Laboratory& laboratory, const std::vector<Subject>& subjects);
Result<TableResult> popov_geometric(Laboratory& laboratory, const std::vector<Subject>& subjects);
Result<TableResult> popov_generic(Laboratory& laboratory, const std::vector<Subject>& subjects);
Result<TableResult> popov_overlap_penalty(Laboratory& laboratory, const std::vector<Subject>& subjects);
Result<TableResult> compare_builders(Laboratory& laboratory, const std::vector<Subject>& subjects);

}  // namespace boxwood::program::reproduce
