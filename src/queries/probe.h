// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cmath>
#include <memory>
#include <string>

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// @throws Refusal nonfinite, out_of_range: naming `what` and the value
void checkQueryPoint(const Eigen::Vector3d& point, const std::string& what);
/// @throws Refusal bad_geometry, out_of_range
void checkQueryLength(double length, const std::string& what);

/// [m] What rounding may take from a distance at such coordinates: a question that touches within it hits.
inline double touchSlack(const Eigen::Vector3d& at, double radius) { return 1e-9 * (at.norm() + radius); }

/// A question's core somewhere in the world, to be measured against shapes.
struct Snapshot::Probe {
  const NarrowPhase& narrow_phase;
  std::shared_ptr<const Solid> core;
  Pose world_from_core;
  double padding = 0.0;  // [m]

  /// From the core to a shape of a body of the snapshot; `not_measured` if the shape has no solid.
  Proximity measure(const Snapshot& snapshot, std::uint32_t body, std::uint32_t shape, double up_to) const {
    const BodyShape& what = snapshot.structure().bodies[body].shapes[shape];
    if (!what.solid) return {};
    const Pose world_from_shape = snapshot.poses()[body].world_from_body * what.body_from_shape;
    return narrow_phase.measure({*core, world_from_core, padding}, {*what.solid, world_from_shape, what.padding},
                                up_to);
  }
};

}  // namespace hgrid
