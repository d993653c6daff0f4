// The registry of pre-splits, its text form, and the entry that runs one.
#include "base/method_text.h"
#include "refs/presplit_list.h"
#include "refs/presplit_passes.h"

namespace boxwood::refs {
namespace {

constexpr PresplitInfo kNone = {
    .id = "none",
    .summary = "one reference per triangle",
    .paper = "",
    .options = {},
    .subdivides = false,
    .apply = nullptr,
};

}  // namespace

std::span<const PresplitInfo> presplits() {
  static const PresplitInfo rows[] = {kNone,
                                      edge_volume_presplit,
                                      automatic_edge_volume_presplit,
                                      volume_clipping_presplit,
                                      early_split_clipping_presplit,
                                      priority_presplit};
  return rows;
}

Presplit::Presplit() : info(&presplits()[0]) {}

double Presplit::value(std::string_view key) const {
  return method_value(*info, values, key);
}

std::string Presplit::text() const {
  return method_text(*info, values);
}

Result<Presplit> parse_presplit(std::string_view text) {
  try {
    auto parsed = MethodParser<PresplitInfo>("pre-split", presplits()).parse(text);
    if (!parsed) return parsed.error();
    Presplit presplit;
    presplit.info = parsed->row;
    presplit.values = std::move(parsed->values);
    return presplit;
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory, "out of memory while reading a pre-split"};
  }
}

Result<ReferenceSet> apply_presplit(ReferenceSet&& set, const MeshView& mesh, const Presplit& presplit,
                                    Executor& executor, PresplitReport* report) {
  try {
    ReferenceSet split = std::move(set);
    PresplitReport own;
    PresplitReport& filled = report ? *report : own;
    filled = {};
    filled.references_before = split.references.size();
    if (!presplit.is_none()) {
      if (!split.primitives) split.primitives = triangle_primitives(mesh);
      if (const Status status = presplit.info->apply(split, mesh, presplit, executor, filled); !status)
        return status.error();
    }
    filled.references_after = split.references.size();
    return split;
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory, "out of memory for the references of the pre-split '" + presplit.text() + "'"};
  }
}

}  // namespace boxwood::refs
