// The only list of layouts.
#include "boxwood/layouts.h"

namespace boxwood::layouts {
namespace {

constexpr LayoutInfo kLayouts[] = {
    {LayoutId::linear, "linear", "PBRT's 32-byte binary nodes, scalar code; best for reading, porting and counting", 1},
    {LayoutId::wide4, "wide4", "128-byte nodes of 4 children, tested at once; best for 128-bit SIMD and small memory",
     3},
    {LayoutId::wide8, "wide8",
     "256-byte nodes of 8 children, tested at once; best for speed with AVX2 and up (default)", 3},
    {LayoutId::wide8_quads, "wide8-quads",
     "wide8 with pairs of triangles that share an edge in its leaves; best for large connected meshes and small "
     "memory",
     3},
    {LayoutId::wide16, "wide16", "448-byte nodes of 16 children: fewer steps for each ray; best for speed with AVX-512",
     5},
};

}  // namespace

std::span<const LayoutInfo> registry() {
  return kLayouts;
}

Result<LayoutId> find(std::string_view name) {
  std::string known;
  for (const LayoutInfo& row : kLayouts) {
    if (name == row.name) return row.id;
    known += std::string(known.empty() ? "" : ", ") + row.name;
  }
  return {ErrorCode::unknown_name, "unknown layout '" + std::string(name) + "'; there are: " + known};
}

const char* name(LayoutId id) {
  for (const LayoutInfo& row : kLayouts)
    if (row.id == id) return row.name;
  return "?";
}

float node_cost(LayoutId id) {
  for (const LayoutInfo& row : kLayouts)
    if (row.id == id) return row.node_cost;
  return 1;
}

int width(LayoutId id) {
  switch (id) {
    case LayoutId::linear:
      return 2;
    case LayoutId::wide4:
      return 4;
    case LayoutId::wide8:
    case LayoutId::wide8_quads:
      return 8;
    case LayoutId::wide16:
      return 16;
  }
  return 0;
}

bool has_quads(LayoutId id) {
  return id == LayoutId::wide8_quads;
}

}  // namespace boxwood::layouts
