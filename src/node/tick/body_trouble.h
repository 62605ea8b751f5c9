// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "hgrid_proximity/refusal.h"
#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// Describes a body whose pose is not FRESH, or whose chain of transforms has a conflict.
struct BodyTrouble {
  std::string name, frame;
  Freshness state;
  double age;  ///< [s] age of the pose; NaN if the body never had a pose
  Time stamp;  ///< [ROS time] stamp of the pose
  Code code;
  std::string sentence;
};

}  // namespace hgrid
