// The Edge Volume Heuristic as a preprocess (Dammertz and Keller 2008, section 2.3; bib key evh): the mesh itself is
// cut where the pre-split would cut references, for ray tracers that can't be changed. Which edges are cut depends on
// the edge alone, and a midpoint is the same float from both ends, so triangles that share an edge keep sharing all of
// it; `open_edges_*` count whether that held. Two passes over fixed chunks, then midpoints are welded by position.
// O(parts), parallel, deterministic.
#include "mesh/edge_table.h"
#include "refs/edge_volume.h"
#include "refs/presplit_passes.h"

namespace boxwood::refs {
namespace {

struct CutCounter {
  std::size_t count = 0;
  void part(const TrianglePart&) { ++count; }
  void cut(const TrianglePart&, const TrianglePart&, const TrianglePart&, Vec3) {}
  bool is_full() const { return count > kMostParts; }
};

/// Writes triangles and midpoints of one triangle after the other.
struct CutWriter {
  std::array<std::uint32_t, 3>* triangles;
  Vec3* midpoints;
  std::uint32_t next_midpoint;             ///< vertex number of *midpoints
  std::array<std::uint32_t, 3> corners{};  ///< of the triangle being cut
  std::uint32_t first_midpoint = 0;

  void begin(const std::array<std::uint32_t, 3>& whole) { corners = whole, first_midpoint = next_midpoint; }
  void part(const TrianglePart& part) {
    for (std::size_t i = 0; i < 3; ++i)
      (*triangles)[i] = part.numbers[i] < 3 ? corners[part.numbers[i]] : first_midpoint + part.numbers[i] - 3;
    ++triangles;
  }
  void cut(const TrianglePart&, const TrianglePart&, const TrianglePart&, Vec3 middle) {
    *midpoints++ = middle;
    ++next_midpoint;
  }
  bool is_full() const { return false; }
};

struct ChunkCounts {
  std::size_t parts = 0, split = 0, first_part = 0, first_midpoint = 0;
};

Error too_large(const ReferenceSet& set) {
  return {ErrorCode::too_large, "subdivision would make more than " + std::to_string(kMostParts) +
                                    " triangles or vertices of " + std::to_string(set.references.size()) +
                                    " triangles"};
}

/// False when there would be too many.
bool count_cuts(const ReferenceSet& set, const MeshView& mesh, const EdgeRule& rule, Executor& executor,
                std::vector<ChunkCounts>& chunks) {
  chunks.resize((set.references.size() + kPresplitChunk - 1) / kPresplitChunk);
  std::atomic<std::size_t> total = 0;  // only whether it passes the limit matters
  executor.for_chunks(set.references.size(), kPresplitChunk,
                      [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                        if (total.load(std::memory_order_relaxed) > kMostParts) return;
                        for (std::size_t i = begin; i < end && chunks[chunk].parts <= kMostParts; ++i) {
                          CutCounter counter;
                          cut_by_edges(mesh.triangle(set.references[i].primitive), rule, counter);
                          chunks[chunk].parts += counter.count;
                          chunks[chunk].split += counter.count > 1;
                        }
                        total.fetch_add(chunks[chunk].parts, std::memory_order_relaxed);
                      });
  std::size_t parts = 0, whole = 0;
  for (ChunkCounts& chunk : chunks) {
    chunk.first_part = parts;
    chunk.first_midpoint = parts - whole;
    parts += chunk.parts;
    whole += std::min(kPresplitChunk, set.references.size() - whole);
  }
  return parts + mesh.vertex_count <= kMostParts;
}

/// Lets equal midpoints be one vertex, the first of them, and closes the gaps.
void weld_midpoints(TriangleMesh& mesh, std::size_t old_vertices, Executor& executor) {
  const MeshView midpoints{mesh.vertices.data() + old_vertices, mesh.vertices.size() - old_vertices};
  std::vector<std::uint32_t> number = mesh::weld(midpoints, executor);
  std::uint32_t next = static_cast<std::uint32_t>(old_vertices);
  for (std::size_t i = 0; i < number.size(); ++i) {
    const bool is_first = number[i] == i;
    if (is_first) mesh.vertices[next] = mesh.vertices[old_vertices + i];
    number[i] = is_first ? next++ : number[number[i]];
  }
  mesh.vertices.resize(next);
  executor.for_chunks(mesh.triangles.size(), 1 << 14, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::uint32_t& corner : mesh.triangles[i])
        if (corner >= old_vertices) corner = number[corner - old_vertices];
  });
}

