// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "hgrid_proximity/geometry/pose.h"
#include "hgrid_proximity/geometry/shape.h"

namespace hgrid {

/// A convex set in its own frame: a point, a segment along z, a box, a cylinder, a cone (tip at +z), or the hull of
/// some points. Round shapes consist of such a core and a radius around it.
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
  /// @param points  [m] at least one point; the array must outlive the core
  static ConvexCore hull(const Eigen::Vector3d* points, std::size_t count);

  /// Returns a point of the set that is farthest in the given direction.
  Eigen::Vector3d support(const Eigen::Vector3d& direction) const;
  /// Returns an upper bound [m] of the distance from the origin to the points of the set.
  double reach() const { return reach_; }

 private:
  enum class Kind { box, cylinder, cone, hull };
  ConvexCore(Kind kind, const Eigen::Vector3d& half) : kind_(kind), half_(half), reach_(half.norm()) {}

  Kind kind_;
  Eigen::Vector3d half_;  // [m] half of the lengths; for cylinder and cone: radius, radius, half of the height
  double reach_;
  const Eigen::Vector3d* points_ = nullptr;
  std::size_t count_ = 0;
};

/// The gap of two cores and their nearest points [m], in the frame of the first core.
struct CoreGap {
  double lower = 0.0;  ///< proved lower bound of the distance; 0: the cores may meet
  double upper = std::numeric_limits<double>::infinity();  ///< proved upper bound: distance of the points
  Eigen::Vector3d on_first = Eigen::Vector3d::Zero(), on_second = Eigen::Vector3d::Zero();
};

/// Computes lower and upper bounds of the distance of two convex cores (Gilbert, Johnson, Keerthi 1988; Ericson 2005,
/// section 9.5).
///
/// It ends when the bounds differ by at most 1e-10 m, or by the precision of doubles. FCL's solvers end when the
/// distance no longer shrinks, which can be centimeters too early.
/// @param enough  [m] the search also ends once the distance is proved to be larger than this
CoreGap gapOf(const ConvexCore& first, const ConvexCore& second, const Pose& first_from_second, double enough);

}  // namespace hgrid
