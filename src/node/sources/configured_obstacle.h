// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/params/params.h"
#include "node/sources/obstacle_change.h"

namespace hgrid {

/// Returns an obstacle of ~obstacles or of a scene in the form of a request. This may take long if meshes are large.
std::shared_ptr<const RequestedObstacle> requestedOf(const ObstacleParams& configured, const Params& params,
                                                     NarrowPhase& narrow_phase);

/// Returns how the obstacle is attached; null if it is not.
std::shared_ptr<const Attachment> attachmentOf(const ObstacleParams& configured);

}  // namespace hgrid
