// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "geometry/rounding.h"
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
  Eigen::Vector3d support(const Eigen::Vector3d& direction) const { return supportIn<double>(direction); }
  /// Returns the same point with more digits. @tparam Real  double or DoubleDouble
  template <class Real>
  Eigen::Matrix<Real, 3, 1> supportIn(const Eigen::Matrix<Real, 3, 1>& direction) const;
  /// Returns an upper bound [m] of the distance from the origin to the points of the set.
  double reach() const { return reach_; }
  /// Whether it is a point, a segment or a box: among few faces, a search with more digits takes few steps.
  bool isBox() const { return kind_ == Kind::box; }

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
  double upper = std::numeric_limits<double>::infinity();  ///< distance of the points: proved upper bound, but rounded
  Eigen::Vector3d on_first = Eigen::Vector3d::Zero(), on_second = Eigen::Vector3d::Zero();
  /// Unit vector from the first point to the second; 0 if it is not known to 1e-6 rad and gapRounding() / upper.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  /// Unit vector along which the cores are apart by `lower`. If the bounds are equal, it is the normal.
  Eigen::Vector3d apart_along = Eigen::Vector3d::Zero();
};

/// Limits of a search for the gap of two cores [m].
struct GapLimits {
  double touch = 0.0;   ///< the caller wants to know whether the gap is larger than this
  double enough = 0.0;  ///< the search also ends once the gap is proved to be larger than this
  /// Whether CoreGap::normal must be accurate if the gap is larger than `touch`. Among parts of a mesh, only that of
  /// the nearest part matters.
  bool needs_normal = true;
};

/// Computes lower and upper bounds of the distance of two convex cores (Gilbert, Johnson, Keerthi 1988; Ericson 2005,
/// section 9.5).
///
/// It ends when the bounds differ by at most 1e-10 m, or by twice gapRounding() of the sum of the reaches of the cores
/// and of their distance if that is more, and when they say
/// whether the gap is larger than `touch`. Where doubles do not suffice for this, it goes on with numbers of twice as
/// many digits. A gap that then still may be `touch` is within gapRounding() of it. The normal is accurate to 1e-6
/// rad, or 0. FCL's solvers end when the distance no longer shrinks, which can be centimeters too early.
CoreGap gapOf(const ConvexCore& first, const ConvexCore& second, const Pose& first_from_second,
              const GapLimits& limits);

}  // namespace hgrid
