// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "hgrid_proximity/geometry/pose.h"
#include "hgrid_proximity/geometry/shape.h"

namespace hgrid {

/// A convex set in its own frame, told by its farthest point in any direction: a point, a segment along z, a box, a
/// cylinder, a cone (tip at +z), or the hull of some points. Round shapes are such a core and a radius around it.
class ConvexCore {
 public:
  static ConvexCore point() { return ConvexCore(Kind::box, Eigen::Vector3d::Zero()); }
  static ConvexCore segment(double length) { return ConvexCore(Kind::box, {0.0, 0.0, 0.5 * length}); }
  static ConvexCore box(const Eigen::Vector3d& size) { return ConvexCore(Kind::box, 0.5 * size); }
  static ConvexCore cylinder(double height, double radius) {
    return ConvexCore(Kind::cylinder, {radius, radius, 0.5 * height});
  }
  static ConvexCore cone(double height, double radius) {
    return ConvexCore(Kind::cone, {radius, radius, 0.5 * height});
  }
  /// @param points  at least one; must live as long as the core
  static ConvexCore hull(const Eigen::Vector3d* points, std::size_t count);

  /// A point of the set that lies farthest along the direction.
  Eigen::Vector3d support(const Eigen::Vector3d& direction) const;
  /// [m] of the set from its frame's origin, at least.
  double reach() const { return reach_; }

 private:
  enum class Kind { box, cylinder, cone, hull };
  ConvexCore(Kind kind, const Eigen::Vector3d& half) : kind_(kind), half_(half), reach_(half.norm()) {}

  Kind kind_;
  Eigen::Vector3d half_;  // lengths
  double reach_;
  const Eigen::Vector3d* points_ = nullptr;
  std::size_t count_ = 0;
};

/// How far two cores are apart, in the first one's frame [m].
struct CoreGap {
  double lower = 0.0;                                      ///< proved: they are not nearer; 0: they may meet
  double upper = std::numeric_limits<double>::infinity();  ///< proved: the distance of the two points
  Eigen::Vector3d on_first = Eigen::Vector3d::Zero(), on_second = Eigen::Vector3d::Zero();
};

/// The distance of two convex cores (Gilbert, Johnson, Keerthi 1988; Ericson 2005, section 9.5), with a proof of it: it
/// ends when the bounds are within 1e-10 m or what doubles give. FCL's solvers end when the distance shrinks no more,
/// which can be centimetres too early.
/// @param enough  [m] ends too as soon as the distance is proved to be more
CoreGap gapOf(const ConvexCore& first, const ConvexCore& second, const Pose& first_from_second, double enough);

}  // namespace hgrid
