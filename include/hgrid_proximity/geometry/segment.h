// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>

#include "hgrid_proximity/geometry/aabb.h"

namespace hgrid {

/// The volume that a sphere of `radius` sweeps as its center moves along a segment [m]. It is given in the same
/// coordinates as the boxes that it is compared with. With radius 0 it is a line; with equal ends it is a sphere.
struct Segment {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

/// How a segment meets a box.
struct Meeting {
  double along = 0.0;          ///< [m] from the segment's start to where its sphere first touches the box
  double axis_distance = 0.0;  ///< [m] least distance of the segment's axis from the box; 0: it meets the box
  Eigen::Vector3d point;       ///< [m] point of the box nearest to the axis
};

/// How the segment first touches the box, or nullopt if it does not.
///
/// Finds every box that the segment touches, and perhaps one that it misses by less than 1e-9 * (|x| + r). The squared
/// distance from a point that moves along the axis to a box is a convex, piecewise quadratic function of the fraction
/// of the axis. Its pieces meet where the point crosses the plane of a face, six times at most. Each piece is solved in
/// closed form.
std::optional<Meeting> meet(const Segment& segment, const Aabb& box);

/// Computes only Meeting::along, faster than meet() and equal to it within rounding. Use it for many boxes: it computes
/// once what they share. A segment without radius that clearly enters a box is clipped by the box's slabs (Ericson
/// 2005, section 5.3.3).
class FirstTouch {
 public:
  /// @param segment  must outlive this
  explicit FirstTouch(const Segment& segment);
  /// [m] from the segment's start, or nullopt if it does not touch the box.
  std::optional<double> operator()(const Aabb& box) const;

 private:
  const Segment& segment_;
  bool clips_;  // the segment has no radius, and on each axis a length that divides without overflow
  double length_;
  Eigen::Vector3d inverse_, rounded_;  // per axis: 1 / step, and the rounding of a fraction
};

}  // namespace hgrid
