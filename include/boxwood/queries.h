// Ray queries: the hit record, the kernels of each layout and instruction set, and the brute-force oracle.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "boxwood/base.h"
#include "boxwood/layouts.h"
#include "boxwood/math.h"
#include "boxwood/mesh.h"
#include "boxwood/parallel.h"

namespace boxwood {

/// The nearest triangle on a ray. u and v are the barycentric weights of the second and third corner, so the point is
/// (1 - u - v) * v0 + u * v1 + v * v2. Where several triangles have the same t the lowest primitive id wins.
struct Hit {
  float t = kInfinity;
  float u = 0, v = 0;
  std::uint32_t primitive = layouts::kInvalidPrimitive;

  bool is_hit() const { return primitive != layouts::kInvalidPrimitive; }
  explicit operator bool() const { return is_hit(); }
};
static_assert(sizeof(Hit) == 16);

namespace queries {

/// `robust`: watertight triangle test (Woop, Benthin and Wald 2013), exact at shared edges and vertices: a ray can't
/// pass between triangles that share them. `fast`: Moeller and Trumbore's test (1997), which may let a ray through an
/// edge or vertex. Both test boxes conservatively and give the same bits on every instruction set.
enum class Mode { robust, fast };
Result<Mode> find_mode(std::string_view name);
const char* name(Mode mode);

/// How rays go through a tree. `single`: one by one. `packet4`: four at a time, a mask saying which are active.
/// `range`: a packet goes where its first active ray goes, the rays before that one being inactive. `partition`: a
/// packet keeps the numbers of its active rays in front. Only the layout `linear` has these three packets.
/// `batch`, the default of calls with many rays, picks for each tile of rays: coherent packets, many rays in flight or
/// single rays; on the layouts `linear` and `wide4` it is `single`. The other three force one way, and need the layout
/// `wide8`, `wide8-quads` or `wide16`: `coherent`: packets of 64 rays, inner nodes tested once for the beam that
/// encloses them; `interleaved`: many rays in flight, in phases; `sorted`: the same after sorting blocks of rays by
/// octant, origin and direction. See docs/batches.md. All give the same hits.
enum class Traversal { single, packet4, range, partition, batch, coherent, interleaved, sorted };
Result<Traversal> find_traversal(std::string_view name);
const char* name(Traversal traversal);

struct TraversalOptions {
  Traversal traversal = Traversal::batch;
  /// Rays in a packet of `range` and `partition`, which take neighbours in the array: 16 to 1024.
  std::uint32_t packet_size = 256;
  /// False: hits are found as ever but neither shorten a ray nor end it, so that the counts are those the surface area
  /// cost assumes. Only for the layout `linear`.
  bool terminating = true;

