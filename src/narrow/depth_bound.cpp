// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/depth_bound.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <initializer_list>

#include "geometry/infinity.h"
#include "narrow/convex_solid.h"
#include "narrow/mesh_solid.h"

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;

constexpr int kMostTried = 72;       // upper limit of the number of tried directions
constexpr double kFirstTurn = 0.25;  // [rad] about the angle by which the best direction is turned first
constexpr double kParallel = 1e-6;   // sine of an angle; the cross product of axes with a smaller angle is not tried

const BoxTree& boxesOf(const OrderedSolid& solid) {
  return solid.kind() == ShapeKind::mesh ? static_cast<const MeshSolid&>(solid).tree().boxes()
                                         : static_cast<const ConvexSolid&>(solid).box();
}

/// Returns the axes of the box around a solid, one in each row.
Eigen::Matrix3d axesOf(const OrderedSolid& solid) {
  const BoxNode& node = boxesOf(solid).nodes.front();
  Eigen::Matrix3d axes;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      axes(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = static_cast<double>(node.axes[i][k][0]);
    }
  }
  return axes;
}

/// Returns a point of the core of a solid that is farthest in a direction.
Vector farthest(const OrderedSolid& solid, const Vector& direction) {
  return solid.kind() == ShapeKind::mesh ? static_cast<const MeshSolid&>(solid).tree().support(direction)
                                         : static_cast<const ConvexSolid&>(solid).core().support(direction);
}

/// Finds the direction in which the extents of two solids overlap least.
class LeastOverlap {
 public:
  LeastOverlap(const Side& a, const Side& b)
      : a_(a), b_(b), a_from_b_(a.world_from_shape.inverse() * b.world_from_shape) {}

  /// Tries a direction and the opposite direction. Directions that are almost 0 are left out.
  void offer(const Vector& direction) {
    const double length = direction.norm();
    if (!(length > kParallel)) return;
    offerUnit(direction / length);
    offerUnit(-direction / length);
  }

  void offerAxes() {
    const Eigen::Matrix3d of_a = axesOf(a_.solid), of_b = axesOf(b_.solid) * a_from_b_.linear().transpose();
    for (Eigen::Index i = 0; i < 3; ++i) {
      offer(of_a.row(i));
      offer(of_b.row(i));
      for (Eigen::Index k = 0; k < 3; ++k) offer(of_a.row(i).cross(of_b.row(k)));
      // The box around a mesh need not have the axes of the mesh, which most flat faces of machine parts follow.
      if (a_.solid.kind() == ShapeKind::mesh) offer(Vector::Unit(i));
      if (b_.solid.kind() == ShapeKind::mesh) offer(a_from_b_.linear().col(i));
    }
    offer(a_from_b_ * boxesOf(b_.solid).center - boxesOf(a_.solid).center);
  }

  /// Turns the best direction to four sides, by half of the angle if none of them is better.
  void turn() {
    for (double angle = kFirstTurn; tried_ + 4 <= kMostTried;) {
      const Vector from = best_, side = best_.unitOrthogonal(), other_side = best_.cross(side);
      for (const Vector& way : {side, Vector(-side), other_side, Vector(-other_side)}) {
        offerUnit((from + angle * way).normalized());
      }
      if (best_ == from) angle *= 0.5;
    }
  }

  const Vector& best() const { return best_; }
  double overlap() const { return overlap_; }

 private:
  void offerUnit(const Vector& direction) {
    ++tried_;
    const Vector on_a = farthest(a_.solid, direction);
    const Vector on_b = a_from_b_ * farthest(b_.solid, a_from_b_.linear().transpose() * -direction);
    const double overlap = direction.dot(on_a - on_b) + a_.around + b_.around;
    if (!(overlap < overlap_)) return;
    overlap_ = overlap;
    best_ = direction;
  }

  const Side &a_, &b_;
  const Pose a_from_b_;
  Vector best_ = Vector::UnitX();
  double overlap_ = kInfinity;
  int tried_ = 0;
};

}  // namespace

void boundDepth(const Side& a, const Side& b, Contact& contact) {
  LeastOverlap least(a, b);
  least.offerAxes();
  least.turn();
  contact.normal = least.best();
  contact.depth = std::max(0.0, least.overlap());
}

}  // namespace hgrid
