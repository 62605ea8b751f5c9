// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/refusal.h"
#include "hgrid_proximity/world/snapshot.h"
#include "node/messages/to_messages.h"

namespace hgrid {

/// Checks the stamp of a query. Only the newest snapshot is available, so the stamp must be 0 (now) or its stamp.
/// @throws Refusal extrapolation
inline void checkStamp(const ros::Time& stamp, const Snapshot& snapshot) {
  const ros::Time available = toRos(snapshot.stamp());
  if (stamp.isZero() || stamp == available) return;
  throw Refusal(Code::extrapolation, "the query asks for time " + text(stamp.toSec()) +
                                         " s; the node stores only the tick of " + text(available.toSec()) +
                                         " s; ask with this stamp, or with 0 for now");
}

}  // namespace hgrid
