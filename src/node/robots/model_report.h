// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hgrid_proximity/bodies/self_pairs.h"
#include "node/params/params.h"
#include "node/robots/robot_entry.h"

namespace hgrid {

/// Which robots the world should have, what is missing in their descriptions, and which pairs their models switch off.
/// Changes only when a robot is loaded, joins or leaves.
struct ModelReport {
  std::vector<std::string> uncovered, waived, without_collision, uses_visual, warnings;
  std::vector<std::pair<std::string, SelfPairs>> self_pairs;  ///< name of each robot, and the pairs of its own links
  std::vector<std::string> expected;  ///< names of the robots that the world should have, loaded or not, sorted
  std::vector<std::string> absent;    ///< names of the robots that were declared absent, sorted
  std::size_t robots = 0;             ///< number of robots that are in the world
};

/// Appends to `report` what is missing in the description of a robot, and which pairs its model switches off.
void addToReport(const LoadedRobot& robot, ModelReport& report);

/// Returns the report on these robots. Once all of them are loaded, also the absent ones, it also warns about patterns
/// that match no name.
std::shared_ptr<const ModelReport> makeModelReport(const RobotEntries& robots, const Params& params);

}  // namespace hgrid
