// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>

#include "hgrid_proximity/geometry/aabb.h"

namespace hgrid {

/// A segment [m] in the coordinates of the boxes that it is asked about, swept by a sphere of `radius`:
/// 0 is a thin ray, equal ends are a sphere.
struct Segment {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

/// How a segment meets a box.
struct Meeting {
  double along = 0.0;          ///< [m] from the segment's start to where its sphere first touches the box
  double axis_distance = 0.0;  ///< [m] least distance of the segment's axis from the box; 0: it goes through
  Eigen::Vector3d point;       ///< [m] point of the box nearest to the axis
};

/// How the segment first touches the box, or nullopt if it does not.
///
/// Superset of the exact answer; an extra lies within 1e-9 * (|x| + r) of touching. The squared distance
/// from a moving point to a box is a convex, piecewise quadratic function of the fraction of the segment; its at most
/// six breaks are where the point crosses a face's plane, and each piece is solved in closed form.
std::optional<Meeting> meet(const Segment& segment, const Aabb& box);

/// Meeting::along of meet(), within its rounding, without the rest and faster: a thin segment that plainly enters a box
/// is clipped by the box's slabs (Ericson 2005, section 5.3.3). For many boxes: what they share is computed once.
class FirstTouch {
 public:
  /// @param segment  must outlive this
  explicit FirstTouch(const Segment& segment);
  /// [m] from the segment's start, or nullopt if it does not touch the box.
  std::optional<double> operator()(const Aabb& box) const;

 private:
  const Segment& segment_;
  bool clips_;  // it is thin, and of sane length on every axis
  double length_;
  Eigen::Vector3d inverse_, rounded_;  // of the step on each axis; as a fraction of the segment
};

}  // namespace hgrid
