// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "geometry/rounding.h"
#include "hgrid_proximity/geometry/aabb.h"
#include "hgrid_proximity/geometry/segment.h"
#include "hgrid_proximity/geometry/sphere.h"

namespace hgrid {
namespace book {

/// Bound of the rounding errors of a fraction of a segment, and of a square relative to itself.
constexpr double kFractionRounding = 1e-12;

/// The shape of a query: a box, a sphere or a swept segment. A partition asks it which cells and nodes to visit.
///
/// The answers about regions are approximate in one direction only. They may include a region that the shape misses by
/// a little, but they never leave out a region that the shape touches.
class QueryShape {
 public:
  enum class Kind { box, sphere, segment };

  explicit QueryShape(const Aabb& box);
  explicit QueryShape(const Sphere& sphere);
  explicit QueryShape(const Segment& segment);

  Kind kind() const { return kind_; }
  /// A box around the shape [m]. Its coordinates are infinite where the shape exceeds the range of float.
  const Aabb& bounds() const { return bounds_; }
  /// Radius of a sphere or of a swept segment [m], plus an allowance for rounding. 0 for a box.
  double radiusWithSlack() const { return radius_with_slack_; }
  const Segment& segment() const { return segment_; }
  const Sphere& sphere() const { return sphere_; }

  /// The axis along which a segment is longest. A grid cuts a segment into slices along this axis.
  int longAxis() const;
  /// Returns a box around the part of the shape whose coordinate on the axis is within low .. high [m]. The box may be
  /// larger than needed. If there is no such part, the box may also be empty (min > max).
  Aabb slice(int axis, double low, double high) const;
  /// Whether the shape may touch the region. Never false if it does touch.
  bool mayTouch(const Aabb& region) const;

 private:
  Kind kind_;
  Aabb bounds_;
  Sphere sphere_;
  Segment segment_;
  double radius_with_slack_ = 0.0;
  Eigen::Vector3d step_ = Eigen::Vector3d::Zero();  // [m] from the start of a segment to its end
};

}  // namespace book
}  // namespace hgrid
