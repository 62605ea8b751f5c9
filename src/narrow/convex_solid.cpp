// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/convex_solid.h"

#include <stdexcept>

namespace hgrid {
namespace {

ConvexCore coreOf(const Shape& shape) {
  const auto& size = shape.dimensions();
  switch (shape.kind()) {
    case ShapeKind::sphere:
      return ConvexCore::point();
    case ShapeKind::box:
      return ConvexCore::box({size[0], size[1], size[2]});
    case ShapeKind::cylinder:
      return ConvexCore::cylinder(size[0], size[1]);
    case ShapeKind::cone:
      return ConvexCore::cone(size[0], size[1]);
    case ShapeKind::capsule:
      return ConvexCore::segment(size[0]);
    case ShapeKind::hull:
      return ConvexCore::hull(shape.mesh()->vertices.data(), shape.mesh()->vertices.size());
    case ShapeKind::mesh:
      break;
  }
  throw std::invalid_argument("ConvexSolid: the shape is a mesh; it must be convex, for example the hull of the mesh");
}

}  // namespace

ConvexSolid::ConvexSolid(const Shape& shape) : OrderedSolid(shape), core_(coreOf(shape)), is_shape_(true) {
  if (shape.kind() == ShapeKind::hull) some_point_ = shape.mesh()->vertices.front();
}

}  // namespace hgrid
