// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <set>
#include <string>
#include <vector>

#include "node/params/param_value.h"
#include "node/params/params.h"

namespace hgrid {

/// Reads a pose {xyz: [m], rpy: [rad]} or {xyz: [m], quaternion: [x, y, z, w]}. If one of them is left out, it is zero.
Pose readPose(ParamValue value);

/// Reads ~obstacles, a list of obstacles. If an entry has no frame, the frame of the obstacle is empty, which means the
/// world frame.
/// @param params  limits for the sizes of shapes and the number of triangles
std::vector<ObstacleParams> readObstacles(ParamValue value, const Params& params);

/// Reads a list of shapes {type, pose, padding, ...}. It must have at least one.
void readShapes(ParamValue value, const Params& params, std::vector<BodyShape>& shapes);

/// Reads ~allowed_pairs: a list of {first, second, reason, allowed}. Does not check the names.
std::vector<PairRule> readRules(ParamValue value);

/// Reads the required name of an element of a list. It is the name without its source.
/// @param names  the names of the earlier elements. The new name must differ from all of them and is added to them.
void readLocalName(ParamValue& element, std::string& name, std::set<std::string>& names);

}  // namespace hgrid
