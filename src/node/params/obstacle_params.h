// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <set>
#include <string>
#include <vector>

#include "node/params/param_value.h"
#include "node/params/params.h"

namespace hgrid {

/// Reads a pose {xyz: [m], rpy: [rad]}; both may be left out.
Pose readPose(ParamValue value);

/// Reads ~obstacles: a list of {name, frame, pose, shapes: [{type, ..., pose}]}. The frame of an obstacle that names
/// none stays empty: the world frame.
std::vector<ObstacleParams> readObstacles(ParamValue value, const ShapeLimits& limits);

/// Reads an element's required name, local to its source, which must differ from those before it.
void readLocalName(ParamValue& element, std::string& name, std::set<std::string>& names);

}  // namespace hgrid
