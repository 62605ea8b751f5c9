// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hgrid_proximity/bodies/joined_robots.h"
#include "hgrid_proximity/bodies/kinematics.h"
#include "hgrid_proximity/queries/state_checker.h"
#include "node/guard/joint_states.h"
#include "node/guard/robot_path.h"
#include "node/tf/transform_lookup.h"
#include "node/tick/tick.h"

namespace hgrid {

/// The robots of several paths as one robot that moves (see joinRobots()).
class JoinedPaths {
 public:
  /// A robot whose joints are not known is left out.
  /// @param paths      paths of different robots; `paths` and `tick` must outlive this object
  /// @param deviation  [rad or m] how far a joint may be from its path
  JoinedPaths(const RobotPaths& paths, const Tick& tick, double deviation, const TransformLookup& transforms,
              const JointStates& joint_states);

  /// Returns why nobody knows where one of the robots will be; empty: it is known.
  const std::string& doubt() const { return doubt_; }
  /// Returns the names of the robots that are joined.
  const std::vector<std::string>& robots() const { return names_; }
  /// Returns the joints of all joined robots. There must be one.
  const Kinematics& kinematics() const { return *kinematics_; }
  /// Returns the states of the robots at all times of their points, and at further times where a joint turns far.
  /// @param times  receives the time of each state, from `begin` to `end`
  /// @throws Refusal limit if there are too many states
  StateBatch states(Time begin, Time end, std::vector<Time>& times) const;

 private:
  void add(const RobotPath& path, const TransformLookup& transforms, const JointStates& joint_states);
  void divide(std::vector<Time>& times) const;

  std::vector<const RobotPath*> paths_;  // of the joined robots
  std::vector<std::string> names_;
  const Tick& tick_;
  const double deviation_;
  std::vector<JoinedRobot> robots_;
  std::vector<double> others_;                                     // where the joints of all robots are now
  std::vector<std::pair<const RobotPath*, std::size_t>> turning_;  // the joints of paths that turn freely
  std::string doubt_;
  std::optional<Kinematics> kinematics_;
};

}  // namespace hgrid
