// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "hgrid_proximity/world/snapshot.h"
#include "narrow/measured_contact.h"

namespace hgrid {

/// A solid at a pose in the world, to be measured against the shapes of a snapshot.
struct Probe {
  const NarrowPhase& narrow_phase;
  const Solid& solid;
  Pose world_from_solid;
  double padding = 0.0;  // [m] how much the solid is grown
  bool describes =
      false;  // whether results of solids that overlap have depth, normal and points, see describeOverlap()

  /// Measures this solid against the shape of a proxy. This solid is the first of the two in the result. Returns
  /// Measure::not_measured if the shape of the proxy has no solid.
  /// @param up_to  [m] as in NarrowPhase::measure()
  Proximity measure(const Snapshot& snapshot, ProxyId proxy, double up_to) const {
    const std::uint32_t body = snapshot.structure().body_of_proxy[proxy];
    const BodyShape& shape = snapshot.structure().bodies[body].shapes[snapshot.structure().shapeOf(proxy)];
    if (!shape.solid) return {};
    const Pose world_from_shape = snapshot.poses()[body].world_from_body * shape.body_from_shape;
    return measure(*shape.solid, world_from_shape, shape.padding, up_to);
  }
  /// Measures this solid against another solid. This solid is the first of the two in the result.
  Proximity measure(const Solid& other, const Pose& world_from_other, double other_padding, double up_to) const {
    const PlacedSolid first{solid, world_from_solid, padding}, second{other, world_from_other, other_padding};
    Proximity found = narrow_phase.measure(first, second, up_to);
    if (describes) describeOverlap(narrow_phase, first, second, found);
    return found;
  }
};

}  // namespace hgrid
