// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "hgrid_proximity/geometry/shape.h"

namespace hgrid {
namespace test {

/// The witness of distances computes in extended precision: 19 digits on a PC.
using Real = long double;
using Vector3r = Eigen::Matrix<Real, 3, 1>;

/// A convex set in the world: the hull of a few discs (a point is a disc of radius 0) that all face one way, and
/// everything within `radius` of it. Ball, capsule, box, cylinder, cone, hull and triangle are all of this kind.
class Convex {
 public:
  /// @throws std::invalid_argument for a mesh, which is not convex
  Convex(const Shape& shape, const Pose& world_from_shape, double padding);
  /// A triangle given in a frame of its own.
  Convex(const std::array<Eigen::Vector3d, 3>& corners, const Pose& world_from_corners, double padding);
  explicit Convex(const Eigen::Vector3d& point);

  /// A point of the core, without the radius, that lies farthest along `direction`.
  Vector3r support(const Vector3r& direction) const;

  Real radius() const { return radius_; }             ///< [m] around the core
  const Vector3r& center() const { return center_; }  ///< of a ball around the core
  Real reach() const { return reach_; }               ///< [m] of that ball

 private:
  struct Disc {
    Vector3r center;
    Real radius;
  };
  void add(const Pose& world_from_shape, const Vector3r& center, Real radius = 0);
  void findBall();

  std::vector<Disc> discs_;
  Vector3r x_ = Vector3r::UnitX(), y_ = Vector3r::UnitY();  // of the plane of the discs
  Real radius_ = 0;
  Vector3r center_ = Vector3r::Zero();
  Real reach_ = 0;
};

}  // namespace test
}  // namespace hgrid
