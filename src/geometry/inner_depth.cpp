// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "geometry/inner_depth.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;

/// Returns the unit vector in the direction of v; if v is 0, a unit vector perpendicular to z.
Vector directionOf(const Vector& v) {
  const double length = v.norm();
  return length > 0.0 ? Vector(v / length) : Vector(Vector::UnitX());
}

InnerDepth least(std::initializer_list<InnerDepth> sides) {
  return *std::min_element(sides.begin(), sides.end(),
                           [](const InnerDepth& a, const InnerDepth& b) { return a.depth < b.depth; });
}

/// Returns the depth below the nearer of the two flat ends of a shape. @param half  [m] half of its height
InnerDepth belowEnds(const Vector& point, double half) {
  return {half - std::abs(point.z()), std::copysign(1.0, point.z()) * Vector::UnitZ()};
}

InnerDepth inBox(const Vector& half, const Vector& point) {
  InnerDepth result{half[0] - std::abs(point[0]), std::copysign(1.0, point[0]) * Vector::UnitX()};
  for (int axis = 1; axis < 3; ++axis) {
    const double depth = half[axis] - std::abs(point[axis]);
    if (depth < result.depth) result = {depth, std::copysign(1.0, point[axis]) * Vector::Unit(axis)};
  }
  return result;
}

InnerDepth inCone(double height, double radius, const Vector& point) {
  const Vector around(point.x(), point.y(), 0.0);
  const double slant = std::sqrt(height * height + radius * radius);
  const Vector outward = (height * directionOf(around) + radius * Vector::UnitZ()) / slant;
  const double below_side = ((0.5 * height - point.z()) * radius - around.norm() * height) / slant;
  return least({{below_side, outward}, {point.z() + 0.5 * height, -Vector::UnitZ()}});
}

InnerDepth depthIn(const Shape& shape, const Vector& point) {
  const std::vector<double> size = shape.dimensions();
  const Vector around(point.x(), point.y(), 0.0);
  switch (shape.kind()) {
    case ShapeKind::sphere:
      return {size[0] - point.norm(), directionOf(point)};
    case ShapeKind::box:
      return inBox(0.5 * Vector(size[0], size[1], size[2]), point);
    case ShapeKind::cylinder:
      return least({{size[1] - around.norm(), directionOf(around)}, belowEnds(point, 0.5 * size[0])});
    case ShapeKind::cone:
      return inCone(size[0], size[1], point);
    default: {  // a capsule
      const double half = 0.5 * size[0];
      const Vector from_axis = point - std::max(-half, std::min(point.z(), half)) * Vector::UnitZ();
      return {size[1] - from_axis.norm(), directionOf(from_axis)};
    }
  }
}

}  // namespace

std::optional<InnerDepth> depthInside(const Shape& shape, const Vector& point) {
  if (shape.kind() > ShapeKind::capsule) return std::nullopt;
  InnerDepth result = depthIn(shape, point);
  result.depth = std::max(0.0, result.depth);
  return result;
}

}  // namespace hgrid
