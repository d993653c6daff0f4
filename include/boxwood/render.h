// Rays to measure with and pictures to look at. Link boxwood::render for this header.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "boxwood/accel.h"

namespace boxwood::render {

// ---- Ray sets ------------------------------------------------------------------------------------------------------

/// One ray through the centre of each pixel, row by row from the top left; unit directions. Valid: 1 <= width, height
/// <= 16384, finite view, eye != look_at, 0 < fov < 180; an `up` along the view direction is replaced by another axis.
Result<std::vector<Ray>> primary_rays(const View& view, int width, int height);

// The functions that return rays without a Result throw std::bad_alloc when memory runs out.

/// Origins uniform in the box, directions uniform on the sphere. A box that is empty or not finite has no points to
/// start from and gives no rays.
std::vector<Ray> random_rays(const Box& bounds, std::size_t count, std::uint64_t seed);

/// Lines through the box without an end, uniform among all that meet it: every line has its origin outside and tmax =
/// infinity. What the surface area cost assumes of rays; its expected counts are measured with these, non-terminating.
/// A box that is empty or not finite gives none.
std::vector<Ray> line_rays(const Box& bounds, std::size_t count, std::uint64_t seed);

/// For each primary ray that hits: one ray from the hit point, cosine-distributed about the normal on the side the ray
/// came from; primary rays that miss give none. Origins are lifted off the surface by a few ulps, by more
/// where a sliver's ray would still meet its own triangle. In the order of the primary rays.
std::vector<Ray> diffuse_rays(const Accel& accel, std::span<const Ray> primary, std::uint64_t seed);

/// For each primary ray that hits: a segment of the length `radius` (in units of the mesh; 0 = a fifth of the box's
/// diagonal, and so are values that are not above 0), cosine-distributed like diffuse rays: ambient occlusion's
/// question. For any-hit queries.
std::vector<Ray> occlusion_rays(const Accel& accel, std::span<const Ray> primary, std::uint64_t seed, float radius = 0);

/// 64-bit hash of a ray set, to show that two measurements traced the same rays.
std::uint64_t hash(std::span<const Ray> rays);

// ---- Pictures ------------------------------------------------------------------------------------------------------

/// `normals`: shaded by the angle to the viewer, tinted by the normal. `ao`: ambient occlusion, 16 rays a pixel,
/// smoothed over neighbours on the same surface. `depth`: nearer is lighter. `nodes`, `primitives`: heat map of visits
/// or triangle tests per primary ray, with a colour scale and its numbers drawn into the picture. `ids`: a colour per
/// triangle. Three show a number that each triangle has: `subdivided` is `normals` with all but 0 in red (Dammertz and
/// Keller 2008, Figure 3); `clusters` has one colour for each number (Houghton and Spoerer, Figures 1 to 4); `children`
/// has 0 in grey, 1 in blue, 2 in orange, 3 in violet: neither, the first, the second or both of a node's children
/// (Popov et al. 2009, Figure 2).
enum class Shade { normals, ao, depth, nodes, primitives, ids, subdivided, clusters, children };
Result<Shade> find_shade(std::string_view name);

/// Traces one primary ray a pixel on the accel's executor. `numbers` are those of the triangles, by primitive id, for
/// the shades that show them; ids past their end have 0. Errors: those of primary_rays.
Result<Image> render(const Accel& accel, const View& view, int width, int height, Shade shade,
                     std::span<const std::uint32_t> numbers = {});

}  // namespace boxwood::render
