// Where the next ray starts: a point just off a surface that a ray has hit.
#pragma once

#include "boxwood/accel.h"
#include "render/vector.h"

namespace boxwood::render {

struct SurfacePoint {
  Vec3 position;
  Vector normal;  ///< unit length, on the side the ray came from
};

/// `normal` turned to unit length and to the side the ray came from. A normal that is zero or not finite (a sliver too
/// small for single precision) becomes the direction back to the ray's origin.
Vector facing_normal(const Ray& ray, Vec3 normal);

/// The point of a hit, moved off the surface by a few units in the last place of the coordinates involved, so that a
/// ray from there neither meets the triangle it starts on nor passes through a neighbour. `factor` multiplies the move,
/// for triangles so thin that their hits are less exact than that.
SurfacePoint lifted_point(const Ray& ray, const Hit& hit, Vec3 normal, double factor = 1);

/// How far ambient occlusion looks when nobody says: a fifth of the box's diagonal.
float default_occlusion_radius(const Box& bounds);

}  // namespace boxwood::render
