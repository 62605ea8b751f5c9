// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hgrid_proximity/bodies/self_pairs.h"
#include "node/params/params.h"
#include "node/sources/robot_source.h"

namespace hgrid {

/// What the robots' descriptions lack, and what their models switch off. It changes only when a robot is loaded.
struct ModelReport {
  std::vector<std::string> uncovered, waived, without_collision, uses_visual, warnings;
  std::vector<std::pair<std::string, SelfPairs>> self_pairs;  ///< by robot
  std::size_t robots = 0;
};

/// The robots in the world, by name. They are shared, so that a copy of the map is cheap.
using RobotsByName = std::map<std::string, std::shared_ptr<const LoadedRobot>>;

/// Reports on these robots. Once all configured robots are loaded, the report also warns of idle patterns.
std::shared_ptr<const ModelReport> makeModelReport(const RobotsByName& robots, const Params& params);

}  // namespace hgrid
