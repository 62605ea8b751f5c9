// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Conflicts.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "node/guard/path_check.h"
#include "node/guard/path_list.h"
#include "node/health/commons.h"
#include "node/threads/newest_only.h"

namespace hgrid {

/// Checks the paths of robots again whenever the world changes, and publishes the results as ~conflicts.
///
/// A thread of its own checks, so no tick waits for it. If a check takes longer than a period, the thread continues
/// with the newest tick. While no robot has a path, it does nothing. All functions may be called by any thread.
class Guard {
 public:
  /// All parameters that are passed by reference must outlive this object.
  Guard(ros::NodeHandle private_node, Commons& commons, const TransformLookup& transforms,
        const JointStates& joint_states);

  /// Watches a path. For what it replaces, see PathList. Until `start`, the robot is expected to continue its earlier
  /// path, or to stand still. Then it moves to the first point.
  /// @param start  [ROS time] when the robot begins to move to the first point
  /// @param phase  of the goal that the path is from
  /// @throws Refusal what checkPath(), robotNamed() and presentJoints() throw; unknown_id for a joint that the robot
  /// does not have; out_of_range for a path that ended before the tick, or for a joint that turns too far between two
  /// points; limit for too many points
  /// @returns the stored path
  std::shared_ptr<const RobotPath> follow(const PathSource& source, RobotPath path, Time start, const Tick& tick,
                                          GoalPhase phase = GoalPhase::followed);
  /// Notes that the newest path from this source could not be read. No path is clear until the source sends another
  /// one, or until the goal that it is from ends.
  void markUnreadable(const PathSource& source, const std::string& robot, const std::string& why, const Tick& tick,
                      GoalPhase phase = GoalPhase::followed);
  /// Replaces the path of a goal, if the goal is not accepted so far: its server begins it now.
  /// @throws Refusal as follow()
  void begin(const PathSource& source, RobotPath path, Time start, const Tick& tick);
  /// Takes the news of a goal.
  void note(const PathSource& source, const std::string& robot, GoalPhase phase, const Tick& tick) {
    paths_.note(source, robot, phase, tick);
  }
  /// Forgets the paths of a robot from one topic. The other paths of its controller may end, too.
  void stop(const PathSource& source, const std::string& robot) { paths_.stop(source, robot); }
  /// Forgets all paths of a robot. @returns whether it had one
  bool stopAll(const std::string& robot) { return paths_.removeAll(robot); }
  /// Checks all paths now. @returns the answer for the robot of `path`
  /// @throws Refusal conflict if another path has replaced it, or if it was removed
  PathAnswer check(const std::shared_ptr<const RobotPath>& path, const Tick& tick);
  /// Passes a tick to the thread, and never waits for it.
  void see(const std::shared_ptr<const Tick>& tick);

 private:
  using Found = std::tuple<std::string, std::string, std::string>;  // robot and the two bodies of a conflict

  RobotPath prepared(RobotPath path, Time start, const Tick& tick) const;
  RobotPaths currentPaths(const Tick& tick);
  std::vector<PathAnswer> check(const RobotPaths& paths, const Tick& tick);
  void publish(const Tick& tick);

  Commons& commons_;
  const TransformLookup& transforms_;
  const JointStates& joint_states_;
  ros::Publisher publisher_;
  PathList paths_;
  std::map<Found, Time> since_;       // only the thread uses it: when each conflict was found for the first time
  std::atomic<bool> watched_{false};  // whether the last message had a path
  NewestOnly<std::shared_ptr<const Tick>> thread_;  // declared last, because its thread uses the members above
};

}  // namespace hgrid
