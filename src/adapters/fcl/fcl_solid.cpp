// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "adapters/fcl/fcl_solid.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>

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
    case ShapeKind::plane:
      break;
  }
  return nullptr;
}

}  // namespace

FclConvexSolid::FclConvexSolid(const Shape& shape) : ConvexSolid(shape), geometry_(geometryOf(shape)) {}

}  // namespace hgrid
