// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bodies/motion_bound.h"

#include <algorithm>

#include "geometry/rounding.h"

namespace hgrid {

double reachOf(const Body& body) {
  double reach = 0.0;
  for (const BodyShape& shape : body.shapes) {
    reach = std::max(reach, shape.body_from_shape.translation().norm() + shape.shape.reach() + shape.padding);
  }
  return reach;
}

double relativeMotion(const Pose& world_from_first, const Pose& world_from_second, const Pose& world_from_first_now,
                      const Pose& world_from_second_now, double reach) {
  const Pose before = world_from_first.inverse() * world_from_second;
  const Pose now = world_from_first_now.inverse() * world_from_second_now;
  // Two rotations move a unit vector to two points. The distance of these points is at most the norm of the difference
  // of the two rotation matrices. The rounding error is the error of coordinates in the world frame.
  const double rounding = gapRounding(world_from_first_now.translation().norm() +
                                      world_from_second_now.translation().norm() + now.translation().norm() + reach);
  return (now.translation() - before.translation()).norm() + (now.linear() - before.linear()).norm() * reach + rounding;
}

}  // namespace hgrid
