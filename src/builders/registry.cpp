// The registry: the rows of builder_list.h as one table.
#include "builders/builder_list.h"

namespace boxwood::builders {

std::span<const BuilderInfo> registry() {
  // Filled at the first call: the rows are constants of other files, all of them initialised before any code runs.
#define BOXWOOD_BUILDER_ROW(name) name##_builder,
  static const BuilderInfo rows[] = {BOXWOOD_BUILDER_LIST(BOXWOOD_BUILDER_ROW)};
#undef BOXWOOD_BUILDER_ROW
  return rows;
}

const BuilderInfo* find(std::string_view id) {
  for (const BuilderInfo& row : registry())
    if (id == row.id) return &row;
  return nullptr;
}

}  // namespace boxwood::builders
