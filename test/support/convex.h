// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "hgrid_proximity/geometry/shape.h"

namespace hgrid {
namespace test {

/// The distance oracle computes in extended precision: 19 digits on a PC.
using Real = long double;
using Vector3r = Eigen::Matrix<Real, 3, 1>;

/// A convex set in the world: a core, and all points within `radius` of the core. The core is the convex hull of a few
/// parallel discs; a disc of radius 0 is a point. This form can represent spheres, capsules, boxes, cylinders, cones,
/// hulls and triangles.
class Convex {
 public:
  /// @throws std::invalid_argument for a mesh, which is not convex
  Convex(const Shape& shape, const Pose& world_from_shape, double padding);
  /// Creates a triangle from its corners and the pose of their frame in the world.
  Convex(const std::array<Eigen::Vector3d, 3>& corners, const Pose& world_from_corners, double padding);
  explicit Convex(const Eigen::Vector3d& point);

  /// Returns a point of the core (without the radius) that lies farthest along `direction`.
  Vector3r support(const Vector3r& direction) const;

  Real radius() const { return radius_; }             ///< [m] radius by which the core is grown
  const Vector3r& center() const { return center_; }  ///< center of a sphere around the core
  Real reach() const { return reach_; }               ///< [m] radius of the sphere around the core

 private:
  struct Disc {
    Vector3r center;
    Real radius;
  };
  void add(const Pose& world_from_shape, const Vector3r& center, Real radius = 0);
  void findBall();

  std::vector<Disc> discs_;
  Vector3r x_ = Vector3r::UnitX(), y_ = Vector3r::UnitY();  // axes of the plane of the discs
  Real radius_ = 0;
  Vector3r center_ = Vector3r::Zero();
  Real reach_ = 0;
};

}  // namespace test
}  // namespace hgrid