std::size_t pieces_of(Vec3 a, Vec3 b, const EdgeRule& rule) {
  struct Piece {
    Vec3 a, b;
    std::uint32_t depth = 0;
  };
  std::vector<Piece> stack{{a, b}};
  std::size_t pieces = 0;
  while (!stack.empty()) {
    const Piece piece = stack.back();
    stack.pop_back();
    if (piece.depth >= kDeepestCut || rule.excess(piece.a, piece.b) == 0) {
      ++pieces;
      continue;
    }
    const Vec3 middle = midpoint(piece.a, piece.b);
    stack.push_back({piece.a, middle, piece.depth + 1});
    stack.push_back({middle, piece.b, piece.depth + 1});
  }
  return pieces;
}

/// Edges, by position, that one usable triangle has; `pieces`, if any, what the rule cuts them into.
std::size_t count_open_edges(const MeshView& mesh, Executor& executor, const EdgeRule& rule, std::size_t* pieces) {
  const std::vector<std::uint32_t> ids = mesh::weld(mesh, executor);
  std::vector<std::uint8_t> left_out(mesh.triangle_count);
  for (std::size_t i = 0; i < left_out.size(); ++i) left_out[i] = !mesh::is_usable(mesh.triangle(i));
  const mesh::EdgeTable table = mesh::make_edge_table(mesh, ids, left_out, executor);
  std::size_t open = 0;
  mesh::for_each_edge(table, 0, table.vertex_count(),
                      [&](std::uint32_t low, std::uint32_t high, std::span<const mesh::EdgeUse> uses) {
                        if (uses.size() != 1) return;
                        ++open;
                        if (pieces) *pieces += pieces_of(mesh.vertex(low), mesh.vertex(high), rule);
                      });
  return open;
}

Result<Subdivision> subdivide_checked(const MeshView& mesh, const Presplit& presplit, Executor& executor) {
  const Result<ReferenceSet> set = make_references(mesh, executor);
  if (!set) return set.error();
  PresplitReport report;
  const EdgeRule rule = make_edge_rule(*set, mesh, presplit, executor, report);
  std::vector<ChunkCounts> chunks;
  if (!count_cuts(*set, mesh, rule, executor, chunks)) return too_large(*set);

  Subdivision result;
  result.left_out = set->excluded;
  std::size_t parts = 0;
  for (const ChunkCounts& chunk : chunks) parts += chunk.parts, result.split += chunk.split;
  const std::size_t old_vertices = mesh.vertex_count;
  result.mesh.triangles.resize(parts);
  result.mesh.vertices.resize(old_vertices + parts - set->references.size());
  for (std::size_t i = 0; i < old_vertices; ++i) result.mesh.vertices[i] = mesh.vertex(i);
  executor.for_chunks(
      set->references.size(), kPresplitChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        const std::size_t first_vertex = old_vertices + chunks[chunk].first_midpoint;
        CutWriter writer{result.mesh.triangles.data() + chunks[chunk].first_part,
                         result.mesh.vertices.data() + first_vertex, static_cast<std::uint32_t>(first_vertex)};
        for (std::size_t i = begin; i < end; ++i) {
          const std::uint32_t triangle = set->references[i].primitive;
          writer.begin(mesh.corners(triangle));
          cut_by_edges(mesh.triangle(triangle), rule, writer);
        }
      });
  weld_midpoints(result.mesh, old_vertices, executor);
  result.midpoints = result.mesh.vertices.size() - old_vertices;
  result.open_edges_before = count_open_edges(mesh, executor, rule, &result.open_edges_expected);
  result.open_edges_after = count_open_edges(result.mesh, executor, rule, nullptr);
  return result;
}

}  // namespace

Result<Subdivision> subdivide(const MeshView& mesh, const Presplit& presplit, Executor& executor) {
  try {
    if (!presplit.info->subdivides) {
      std::string list;
      for (const PresplitInfo& row : presplits())
        if (row.subdivides) list += std::string(list.empty() ? "" : ", ") + row.id;
      return {ErrorCode::unsupported, "the pre-split '" + presplit.text() +
                                          "' cuts no edges, so it can't subdivide a mesh; those that can are " + list};
    }
    return subdivide_checked(mesh, presplit, executor);
  } catch (const std::bad_alloc&) {
    return {ErrorCode::out_of_memory,
            "out of memory while subdividing " + std::to_string(mesh.triangle_count) + " triangles"};
  }
}

}  // namespace boxwood::refs
