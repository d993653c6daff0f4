// Meshes name neighbouring triangles one after the other more often than not: exporters write both halves of a quad
// together, scanners and subdivision go along rows. So looking at the next reference finds most of the pairs that a
// search over shared edges would find (Houghton and Spoerer, bib key ebbvh, first round), for nothing.
//
// Runs are taken greedily within chunks of fixed size. The tree over them is in canonical form, where leaves name
// ranges of references in order: a sum over the runs' lengths says where each range is once they are replaced.
#include "builders/parts/merged_runs.h"

#include <algorithm>
#include <vector>

#include "builders/parts/box4.h"

namespace boxwood::builders {
namespace {

using refs::Reference;

constexpr std::size_t kChunk = std::size_t{1} << 12;

std::size_t chunk_count(std::size_t count) {
  return (count + kChunk - 1) / kChunk;
}

/// Calls f(first reference, box) for each run of the references [begin, end), once all of the run have been read.
template <class F>
void for_runs(std::span<const Reference> references, std::size_t begin, std::size_t end, std::uint32_t most,
              float growth, F f) {
  const Float4 mask = xyz_mask();
  const auto load = [&](std::size_t i) {
    const Box4 box = Box4::of(references[i]);
    return Box4{box.lower & mask, box.upper & mask};
  };
  for (std::size_t first = begin; first < end;) {
    Box4 box = load(first);
    float parts = half_area(box.upper - box.lower);
    std::uint32_t primitive = references[first].primitive;
    std::size_t last = first + 1;
    for (; last < end && last - first < most; ++last) {
      if (references[last].primitive == primitive) break;
      const Box4 next = load(last);
      const Box4 joined{minimum(box.lower, next.lower), maximum(box.upper, next.upper)};
      const float with_next = parts + half_area(next.upper - next.lower);
      if (!(half_area(joined.upper - joined.lower) <= growth * with_next)) break;
      box = joined;
      parts = with_next;
      primitive = references[last].primitive;
    }
    f(first, box);
    first = last;
  }
}

/// Writes the runs of the references [begin, end) over them, from `begin` on, and the first reference of each. Returns
/// their number.
std::size_t write_runs(std::span<Reference> references, std::size_t begin, std::size_t end, std::uint32_t most,
                       float growth, std::uint32_t* first_of_run) {
  std::size_t run = begin;
  for_runs(references, begin, end, most, growth, [&](std::size_t first, const Box4& box) {
    box.lower.store(&references[run].lower);
    box.upper.store(&references[run].upper);
    first_of_run[run++] = std::uint32_t(first);
  });
  return run - begin;
}

/// counts[c + 1] of each chunk c become the sums before them.
std::size_t add_up(std::vector<std::size_t>& counts) {
  for (std::size_t c = 1; c < counts.size(); ++c) counts[c] += counts[c - 1];
  return counts.back();
}

}  // namespace

double sampled_saving(std::span<const Reference> references, std::uint32_t most, double growth) {
  constexpr std::size_t kStretches = 16, kStretch = 256;
  const std::size_t distance = std::max(kStretch, references.size() / kStretches);
  std::size_t looked_at = 0, runs = 0;
  for (std::size_t begin = 0; begin < references.size(); begin += distance) {
    const std::size_t end = std::min(begin + kStretch, references.size());
    for_runs(references, begin, end, most, float(growth), [&](std::size_t, const Box4&) { ++runs; });
    looked_at += end - begin;
  }
  return looked_at == 0 ? 0 : 1 - double(runs) / double(looked_at);
}

MergedRuns::MergedRuns(refs::ReferenceSet&& set, bool numbered, std::uint32_t most, double growth, Executor& executor)
    : primitive_count_(set.primitive_count) {
  refs::ReferenceSet whole = std::move(set);
  const std::span<Reference> references = whole.references.span();
  const std::size_t count = references.size();
  if (!numbered) {
    primitives_ = AlignedBuffer<std::uint32_t>(count);
    for (std::size_t i = 0; i < count; ++i) primitives_[i] = references[i].primitive;
  }
  AlignedBuffer<std::uint32_t> first_of_run(count);  // by place, as the runs
  std::vector<std::size_t> runs_before(chunk_count(count) + 1);
  executor.for_chunks(count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    runs_before[chunk + 1] = write_runs(references, begin, end, most, float(growth), first_of_run.data());
  });
  const std::size_t runs = add_up(runs_before);
  first_ = AlignedBuffer<std::uint32_t>(runs + 1);
  first_[runs] = std::uint32_t(count);
  runs_.references = AlignedBuffer<Reference>(runs);
  runs_.primitive_count = runs;
  runs_.bounds = whole.bounds;
  runs_.primitives = refs::box_primitives();
  executor.for_chunks(count, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t) {
    for (std::size_t run = runs_before[chunk]; run < runs_before[chunk + 1]; ++run) {
      const std::size_t from = begin + run - runs_before[chunk];
      runs_.references[run] = {references[from].lower, std::uint32_t(run), references[from].upper, 0};
      first_[run] = first_of_run[from];
    }
  });
}

void MergedRuns::expand(tree::BinaryTree& tree, Executor& executor) const {
  const std::span<const std::uint32_t> runs = tree.references.span();
  std::vector<std::size_t> before(chunk_count(runs.size()) + 1);
  executor.for_chunks(runs.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) before[chunk + 1] += length(runs[i]);
  });
  AlignedBuffer<std::uint32_t> references(add_up(before)), start(runs.size() + 1);
  start[runs.size()] = std::uint32_t(references.size());
  executor.for_chunks(runs.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::size_t next = before[chunk];
    for (std::size_t i = begin; i < end; ++i) {
      start[i] = std::uint32_t(next);
      for (std::uint32_t r = first_[runs[i]]; r < first_[runs[i] + 1]; ++r)
        references[next++] = primitives_.empty() ? r : primitives_[r];
    }
  });
  executor.for_chunks(tree.nodes.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      tree::Node& node = tree.nodes[n];
      if (!node.is_leaf()) continue;
      const std::uint32_t last = node.first + node.count;
      node.first = start[node.first];
      node.count = start[last] - node.first;
    }
  });
  tree.references = std::move(references);
  tree.primitive_count = primitive_count_;
}

}  // namespace boxwood::builders
