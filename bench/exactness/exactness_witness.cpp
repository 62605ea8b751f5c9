// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/exactness/exactness_witness.h"

#include <algorithm>

namespace hgrid {
namespace bench {

using test::Convex;
using test::Real;
using test::Vector3r;

ExactnessWitness::ExactnessWitness(const test::Case& placed, double size)
    : placed_(placed),
      resolution_(1e-15 * size),
      first_(placed.first_shape, placed.world_from_first, 0.0),
      second_(placed.second_shape, placed.world_from_second, 0.0),
      gap_(gapAfter(Eigen::Vector3d::Zero())) {}

test::Interval ExactnessWitness::distance() const {
  return {double(std::max<Real>(gap_.lower, 0)), double(std::max<Real>(gap_.upper, 0))};
}

ExactnessWitness::Gap ExactnessWitness::gapAfter(const Eigen::Vector3d& move) const {
  Pose moved = placed_.world_from_second;
  moved.translation() += move;
  const Convex second(placed_.second_shape, moved, 0.0);
  const test::CoreDistance cores = coreDistance(first_, second, 1e-3L * resolution_);
  const Real radii = first_.radius() + second.radius();
  return {cores.lower - radii, cores.upper - radii, cores.on_second - cores.on_first};
}

double ExactnessWitness::extentsAlong(const Eigen::Vector3d& normal) const {
  const Vector3r along = normal.cast<Real>();
  return double((first_.support(along) - second_.support(-along)).dot(along) + first_.radius() + second_.radius());
}

double ExactnessWitness::moveAlongAxes() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Pose* pose : {&placed_.world_from_first, &placed_.world_from_second}) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {-1.0, 1.0}) least = std::min(least, extentsAlong(sign * pose->linear().col(axis)));
    }
  }
  return std::max(least, 0.0);
}

/// Starts where the extents along the normal no longer overlap: a plane is between the shapes there. Then it moves the
/// second shape back, each time almost to the plane that the last search has found (ray casting of van den Bergen,
/// 2004).
double ExactnessWitness::separatingMove(const Eigen::Vector3d& normal, double from) const {
  if (gapAfter(from * normal).lower > 0) return from;
  double move = std::max(extentsAlong(normal), from);
  for (int step = 0; step < 50; ++step) {
    const Gap gap = gapAfter(move * normal);
    if (!(gap.lower > 2 * resolution_)) break;
    const Real slope = gap.first_to_second.dot(normal.cast<Real>()) / gap.first_to_second.norm();
    const double next = slope > 0 ? move - double((gap.lower - resolution_) / slope) : from;
    if (!(next < move)) break;
    move = gapAfter(std::max(next, from) * normal).lower > 0 ? std::max(next, from)
                                                             : move - double(gap.lower) + resolution_;
  }
  return move;
}

}  // namespace bench
}  // namespace hgrid
