// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>

#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/geometry/pose.h"

namespace hgrid {

/// Where a body is in a snapshot, and how far that can be trusted.
struct BodyPose {
  Pose world_from_body = Pose::Identity();  ///< meaningless while the state is unplaced
  Time stamp{0};                            ///< of the pose; of a fixed body: when it was put there
  Freshness state = Freshness::unplaced;
  double age = 0.0;  ///< [s] of the pose when the snapshot was made; 0 if the body is fixed
  /// [m] Most that a point of a stale body may have moved since the pose: max_speed * age.
  double reach = 0.0;
  double growth = 0.0;       ///< [m] by which the body's margins are widened: the reach, but at most a cap
  std::uint32_t cohort = 0;  ///< links of one robot with equal numbers (not 0) have poses of the same age
};

}  // namespace hgrid
