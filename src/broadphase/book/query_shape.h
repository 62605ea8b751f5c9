// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/geometry/aabb.h"
#include "hgrid_proximity/geometry/segment.h"
#include "hgrid_proximity/geometry/sphere.h"

namespace hgrid {
namespace book {

/// The shape of a query: a box, a sphere or a swept segment. A partition asks it which cells and nodes to visit.
///
/// All answers about regions err on one side only: a region that the shape touches is never left out.
class QueryShape {
 public:
  enum class Kind { box, sphere, segment };

  explicit QueryShape(const Aabb& box);
  explicit QueryShape(const Sphere& sphere);
  explicit QueryShape(const Segment& segment);

  Kind kind() const { return kind_; }
  /// A box around the shape [m]. Its coordinates may be infinite.
  const Aabb& bounds() const { return bounds_; }
  /// Half of the thickness of a swept segment [m], with an allowance for rounding.
  double radiusWithSlack() const { return radius_with_slack_; }
  const Segment& segment() const { return segment_; }
  const Sphere& sphere() const { return sphere_; }

  /// The axis along which a segment is longest; the shape should be cut into slices along this axis.
  int longAxis() const;
  /// A box around the part of the shape whose coordinate on the axis is within low .. high [m]. It is empty (min > max)
  /// if there is no such part.
  Aabb slice(int axis, double low, double high) const;
  /// Whether the shape may touch the region. Never false if it does touch.
  bool mayTouch(const Aabb& region) const;

 private:
  Kind kind_;
  Aabb bounds_;
  Sphere sphere_;
  Segment segment_;
  double radius_with_slack_ = 0.0;
  Eigen::Vector3d step_ = Eigen::Vector3d::Zero();
};

}  // namespace book
}  // namespace hgrid
