// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <ode/ode.h>

#include "bench/exactness/exactness_peer.h"
#include "bench/exactness/hull_faces.h"

namespace hgrid {
namespace bench {
namespace {

/// A geometry of ODE at its pose, and the arrays that ODE does not copy.
class OdeShape {
 public:
  OdeShape(const Shape& shape, const Pose& pose) : geom_(geomOf(shape)) {
    const Eigen::Vector3d at = pose * center_;
    dMatrix3 rotation{};
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) rotation[4 * row + column] = pose.linear()(row, column);
    }
    dGeomSetRotation(geom_, rotation);
    dGeomSetPosition(geom_, at.x(), at.y(), at.z());
  }
  ~OdeShape() { dGeomDestroy(geom_); }
  OdeShape(const OdeShape&) = delete;
  OdeShape& operator=(const OdeShape&) = delete;

  dGeomID geom() const { return geom_; }

 private:
  dGeomID geomOf(const Shape& shape) {
    const std::vector<double> size = shape.dimensions();
    switch (shape.kind()) {
      case ShapeKind::sphere:
        return dCreateSphere(nullptr, size[0]);
      case ShapeKind::box:
        return dCreateBox(nullptr, size[0], size[1], size[2]);
      case ShapeKind::cylinder:
        return dCreateCylinder(nullptr, size[1], size[0]);
      case ShapeKind::capsule:
        return dCreateCapsule(nullptr, size[1], size[0]);
      default:
        return convexOf(hullFacesOf(shape.mesh()->vertices));
    }
  }

  dGeomID convexOf(const HullFaces& hull) {
    center_ = hull.center;
    for (const Eigen::Vector3d& corner : hull.corners) points_.insert(points_.end(), corner.data(), corner.data() + 3);
    for (const auto& [a, b, c] : hull.faces) {
      polygons_.insert(polygons_.end(), {3u, unsigned(a), unsigned(b), unsigned(c)});
      const Eigen::Vector3d &at = hull.corners[a],
                            normal = (hull.corners[b] - at).cross(hull.corners[c] - at).normalized();
      planes_.insert(planes_.end(), {normal.x(), normal.y(), normal.z(), normal.dot(at)});
    }
    return dCreateConvex(nullptr, planes_.data(), unsigned(hull.faces.size()), points_.data(),
                         unsigned(hull.corners.size()), polygons_.data());
  }

  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();  // [m] origin of the geometry in the frame of the shape
  std::vector<dReal> planes_, points_;
  std::vector<unsigned> polygons_;
  dGeomID geom_;
};

}  // namespace

/// ODE has no distances and no settings for the accuracy. The deepest contact counts. ODE has doubles (Debian).
ExactnessAnswer measureWithOde(const test::Case& placed) {
  static const int ready = dInitODE2(0);
  ExactnessAnswer answer;
  answer.given = ready != 0;
  const OdeShape first(placed.first_shape, placed.world_from_first),
      second(placed.second_shape, placed.world_from_second);
  dContactGeom contacts[32];
  const int count = dCollide(first.geom(), second.geom(), 32, contacts, sizeof(contacts[0]));
  for (int i = 0; i < count; ++i) {
    if (answer.touches && contacts[i].depth <= answer.depth) continue;
    answer.touches = true;
    answer.depth = contacts[i].depth;  // the normal of ODE says where the first geometry is to be moved
    answer.normal = -Eigen::Vector3d(contacts[i].normal[0], contacts[i].normal[1], contacts[i].normal[2]);
  }
  return answer;
}

}  // namespace bench
}  // namespace hgrid
