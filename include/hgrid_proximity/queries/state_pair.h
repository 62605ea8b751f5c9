// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "hgrid_proximity/queries/query_answer.h"

namespace hgrid {

/// Two bodies in a state of the robot, and how they lie relative to each other.
struct StatePair {
  std::uint32_t first = 0;   ///< index into Structure::bodies: a link of the robot, or an obstacle attached to a link
  std::uint32_t second = 0;  ///< index into Structure::bodies: any body
  std::uint32_t first_shape = 0;   ///< index among the shapes of the first body
  std::uint32_t second_shape = 0;  ///< index among the shapes of the second body; 0 for a map or cloud
  /// What the narrow phase found. Points and normal are in the world frame. Measure::not_measured: the boxes of the two
  /// shapes overlap, and one of the shapes has no solid; this counts as contact. If contact was proved without the
  /// narrow phase, the status is Measure::contact also if one shape is inside the other, and points, normal and depth
  /// are NaN. That does not happen with StateRequest::all_pairs or a clearance.
  Proximity proximity;
  /// Only if it was requested (StateRequest::contacts, EdgeRequest::contacts) and the two are in contact; otherwise all
  /// values are NaN. The second shape is a cell if the second body is a map or cloud.
  Contact contact;
};

}  // namespace hgrid