  /// One ray after the other, as select_kernels' kernels do it.
  bool is_single() const { return traversal == Traversal::single && terminating; }
};

/// Work done by a set of rays. A node visit tests the boxes of all children of one node (linear: the node's own box); a
/// primitive is one triangle tested. In packets `nodes` counts the tests made for that ray itself (for each active ray
/// of a packet4); tests made once for a whole packet are `packet_nodes` of the packet's first ray.
struct Counts {
  std::uint64_t rays = 0, nodes = 0, leaves = 0, primitives = 0, hits = 0, packet_nodes = 0;
  Counts& operator+=(const Counts& o) {
    rays += o.rays, nodes += o.nodes, leaves += o.leaves, primitives += o.primitives, hits += o.hits;
    packet_nodes += o.packet_nodes;
    return *this;
  }
};

/// Names of the instruction sets compiled in that this processor can run, best first: of "avx512", "avx2", "sse4",
/// "scalar" (and "neon" on ARM).
std::vector<std::string> supported_isas();
/// The instruction set to use: `name`, or if that is empty the environment variable BOXWOOD_ISA, or if that is not set
/// the best one. Errors: a name that is unknown or that this processor can't run.
Result<std::string> choose_isa(std::string_view name = {});

/// The layout that is fastest with an instruction set (empty: the one choose_isa takes): wide16 with SSE4, AVX2 and
/// AVX-512, else wide8 (docs/layouts.md).
const char* default_layout(std::string_view isa = {});

/// The kernels of one layout, mode and instruction set. All take arrays of rays of any length and walk them one by
/// one; outputs have the same length. Thread safe, no allocation unless the tree is unusually deep.
struct Kernels {
  void (*closest)(const layouts::Layout&, const Ray* rays, std::size_t count, Hit* hits, Vec3* normals);
  void (*any)(const layouts::Layout&, const Ray* rays, std::size_t count, std::uint8_t* occluded);
  void (*closest_counted)(const layouts::Layout&, const Ray* rays, std::size_t count, Hit* hits, Counts* per_ray);
  void (*any_counted)(const layouts::Layout&, const Ray* rays, std::size_t count, std::uint8_t* occluded,
                      Counts* per_ray);
};
/// `isa` as choose_isa gives it. `normals` may be null; else it gets the geometric normal (v1 - v0) x (v2 - v0), not
/// normalised, zero on a miss. `per_ray` gets one entry for each ray.
Result<Kernels> select_kernels(layouts::LayoutId layout, Mode mode, std::string_view isa);

/// The kernels of one traversal and mode. `normals` and `per_ray` may be null, else they have an entry for each ray. A
/// packet is made of neighbours in the array, beginning at the first.
struct TraversalKernels {
  void (*closest)(const layouts::Layout&, const Ray* rays, std::size_t count, const TraversalOptions&, Hit* hits,
                  Vec3* normals, Counts* per_ray);
  void (*any)(const layouts::Layout&, const Ray* rays, std::size_t count, const TraversalOptions&,
              std::uint8_t* occluded, Counts* per_ray);
};
/// Kernels for packets of the layout `linear` and for rays that are not terminating; select_kernels has those for
/// single, terminating rays, and batches are Accel's. They are the same code on every instruction set. Errors: a layout
/// that has not got that traversal, a packet size out of range, a traversal that is not one of these.
Result<TraversalKernels> select_traversal(layouts::LayoutId layout, Mode mode, const TraversalOptions& options);
/// Can Accel trace rays so in this layout? Default options and single, terminating rays never fail.
Status check_traversal(layouts::LayoutId layout, const TraversalOptions& options);

/// Prices of VisitCounts: opening a node and testing one block of a leaf.
inline constexpr std::uint64_t kNodePrice = 4, kBlockPrice = 1;

/// What rays do in a wide layout, child by child.
struct VisitCounts {
  struct Child {
    std::uint32_t met = 0;        ///< rays that come to its node and meet its box
    std::uint32_t successes = 0;  ///< of these, those that hit something below it
    std::uint64_t cost = 0;       ///< what any-hit queries pay below it until they have a hit or have seen all
  };
  int width = 0;
  std::vector<Child> children;     ///< `width` for each node, in the layout's order
  std::uint64_t total_cost = 0;    ///< of all nodes and leaves that the rays meet
  std::uint64_t any_hit_cost = 0;  ///< of any-hit queries over the whole tree
};

/// Follows rays into every box they meet within [tmin, tmax], also behind hits. With rays cut at their closest hits,
/// `met` is what closest-hit queries visit that go to the nearest child first, and a success is the closest hit. Robust
/// mode's tests. The same for every executor. Errors: the layout `linear`, out of memory.
Result<VisitCounts> count_visits(const layouts::Layout& layout, std::span<const Ray> rays, Executor& executor);

/// A closest hit by testing every triangle of the mesh in double precision (the determinant form of Moeller and
/// Trumbore with inclusive edges; degenerate and non-finite triangles are passed over). The oracle of the tests.
struct ExactHit {
  double t = std::numeric_limits<double>::infinity();
  double u = 0, v = 0;
  std::uint32_t primitive = layouts::kInvalidPrimitive;
  /// How clear the verdict is: for a hit, the smallest barycentric weight; a hit with less than about 1e-6 lies on an
  /// edge or vertex, where single precision may rightly choose the neighbour.
  double margin = 0;
};
ExactHit brute_force_closest(const MeshView& mesh, const Ray& ray);
/// One triangle in double precision; t = inf when missed. Ignores [tmin, tmax].
ExactHit exact_intersection(const Triangle& triangle, const Ray& ray);

}  // namespace queries
}  // namespace boxwood
