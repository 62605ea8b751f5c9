// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/states/state_question.h"

#include <algorithm>
#include <map>
#include <utility>

#include "node/messages/from_messages.h"
#include "node/queries/request_checks.h"
#include "node/states/followers.h"
#include "node/states/present_joints.h"
#include "node/states/robot_choice.h"

namespace hgrid {
namespace {

StateCheckerOptions optionsOf(const AskedStates& asked, const LoadedRobot& robot, const Tick& tick) {
  StateCheckerOptions options;
  options.world_frame = tick.world_frame;
  options.ignore = asked.ignore;
  if (asked.group.empty()) return options;
  const JointGroups& groups = robot.read->joints->groups;
  const bool is_known = std::any_of(groups.groups.begin(), groups.groups.end(),
                                    [&](const JointGroup& group) { return group.name == asked.group; });
  if (!is_known) {
    const std::string& flaw = robot.read->joints->group_flaw;
    throw Refusal(Code::unknown_id, "the SRDF of robot '" + robot.name + "' has no group '" + printable(asked.group) +
                                        "'" + (flaw.empty() ? "" : "; its groups cannot be used: " + flaw));
  }
  // A group with a virtual joint moves the whole robot.
  if (const auto group = variablesOf(asked.group, groups, robot.read->model)) options.group = *group;
  return options;
}

/// Checks the names of the columns. @throws Refusal limit, unknown_id
void checkJoints(const std::vector<std::string>& joints, const Kinematics& kinematics, const std::string& robot) {
  const std::size_t most = kinematics.variables().size();
  for (const std::string& joint : joints) {
    if (kinematics.find(joint) >= 0) continue;
    throw Refusal(Code::unknown_id, "joint '" + printable(joint) + "' of the request is not a joint value of robot '" +
                                        robot + "'; fixed joints and joints that mimic others have none");
  }
  if (joints.size() <= most) return;
  throw Refusal(Code::dup_id, "the request names " + std::to_string(joints.size()) + " joints, but robot '" + robot +
                                  "' has only " + std::to_string(most) + " joint values; each must occur once");
}

/// Checks that something of the robot is left to be checked. Otherwise every state would be CLEAR.
void checkCounting(const StateChecker& checker, const AskedStates& asked) {
  if (checker.countingShapes() > 0) return;
  if (!asked.group.empty() && asked.ignore.empty()) {
    throw Refusal(Code::unsupported, "no link that group '" + printable(asked.group) +
                                         "' moves has geometry, so there is nothing to check");
  }
  throw Refusal(Code::unknown_id, "ignore leaves out all bodies of the robot that count; at least one must remain");
}

}  // namespace

StateQuestion stateQuestion(const AskedStates& asked, std::vector<double> positions, const Tick& tick,
                            const TransformLookup& transforms, std::shared_ptr<const NarrowPhase> narrow_phase) {
  checkPatterns(asked.ignore);
  if (asked.joint_names.empty() && !positions.empty()) {
    throw Refusal(Code::out_of_range, "the request has " + std::to_string(positions.size()) +
                                          " positions but no joint_names; name the joint of each column");
  }
  const LoadedRobot& robot =
      asked.robot.empty() ? robotWith(asked.joint_names, asked.group, tick) : robotNamed(asked.robot, tick);
  const Kinematics& kinematics = *robot.read->joints->kinematics;
  StateBatch batch;
  std::map<std::string, double> given;  // presentJoints() needs to know which values are given, but not the values
  for (const std::string& name : asked.joint_names) {
    batch.joints.push_back(jointOf(name, robot.name));
    given[batch.joints.back()] = 0.0;
  }
  checkJoints(batch.joints, kinematics, robot.name);
  batch.positions = std::move(positions);
  PresentJoints present = presentJoints(robot, given, tick, transforms);
  batch.others = std::move(present.values);
  std::string doubt = std::move(present.doubt);
  if (asked.base) batch.world_from_root = fromPose(*asked.base, "the base of the robot");
  if (doubt.empty()) doubt = followerOf(robot, given, asked.base.has_value(), tick, transforms);
  // The checker takes the pose of the root link from a body that is rigidly connected to it, if there is one.
  if (!asked.base && robot.groups.front().members.empty()) {
    const std::string& frame = robot.root_frame;
    const PresentPose root = presentPose(robot, frame, "the root frame '" + printable(frame) + "'", tick, transforms);
    batch.world_from_root = root.world_from_frame;
    if (doubt.empty()) doubt = root.doubt;
  }
  StateChecker checker(tick.snapshot, kinematics, robot.name, std::move(narrow_phase), optionsOf(asked, robot, tick));
  checkCounting(checker, asked);
  return {std::move(checker), std::move(batch), std::move(doubt)};
}

}  // namespace hgrid
