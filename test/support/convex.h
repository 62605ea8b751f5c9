// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "hgrid_proximity/geometry/shape.h"

#ifdef HGRID_ORACLE_128
#include <boost/multiprecision/eigen.hpp>
#include <boost/multiprecision/float128.hpp>
#endif

namespace hgrid {
namespace test {

/// The number type of the distance oracle. It has extended precision: 19 digits on a PC, or 34 with HGRID_ORACLE_128.
#ifdef HGRID_ORACLE_128
using Real = boost::multiprecision::float128;
#else
using Real = long double;
#endif
using Vector3r = Eigen::Matrix<Real, 3, 1>;

/// A convex set in the world frame: a core, and all points within `radius` of the core. The core is the convex hull of
/// a few parallel discs. A disc of radius 0 is a point. Spheres, capsules, boxes, cylinders, cones, hulls and triangles
/// can be written in this form.
class Convex {
 public:
  /// @throws std::invalid_argument for a mesh, which is not convex
  Convex(const Shape& shape, const Pose& world_from_shape, double padding);
  /// Creates a triangle. `corners` are in a frame whose pose in the world frame is `world_from_corners`.
  Convex(const std::array<Eigen::Vector3d, 3>& corners, const Pose& world_from_corners, double padding);
  explicit Convex(const Eigen::Vector3d& point);

  /// Returns the point of the core (without the radius) that is farthest along `direction`.
  Vector3r support(const Vector3r& direction) const;

  Real radius() const { return radius_; }             ///< [m] points this far from the core belong to the set
  const Vector3r& center() const { return center_; }  ///< center of a sphere that contains the core
  Real reach() const { return reach_; }               ///< [m] radius of the sphere around center()

 private:
  struct Disc {
    Vector3r center;
    Real radius;
  };
  void add(const Pose& world_from_shape, const Vector3r& center, Real radius = 0);
  void findBall();

  std::vector<Disc> discs_;
  Vector3r x_ = Vector3r::UnitX(), y_ = Vector3r::UnitY();  // orthonormal axes of the plane of each disc
  Real radius_ = 0;
  Vector3r center_ = Vector3r::Zero();
  Real reach_ = 0;
};

}  // namespace test
}  // namespace hgrid
