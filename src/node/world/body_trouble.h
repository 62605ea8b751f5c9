// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/refusal.h"
#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

struct Mover;

/// Describes a body whose pose is not FRESH, or whose chain of transforms has a conflict.
struct BodyTrouble {
  std::string name, frame;
  Freshness state;
  double age;  ///< [s] age of the pose; NaN if the body never had a pose
  Time stamp;  ///< [ROS time] stamp of the pose
  Code code;
  std::string sentence;
};

/// Describes what is wrong with a body of a mover. Call this only if its pose is not FRESH or the mover has a conflict.
BodyTrouble troubleOf(const Body& body, const BodyPose& pose, const Mover& mover, const std::string& world_frame);

/// Sorts by state, worst first. Troubles with the same state keep their order.
void sortWorstFirst(std::vector<BodyTrouble>& troubles);

}  // namespace hgrid
