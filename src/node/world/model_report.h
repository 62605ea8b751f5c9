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

/// What is missing in the robots' descriptions, and which pairs their models switch off. Changes only when a robot is
/// loaded.
struct ModelReport {
  std::vector<std::string> uncovered, waived, without_collision, uses_visual, warnings;
  std::vector<std::pair<std::string, SelfPairs>> self_pairs;  ///< name of each robot, and the pairs of its own links
  std::size_t robots = 0;
};

/// The robots in the world, by name. The pointers are shared, so that copying this container is cheap.
using RobotsByName = std::map<std::string, std::shared_ptr<const LoadedRobot>>;

/// Returns the report on these robots. Once all configured robots are loaded, it also warns about patterns that match
/// no name.
std::shared_ptr<const ModelReport> makeModelReport(const RobotsByName& robots, const Params& params);

}  // namespace hgrid
