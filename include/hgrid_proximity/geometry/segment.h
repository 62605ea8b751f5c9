// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>

#include "hgrid_proximity/geometry/aabb.h"

namespace hgrid {

/// The volume that a sphere of radius `radius` sweeps while its center moves along a line segment [m].
///
/// Its coordinates are relative to the same frame as the boxes that it is compared with. With radius 0 it is a line
/// segment. If both ends are equal, it is a sphere.
struct Segment {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< [m] where the center of the sphere starts
  Eigen::Vector3d to = Eigen::Vector3d::Zero();    ///< [m] where the center of the sphere ends
  double radius = 0.0;                             ///< [m] >= 0
};

/// How a swept segment touches a box.
struct Meeting {
  double along = 0.0;          ///< [m] how far the sphere moves from the start until it touches the box
  double axis_distance = 0.0;  ///< [m] smallest distance from the segment's axis to the box; 0: the axis meets it
  Eigen::Vector3d point;       ///< [m] point of the box that is nearest to the axis
};

/// Returns where the segment first touches the box, or nullopt if it does not touch the box.
///
/// A box that the segment touches is never missed. A box that the segment misses by less than 1e-9 * (|x| + r) may
/// count as touched, where |x| is the largest coordinate and r the radius.
///
/// Method: consider a point that moves along the axis. Its squared distance to the box is a convex, piecewise quadratic
/// function of the fraction of the axis. A new piece begins where the point crosses the plane of a face. This happens
/// at most six times. Each piece is solved in closed form.
std::optional<Meeting> meet(const Segment& segment, const Aabb& box);

/// Computes only Meeting::along. It is faster than meet(), and the results differ only by rounding.
///
/// Use one object for many boxes: the constructor computes the values that do not depend on the box. A segment with
/// radius 0 that clearly enters a box is clipped by the slabs of the box (Ericson, Real-Time Collision Detection, 2005,
/// section 5.3.3).
class FirstTouch {
 public:
  /// @param segment  must outlive this object
  /// @param error    [m] bound of the error of the segment; a box that the segment misses by less counts as touched
  explicit FirstTouch(const Segment& segment, double error = 0.0);
  /// Returns the distance [m] along the segment to its first contact with the box, or nullopt if there is no contact.
  std::optional<double> operator()(const Aabb& box) const;

 private:
  const Segment& segment_;
  double error_;
  // Whether clipping by slabs is allowed: the radius is 0, and 1 / step does not overflow on any axis where the segment
  // has a length.
  bool clips_;
  double length_;
  Eigen::Vector3d inverse_;  // 1 / step for each axis, where step is the vector from the start to the end
  Eigen::Vector3d rounded_;  // for each axis: bound of the rounding error of a fraction of the segment
};

}  // namespace hgrid
