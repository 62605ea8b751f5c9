// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "node/params/params.h"
#include "node/robots/robot_change.h"
#include "node/robots/robot_entry.h"
#include "node/robots/robot_source.h"

namespace hgrid {

/// Reads descriptions, and reads equal ones only once. Use a new object for each request, because files may change.
class SharedReader {
 public:
  /// `source` must outlive this object.
  explicit SharedReader(const RobotSource& source) : source_(source) {}

  /// Returns a robot with this description. @throws Refusal as RobotSource::read()
  LoadedRobot load(const RobotSpec& robot, const RobotDescription& description);

 private:
  const RobotSource& source_;
  std::vector<std::pair<RobotDescription, std::shared_ptr<const ReadDescription>>> known_;
};

/// What a request of ~apply_robots changes, with everything that it needs read.
struct PreparedRobots {
  RobotChanges changes;
  std::map<std::string, std::uint64_t> read;  ///< by robot: hash of the description that was read
  std::map<std::string, std::string> like;    ///< by robot: the robot that it shares its model with
};

/// Prepares a request: reads the descriptions of robots that are added, and of absent robots that were never loaded.
/// This is slow.
/// @param robots  all robots before the request
/// @throws ChangeRefusal as isNeeded() and RobotSource; not_ready if `like` names a robot that is not loaded, or whose
/// newest description was refused
PreparedRobots prepare(const std::vector<RobotRequest>& requests, RobotEntries robots, const RobotSource& source,
                       const Params& params);

}  // namespace hgrid
