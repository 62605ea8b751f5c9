// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/support/convex.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hgrid {
namespace test {

Convex::Convex(const Shape& shape, const Pose& world_from_shape, double padding) : radius_(padding) {
  const std::vector<double> size = shape.dimensions();
  const auto alongZ = [](Real z) { return Vector3r(0, 0, z); };
  x_ = world_from_shape.linear().col(0).cast<Real>();
  y_ = world_from_shape.linear().col(1).cast<Real>();
  switch (shape.kind()) {
    case ShapeKind::sphere:
      add(world_from_shape, Vector3r::Zero());
      radius_ += size[0];
      break;
    case ShapeKind::box:
      for (int corner = 0; corner < 8; ++corner) {
        const Real x = corner & 1 ? 0.5L : -0.5L, y = corner & 2 ? 0.5L : -0.5L, z = corner & 4 ? 0.5L : -0.5L;
        add(world_from_shape, Vector3r(x * size[0], y * size[1], z * size[2]));
      }
      break;
    case ShapeKind::cylinder:
      for (const Real end : {-0.5L, 0.5L}) add(world_from_shape, alongZ(end * size[0]), size[1]);
      break;
    case ShapeKind::cone:
      add(world_from_shape, alongZ(-0.5L * size[0]), size[1]);
      add(world_from_shape, alongZ(0.5L * size[0]));
      break;
    case ShapeKind::capsule:
      for (const Real end : {-0.5L, 0.5L}) add(world_from_shape, alongZ(end * size[0]));
      radius_ += size[1];
      break;
    case ShapeKind::hull:
      for (const Eigen::Vector3d& vertex : shape.mesh()->vertices) add(world_from_shape, vertex.cast<Real>());
      break;
    case ShapeKind::mesh:
    case ShapeKind::plane:
      throw std::invalid_argument("a mesh is not convex, and a plane has no center");
  }
  findBall();
}

Convex::Convex(const std::array<Eigen::Vector3d, 3>& corners, const Pose& world_from_corners, double padding)
    : radius_(padding) {
  for (const Eigen::Vector3d& corner : corners) add(world_from_corners, corner.cast<Real>());
  findBall();
}

Convex::Convex(const Eigen::Vector3d& point) {
  add(Pose::Identity(), point.cast<Real>());
  findBall();
}

void Convex::add(const Pose& world_from_shape, const Vector3r& center, Real radius) {
  const Vector3r turned = world_from_shape.linear().cast<Real>() * center;
  discs_.push_back({turned + world_from_shape.translation().cast<Real>(), radius});
}

void Convex::findBall() {
  center_.setZero();
  for (const Disc& disc : discs_) center_ += disc.center / Real(discs_.size());
  for (const Disc& disc : discs_) reach_ = std::max(reach_, (disc.center - center_).norm() + disc.radius);
}

Vector3r Convex::support(const Vector3r& direction) const {
  using std::hypot;
  const Real u = direction.dot(x_), v = direction.dot(y_), across = hypot(u, v);
  const Disc* farthest = nullptr;
  Real most = 0;
  for (const Disc& disc : discs_) {
    const Real along = disc.center.dot(direction) + disc.radius * across;
    if (farthest && along <= most) continue;
    farthest = &disc;
    most = along;
  }
  if (farthest->radius == 0) return farthest->center;
  if (across == 0) return farthest->center + farthest->radius * x_;  // all points of the disc are equally far
  return farthest->center + farthest->radius * ((u / across) * x_ + (v / across) * y_);
}

}  // namespace test
}  // namespace hgrid
