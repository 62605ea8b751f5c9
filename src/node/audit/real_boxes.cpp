// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/audit/real_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hgrid {
namespace {

constexpr double kSinglePrecision = 1e-6;  // more than the relative rounding error of a box in single precision

/// Returns the support function of a shape [m]: the largest component of a point of the shape along a unit vector, in
/// the frame of the shape.
double reachAlong(const Shape& shape, const Eigen::Vector3d& direction) {
  const std::vector<double> d = shape.dimensions();
  const double across = std::hypot(direction.x(), direction.y());  // part of it that is perpendicular to the axis
  switch (shape.kind()) {
    case ShapeKind::sphere:
      return d[0];
    case ShapeKind::box:
      return 0.5 * (d[0] * std::abs(direction.x()) + d[1] * std::abs(direction.y()) + d[2] * std::abs(direction.z()));
    case ShapeKind::cylinder:
      return 0.5 * d[0] * std::abs(direction.z()) + d[1] * across;
    case ShapeKind::cone:
      return std::max(0.5 * d[0] * direction.z(), -0.5 * d[0] * direction.z() + d[1] * across);
    case ShapeKind::capsule:
      return 0.5 * d[0] * std::abs(direction.z()) + d[1];
    case ShapeKind::hull:
    case ShapeKind::mesh:
    case ShapeKind::plane:  // realBoxesOf() does not ask
      break;
  }
  double reach = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& vertex : shape.mesh()->vertices) reach = std::max(reach, vertex.dot(direction));
  return reach;
}

/// Returns the distance of a segment from a box, by ternary search along the segment. The search finds the minimum,
/// because the distance from a point of the segment to the box is a convex function of the place of the point.
double distanceOf(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  double low = 0.0, high = 1.0;
  const auto at = [&](double part) { return box.exteriorDistance(Eigen::Vector3d(from + part * (to - from))); };
  for (int step = 0; step < 100; ++step) {
    const double first = low + (high - low) / 3.0, second = high - (high - low) / 3.0;
    (at(first) <= at(second) ? high : low) = at(first) <= at(second) ? second : first;
  }
  return std::min({at(low), at(0.0), at(1.0)});
}

using Plane = Eigen::Hyperplane<double, 3, Eigen::DontAlign>;

/// Returns the distance of a box from the solid side of a plane: that of its lowest corner.
double distanceOf(const Plane& plane, const Eigen::AlignedBox3d& box) {
  double least = std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    least = std::min(least, plane.signedDistance(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner))));
  }
  return std::max(0.0, least);
}

}  // namespace

RealBoxes realBoxesOf(const Body& body, const Pose& world_from_body) {
  RealBoxes result;
  for (const BodyShape& shape : body.shapes) {
    const Pose world_from_shape = world_from_body * shape.body_from_shape;
    if (shape.shape.kind() == ShapeKind::plane) {
      const Eigen::Vector3d out = world_from_shape.linear() * Eigen::Vector3d::UnitZ();
      result.planes.emplace_back(out, Eigen::Vector3d(world_from_shape.translation() + shape.padding * out));
      continue;
    }
    Eigen::AlignedBox3d box;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d direction = world_from_shape.linear().row(axis).transpose();
      const double center = world_from_shape.translation()[axis];
      box.max()[axis] = center + reachAlong(shape.shape, direction) + shape.padding;
      box.min()[axis] = center - reachAlong(shape.shape, -direction) - shape.padding;
    }
    result.shapes.push_back(box);
    result.all.extend(box);
  }
  return result;
}

double RealBoxes::gapTo(const RealBoxes& other) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::AlignedBox3d& mine : shapes) {
    for (const Eigen::AlignedBox3d& theirs : other.shapes) least = std::min(least, mine.exteriorDistance(theirs));
    for (const Plane& plane : other.planes) least = std::min(least, distanceOf(plane, mine));
  }
  for (const Plane& plane : planes) {
    for (const Eigen::AlignedBox3d& theirs : other.shapes) least = std::min(least, distanceOf(plane, theirs));
  }
  return least;
}

double RealBoxes::distanceTo(const Eigen::Vector3d& point) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::AlignedBox3d& box : shapes) least = std::min(least, box.exteriorDistance(point));
  for (const Plane& plane : planes) least = std::min(least, std::max(0.0, plane.signedDistance(point)));
  return least;
}

double RealBoxes::distanceTo(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::AlignedBox3d& box : shapes) least = std::min(least, distanceOf(box, from, to));
  for (const Plane& plane : planes) {
    for (const Eigen::Vector3d& end : {from, to}) {
      least = std::min(least, std::max(0.0, plane.signedDistance(end)));
    }
  }
  return least;
}

double distanceTo(const RecordedCells& cells, const Eigen::Vector3d& point) {
  double least = std::numeric_limits<double>::infinity();
  for (const Voxel& voxel : cells.voxels) {
    const double edge = std::ldexp(cells.finest_edge, voxel.level);
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const int key = axis == 0 ? voxel.x : axis == 1 ? voxel.y : voxel.z;
      const double low = cells.finest_edge * (key - 32768);
      const double off = std::max({low - point[axis], point[axis] - low - edge, 0.0});
      sum += off * off;
    }
    least = std::min(least, sum);
  }
  return std::sqrt(least);
}

double roundingOf(const AuditCase& audited, const RealBoxes& boxes) {
  if (boxes.shapes.empty()) return kPoseSlack;
  const double largest = std::max(boxes.all.min().cwiseAbs().maxCoeff(), boxes.all.max().cwiseAbs().maxCoeff());
  return kPoseSlack + kSinglePrecision * (largest + audited.origin_distance);
}

}  // namespace hgrid
