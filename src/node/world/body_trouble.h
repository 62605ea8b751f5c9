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

/// A body whose pose is not fresh or whose data are not as they should be.
struct BodyTrouble {
  std::string name, frame;
  Freshness state;
  double age;  ///< [s] NaN if it never had a pose
  Time stamp;
  Code code;
  std::string sentence;
};

/// Describes what is wrong with a body of a mover, which is not fresh or whose chain of transforms has a conflict.
BodyTrouble troubleOf(const Body& body, const BodyPose& pose, const Mover& mover, const std::string& world_frame);

/// Puts the worst state first. Troubles of the same state keep their order.
void sortWorstFirst(std::vector<BodyTrouble>& troubles);

}  // namespace hgrid
