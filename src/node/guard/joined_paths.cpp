// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/guard/joined_paths.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "node/guard/guarded_joints.h"
#include "node/guard/path_deviation.h"
#include "node/states/followers.h"
#include "node/states/present_joints.h"
#include "node/states/robot_choice.h"

namespace hgrid {
namespace {

constexpr std::size_t kMostStates = 1000000;
constexpr double kMostTurn = 1.5;  // [rad] largest turn of a joint without limits between two states

/// Returns the first position of each joint of a path.
std::map<std::string, double> valuesOf(const RobotPath& path) {
  std::map<std::string, double> values;
  for (std::size_t i = 0; i < path.joints.size(); ++i) values[path.joints[i]] = path.positions[i];
  return values;
}

/// @throws Refusal limit
void checkSize(std::size_t states, std::size_t joints) {
  if (states <= kMostStates && states * joints <= kMostPositions) return;
  throw Refusal(Code::limit, "the paths have " + std::to_string(states) + " states of " + std::to_string(joints) +
                                 " joints within ~guard/ahead; at most " + std::to_string(kMostStates) +
                                 " states and " + std::to_string(kMostPositions) +
                                 " positions can be checked. Send fewer points");
}

}  // namespace

JoinedPaths::JoinedPaths(const RobotPaths& paths, const Tick& tick, double deviation, const TransformLookup& transforms,
                         const JointStates& joint_states)
    : tick_(tick), deviation_(deviation) {
  for (const auto& path : paths) {
    try {
      add(*path, transforms, joint_states);
    } catch (const Refusal& refusal) {
      if (doubt_.empty()) doubt_ = refusal.what();
    }
  }
  if (!robots_.empty()) kinematics_.emplace(joinRobots(robots_));
}

StateBatch JoinedPaths::states(Time begin, Time end, std::vector<Time>& times) const {
  times = {begin, end};
  for (const RobotPath* path : paths_) {
    for (const Time time : path->times) {
      if (time > begin && time < end) times.push_back(time);
    }
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  divide(times);
  StateBatch batch;
  batch.others = others_;
  for (const RobotPath* path : paths_) {
    for (const std::string& joint : path->joints) batch.joints.push_back(path->robot + "/" + joint);
  }
  checkSize(times.size(), batch.joints.size());
  for (const Time time : times) {
    for (const RobotPath* path : paths_) {
      for (std::size_t i = 0; i < path->joints.size(); ++i) batch.positions.push_back(path->positionAt(i, time));
    }
  }
  return batch;
}

void JoinedPaths::add(const RobotPath& path, const TransformLookup& transforms, const JointStates& joint_states) {
  const LoadedRobot& robot = robotNamed(path.robot, tick_);
  const GuardedJoints present = guardedJoints(robot, tick_, transforms, joint_states);
  const PresentPose root = presentRoot(robot, tick_, transforms);
  const std::string doubts[] = {path.doubt,
                                present.doubt,
                                root.doubt,
                                hiddenTurnOf(path, robot, present),
                                deviationOf(path, robot, present.values, tick_.snapshot->stamp(), deviation_),
                                unplannedMotionOf(path, robot, tick_, transforms),
                                followerOf(robot, valuesOf(path), false, {}, tick_, transforms)};
  for (const std::string& doubt : doubts) {
    if (doubt_.empty()) doubt_ = doubt;
  }
  paths_.push_back(&path);
  names_.push_back(robot.name);
  robots_.push_back({robot.name, &robot.read->model, root.world_from_frame});
  others_.insert(others_.end(), present.values.begin(), present.values.end());
  const Kinematics& kinematics = *robot.read->joints->kinematics;
  for (std::size_t i = 0; i < path.joints.size(); ++i) {
    const auto index = static_cast<std::size_t>(kinematics.find(path.joints[i]));  // deviationOf() has found it
    if (kinematics.variables()[index].turnsFreely()) turning_.emplace_back(&path, i);
  }
}

/// Inserts times, so that no joint without limits turns more than kMostTurn between two of them. Otherwise an edge
/// would take the shorter way around the circle.
void JoinedPaths::divide(std::vector<Time>& times) const {
  std::vector<Time> more;
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    double most = 0.0;
    for (const auto& [path, joint] : turning_) {
      most = std::max(most, std::abs(path->positionAt(joint, times[k + 1]) - path->positionAt(joint, times[k])));
    }
    const auto parts = static_cast<std::int64_t>(std::max(1.0, std::ceil(most / kMostTurn)));
    checkSize(more.size() + static_cast<std::size_t>(parts), 1);
    for (std::int64_t part = 0; part < parts; ++part) {
      more.push_back(times[k] + (times[k + 1] - times[k]) * part / parts);
    }
  }
  more.push_back(times.back());
  times = std::move(more);
}

}  // namespace hgrid
