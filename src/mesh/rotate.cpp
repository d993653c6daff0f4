// Rotation of meshes and views about the coordinate axes, in double precision, rounded once per coordinate.
#include <cmath>

#include "boxwood/mesh.h"

namespace boxwood::mesh {
namespace {

/// Sine and cosine of an angle in degrees, exact at multiples of 90.
void sine_cosine(float degrees, double& sine, double& cosine) {
  const double reduced = std::remainder(static_cast<double>(degrees), 360.0);
  const double quarter = std::nearbyint(reduced / 90);
  const double rest = (reduced - 90 * quarter) * (3.14159265358979323846 / 180);
  const double s = std::sin(rest), c = std::cos(rest);
  switch (static_cast<int>(quarter) & 3) {
    case 0:
      sine = s, cosine = c;
      break;
    case 1:
      sine = c, cosine = -s;
      break;
    case 2:
      sine = -s, cosine = -c;
      break;
    default:
      sine = -c, cosine = s;
  }
}

/// Rotation about x, then y, then z, each by degrees.
class Rotation {
 public:
  explicit Rotation(Vec3 degrees) {
    for (int axis = 0; axis < 3; ++axis) sine_cosine(degrees[axis], sine_[axis], cosine_[axis]);
  }
  Vec3 turn(Vec3 v, Vec3 center) const {
    double p[3];
    for (int axis = 0; axis < 3; ++axis) p[axis] = static_cast<double>(v[axis]) - center[axis];
    for (int axis = 0; axis < 3; ++axis) {
      double& a = p[(axis + 1) % 3];
      double& b = p[(axis + 2) % 3];
      const double turned = a * cosine_[axis] - b * sine_[axis];
      b = a * sine_[axis] + b * cosine_[axis];
      a = turned;
    }
    for (int axis = 0; axis < 3; ++axis) v[axis] = static_cast<float>(p[axis] + center[axis]);
    return v;
  }

 private:
  double sine_[3], cosine_[3];
};

/// Nothing need move, and nothing then changes by rounding either.
bool is_whole_turns(Vec3 degrees) {
  return std::remainder(degrees.x, 360.0f) == 0 && std::remainder(degrees.y, 360.0f) == 0 &&
         std::remainder(degrees.z, 360.0f) == 0;
}

}  // namespace

void rotate(TriangleMesh& mesh, Vec3 degrees, Vec3 center) {
  if (is_whole_turns(degrees)) return;
  const Rotation rotation(degrees);
  for (Vec3& v : mesh.vertices) v = rotation.turn(v, center);
}

View rotate(const View& view, Vec3 degrees, Vec3 center) {
  if (is_whole_turns(degrees)) return view;
  const Rotation rotation(degrees);
  return {rotation.turn(view.eye, center), rotation.turn(view.look_at, center), rotation.turn(view.up, {}), view.fov};
}

}  // namespace boxwood::mesh
