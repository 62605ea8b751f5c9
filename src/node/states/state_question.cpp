// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/states/state_question.h"

#include <map>
#include <utility>

#include "node/messages/from_messages.h"
#include "node/services/request_checks.h"
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
  if (const auto group = variablesOf(asked.group, groups, robot.read->model)) {
    options.group = *group;
    return options;
  }
  const std::string& flaw = robot.read->joints->group_flaw;
  throw Refusal(Code::unknown_id, "the SRDF of robot '" + robot.name + "' has no group '" + printable(asked.group) +
                                      "' with joints" + (flaw.empty() ? "" : "; its groups cannot be used: " + flaw));
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
  return {StateChecker(tick.snapshot, kinematics, robot.name, std::move(narrow_phase), optionsOf(asked, robot, tick)),
          std::move(batch), std::move(doubt)};
}

}  // namespace hgrid
