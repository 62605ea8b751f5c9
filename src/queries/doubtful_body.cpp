// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/doubtful_body.h"

#include "hgrid_proximity/queries/query.h"
#include "hgrid_proximity/refusal.h"
#include "world/body_gap.h"

namespace hgrid {

bool canBeAnywhere(const Body& body, const BodyPose& pose) {
  if (!body.covered && !body.waived) return true;
  // FROZEN: the clock stands still, so the age of the pose is unknown. INVALID: newer data was refused, or several
  // publishers contradict each other.
  if (pose.state == Freshness::frozen || pose.state == Freshness::invalid) return true;
  if (body.kind == BodyKind::cloud && pose.state >= Freshness::lost) return true;  // its cells have expired
  return pose.state == Freshness::unplaced || !(pose.reach <= kQueryReach);
}

std::string doubtOf(const Body& body, const BodyPose& pose) {
  std::string gap = gapLeftBy(body, pose);
  if (canBeAnywhere(body, pose) && !gap.empty()) return gap;
  return (gap.empty()
              ? std::string(name(pose.state)) + " " + body.name + ": its pose is " + secondsText(pose.age) + " old"
              : gap) +
         ", so it may have moved here since then";
}

}  // namespace hgrid
