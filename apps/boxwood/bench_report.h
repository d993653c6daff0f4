// What boxwood bench says: tables for people, JSON rows and CSV for programs.
#pragma once

#include "bench_types.h"

namespace boxwood::program {

/// `full`: what building cost, then each ray kind with its spread. Both end with one line per contestant.
std::string tables(const BenchPlan& plan, const BenchResult& result, bool full);

/// One JSON object per row, the same keys as the columns of `csv`.
Json rows_json(const BenchPlan& plan, const BenchResult& result);
/// A head line and one line per row.
std::string csv(const Json& rows);

}  // namespace boxwood::program
