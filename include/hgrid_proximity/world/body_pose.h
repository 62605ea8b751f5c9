// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>

#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/geometry/pose.h"

namespace hgrid {

/// The pose of a body in a snapshot, and how far this pose can be trusted.
struct BodyPose {
  Pose world_from_body = Pose::Identity();  ///< meaningless while the state is unplaced
  Time stamp{0};                            ///< stamp of the pose; for a fixed body: when it was last placed
  Freshness state = Freshness::unplaced;    ///< how far the pose can be trusted
  double age = 0.0;                         ///< [s] age of the pose when the snapshot was made; 0 if the body is fixed
  /// [m] Largest distance that a point of the body may have moved since the pose: max_speed * age. 0 for a new pose.
  double reach = 0.0;
  double period = 0.0;  ///< [s] usual time between two poses of its source; 0: not known, or the body is fixed
  /// [m] How much the margins of its pairs grow: `reach`, at most growth_cap. If poses of its source are old before the
  /// next one comes, the growth is at least the reach after one period, so that its pairs do not come and go.
  double growth = 0.0;
  std::uint32_t cohort = 0;  ///< links of one robot with the same cohort (not 0) have poses of the same age
};

}  // namespace hgrid
