// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/guard/guarded_joints.h"

#include <algorithm>
#include <cmath>

#include "node/states/group_bodies.h"
#include "node/states/present_joints.h"

namespace hgrid {
namespace {

constexpr double kTurn = 2.0 * M_PI;   // [rad]
constexpr double kBeyondLimits = 0.1;  // [rad] how far a joint may be beyond its limits
// How far [rad] and how long [s] a joint may move between a message and the tick: too short for a full turn.
constexpr double kSameTurn = 1.0, kMostApartInTime = 0.25;
// A joint is at rest if it was not farther from here than this [rad or m], this long ago. In the default ~guard/ahead,
// such a joint moves by the default ~guard/deviation at most. Two times, because something that swings may be at one
// place at one of them.
constexpr double kRest = 0.01;
constexpr Time kAgo[] = {std::chrono::milliseconds(300), std::chrono::milliseconds(900)};

bool mayHideTurns(const JointVariable& variable) {
  return variable.is_angle && !variable.turnsFreely() && variable.upper - variable.lower + 2.0 * kBeyondLimits >= kTurn;
}

/// Returns whether the limits allow other turns than that of a value.
bool allowsTurns(double value, const JointVariable& variable) {
  return mayHideTurns(variable) &&
         (value + kTurn <= variable.upper + kBeyondLimits || value - kTurn >= variable.lower - kBeyondLimits);
}

/// Returns the pose of a frame at a time, or the newest one if it is not much older; nullopt: it is not known.
std::optional<Pose> nearbyPose(const std::string& target, const std::string& frame, Time time, double max_apart,
                               const TransformLookup& transforms) {
  try {
    return transforms.atOrNewest(target, frame, time, max_apart, "frame '" + printable(frame) + "'");
  } catch (const Refusal&) {
    return std::nullopt;
  }
}

/// Returns why a frame may move in another one; empty: it does not.
std::string motionOf(const std::string& target, const std::string& frame, const std::string& what, const Tick& tick,
                     const TransformLookup& transforms) {
  if (target == frame) return {};
  const Time time = tick.snapshot->stamp();
  const std::optional<Pose> now = nearbyPose(target, frame, time, tick.settings->params.stale_after, transforms);
  for (const Time ago : kAgo) {
    const std::optional<FramePose> then = transforms.at(target, frame, time - ago);
    if (!now || !then) {
      return what + " has no path, and tf does not tell whether it has been at rest for " + secondsText(seconds(ago));
    }
    const Pose moved = then->pose().inverse() * *now;
    const double way = std::max(moved.translation().norm(), std::abs(Eigen::AngleAxisd(moved.linear()).angle()));
    if (way > kRest) {
      return what + " has no path, but it moves: by " + text(way) + " rad or m in the last " +
             secondsText(seconds(ago));
    }
  }
  return {};
}

/// Returns whether a path moves all variables of a joint, or those of the joint that it mimics.
bool hasPath(const RobotLink& link, const RobotModel& model, const RobotPath& path) {
  std::vector<JointVariable> own;
  appendVariables(masterOf(link, model), own);
  return std::all_of(own.begin(), own.end(), [&](const JointVariable& variable) {
    return std::count(path.joints.begin(), path.joints.end(), variable.name) > 0;
  });
}

}  // namespace

GuardedJoints guardedJoints(const LoadedRobot& robot, const Tick& tick, const TransformLookup& transforms,
                            const JointStates& joint_states) {
  PresentJoints present = presentJoints(robot, {}, tick, transforms);
  GuardedJoints joints;
  joints.values = std::move(present.values);
  joints.doubt = std::move(present.doubt);
  const auto entry = tick.robots->find(robot.name);
  if (entry != tick.robots->end() && entry->second.spec) {
    joints.joint_states = jointStatesTopic(entry->second.spec->params);
  }
  const std::vector<JointVariable>& variables = robot.read->joints->kinematics->variables();
  for (std::size_t i = 0; i < variables.size(); ++i) {
    double& value = joints.values[i];
    joints.turn_hidden.push_back(allowsTurns(value, variables[i]));
    if (!joints.turn_hidden.back()) continue;
    const std::optional<double> told = joint_states.position(joints.joint_states, robot.name, variables[i].name,
                                                             tick.snapshot->stamp(), kMostApartInTime);
    // Another robot on the same topic has other angles.
    if (!told || std::abs(std::remainder(*told - value, kTurn)) > kSameTurn) continue;
    value = *told - std::remainder(*told - value, kTurn);
    joints.turn_hidden.back() = false;
  }
  return joints;
}

bool mayHideTurns(const LoadedRobot& robot) {
  if (!robot.read || !robot.read->joints || !robot.read->joints->kinematics) return false;
  const std::vector<JointVariable>& variables = robot.read->joints->kinematics->variables();
  return std::any_of(variables.begin(), variables.end(), [](const auto& variable) { return mayHideTurns(variable); });
}

std::string hiddenTurnOf(const RobotPath& path, const LoadedRobot& robot, const GuardedJoints& joints) {
  const Kinematics& kinematics = *robot.read->joints->kinematics;
  for (const std::string& joint : path.joints) {
    const int index = kinematics.find(joint);
    if (index < 0 || !joints.turn_hidden[static_cast<std::size_t>(index)]) continue;
    const double value = joints.values[static_cast<std::size_t>(index)];
    return "joint '" + printable(joint) + "' of robot '" + robot.name + "' is at " + text(value) +
           " rad or full turns from there; tf does not tell which, and the topic '" + printable(joints.joint_states) +
           "' has no current position of the joint (joint_states in ~robots)";
  }
  return {};
}

std::string unplannedMotionOf(const RobotPath& path, const LoadedRobot& robot, const Tick& tick,
                              const TransformLookup& transforms) {
  const RobotModel& model = robot.read->model;
  const GroupBodies bodies(robot, *tick.snapshot);
  for (const RobotLink& link : model.links) {
    if (link.joint_kind == JointKind::fixed || link.parent < 0 || !bodies.hasBodies(link.rigid_group)) continue;
    if (hasPath(link, model, path)) continue;
    const RobotLink& parent = model.links[static_cast<std::size_t>(link.parent)];
    const std::string motion =
        motionOf(robot.groups[parent.rigid_group].frame, robot.groups[link.rigid_group].frame,
                 "joint '" + printable(link.joint) + "' of robot '" + robot.name + "'", tick, transforms);
    if (!motion.empty()) return motion;
  }
  return motionOf(tick.world_frame, robot.root_frame, "the root link of robot '" + robot.name + "'", tick, transforms);
}

}  // namespace hgrid
