// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/convex_solid.h"

#include <stdexcept>
#include <string>

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
    case ShapeKind::plane:
      break;
  }
  throw std::invalid_argument(std::string("ConvexSolid: the shape is a ") + name(shape.kind()) +
                              "; it must be convex and bounded, for example the hull of a mesh");
}

/// Returns a tree with one box, that of the core.
BoxTree boxAround(const ConvexCore& core) {
  Eigen::Vector3d low, high;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = core.support(-Eigen::Vector3d::Unit(axis))[axis];
    high[axis] = core.support(Eigen::Vector3d::Unit(axis))[axis];
  }
  BoxTree tree;
  tree.center = 0.5 * (low + high);
  tree.reach = 0.5 * (high - low).norm();
  tree.nodes.resize(1);
  addChild(tree.nodes[0], Eigen::Matrix3d::Identity(), low - tree.center, high - tree.center, ~0);
  return tree;
}

}  // namespace

ConvexSolid::ConvexSolid(const Shape& shape) : OrderedSolid(shape), core_(coreOf(shape)), box_(boxAround(core_)) {
  if (shape.kind() == ShapeKind::hull) some_point_ = shape.mesh()->vertices.front();
}

ConvexSolid::ConvexSolid(const ConvexCore& core, const std::vector<double>& size)
    : OrderedSolid(size, core.reach()), core_(core), box_(boxAround(core)) {}

}  // namespace hgrid
