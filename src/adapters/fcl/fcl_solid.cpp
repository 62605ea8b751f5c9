// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "adapters/fcl/fcl_solid.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/utility.h>

#include <array>

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;

/// Returns the core of a convex shape for FCL. The radius of a sphere or a capsule is 0.
std::unique_ptr<const fcl::CollisionGeometryd> geometryOf(const Shape& shape) {
  const std::vector<double> size = shape.dimensions();
  switch (shape.kind()) {
    case ShapeKind::sphere:
      return std::make_unique<fcl::Sphered>(0.0);
    case ShapeKind::box:
      return std::make_unique<fcl::Boxd>(size[0], size[1], size[2]);
    case ShapeKind::cylinder:
      return std::make_unique<fcl::Cylinderd>(size[1], size[0]);
    case ShapeKind::cone:
      return std::make_unique<fcl::Coned>(size[1], size[0]);
    case ShapeKind::capsule:
      return std::make_unique<fcl::Capsuled>(0.0, size[0]);
    case ShapeKind::hull:
      // The hull gets no faces. FCL then uses all vertices, so its result does not depend on the faces.
      return std::make_unique<fcl::Convexd>(std::make_shared<const std::vector<Vector>>(shape.mesh()->vertices), 0,
                                            std::make_shared<const std::vector<int>>());
    case ShapeKind::mesh:
      break;
  }
  return nullptr;
}

/// Returns a bounding volume of a core.
fcl::OBBRSSd volumeAround(const ConvexCore& core) {
  Vector low, high;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = core.support(-Vector::Unit(axis))[axis];
    high[axis] = core.support(Vector::Unit(axis))[axis];
  }
  std::array<Vector, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] = {i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z()};
  }
  fcl::OBBRSSd volume;
  fcl::fit(corners.data(), static_cast<int>(corners.size()), volume);
  return volume;
}

}  // namespace

FclConvexSolid::FclConvexSolid(const Shape& shape)
    : ConvexSolid(shape), volume_(volumeAround(core())), geometry_(geometryOf(shape)) {}

FclConvexSolid::FclConvexSolid(const ConvexCore& core, const std::vector<double>& size)
    : ConvexSolid(core, size), volume_(volumeAround(core)) {}

}  // namespace hgrid
