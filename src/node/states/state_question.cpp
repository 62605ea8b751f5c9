// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/states/state_question.h"

#include <algorithm>
#include <map>
#include <utility>

#include "hgrid_proximity/bodies/joined_robots.h"
#include "node/queries/request_checks.h"
#include "node/states/followers.h"
#include "node/states/present_joints.h"
#include "node/states/robot_choice.h"
#include "node/wire/from_messages.h"

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

/// Checks names of variables. @throws Refusal dup_id, unknown_id
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

/// Checks that a robot was not loaded again since a tick. @throws Refusal conflict
void checkModel(const LoadedRobot& robot, const Tick& tick, const Tick& newest) {
  const auto now = newest.robots->find(robot.name);
  if (now != newest.robots->end() && now->second.inWorld() && now->second.model->read == robot.read) return;
  const auto revisionOf = [](const Tick& of) { return std::to_string(of.snapshot->structure().revision); };
  throw Refusal(Code::conflict, "robot '" + robot.name + "' was loaded again or removed since tick " +
                                    std::to_string(tick.snapshot->sequence()) + " of the lease (bodies of revision " +
                                    revisionOf(tick) + ", now " + revisionOf(newest) + "); ask for a new lease");
}

/// The joints of other robots that a request gives: for each robot, the values of its variables.
using OtherJoints = std::map<std::string, std::map<std::string, double>>;

/// Reads the joints of other robots from a request.
/// @throws Refusal out_of_range, unknown_id, not_ready, conflict, dup_id
OtherJoints otherJoints(const AskedStates& asked, const std::string& robot, const Tick& tick) {
  if (asked.other_joint_names.size() != asked.other_positions.size()) {
    throw Refusal(Code::out_of_range, "other_joint_names has " + std::to_string(asked.other_joint_names.size()) +
                                          " entries, and other_positions " +
                                          std::to_string(asked.other_positions.size()) +
                                          "; give one position for each name");
  }
  OtherJoints others;
  for (std::size_t i = 0; i < asked.other_joint_names.size(); ++i) {
    const std::string& name = asked.other_joint_names[i];
    const std::string other = name.substr(0, name.find('/'));
    const std::string what = "'" + printable(name) + "' in other_joint_names ";
    if (other.size() == name.size()) throw Refusal(Code::unknown_id, what + "must be written as robot/joint");
    if (other == robot) {
      throw Refusal(Code::conflict, what + "is a joint of the robot that is checked; name it in joint_names instead");
    }
    const std::string joint = name.substr(other.size() + 1);
    checkJoints({joint}, *robotNamed(other, tick).read->joints->kinematics, other);
    if (!others[other].emplace(joint, asked.other_positions[i]).second) {
      throw Refusal(Code::dup_id, what + "occurs twice; each joint may occur only once");
    }
  }
  return others;
}

/// The question about several robots: the checked robot, and other robots whose joints the request gives.
class JoinedQuestion {
 public:
  /// Puts the name of the robot before the names of the joints in `batch`.
  JoinedQuestion(const LoadedRobot& robot, const Pose& world_from_root, StateBatch& batch)
      : robot_(robot), joined_{{robot.name, &robot.read->model, world_from_root}}, batch_(batch) {
    for (std::string& joint : batch.joints) joint = robot.name + "/" + joint;
  }
  /// Adds a robot and the values of its variables.
  /// @param placed  name of the checked robot if its root link is given, otherwise empty
  /// @returns why nobody knows where the robot would be; empty: it is known
  std::string add(const LoadedRobot& other, const std::map<std::string, double>& given, const std::string& placed,
                  const Tick& tick, const TransformLookup& transforms) {
    const PresentJoints present = presentJoints(other, given, tick, transforms);
    batch_.others.insert(batch_.others.end(), present.values.begin(), present.values.end());
    const PresentPose root = presentRoot(other, tick, transforms);
    joined_.push_back({other.name, &other.read->model, root.world_from_frame});
    if (!present.doubt.empty()) return present.doubt;
    return root.doubt.empty() ? followerOf(other, given, false, placed, tick, transforms) : root.doubt;
  }
  /// Returns a checker for which only bodies of the checked robot count.
  std::shared_ptr<const StateChecker> checker(StateCheckerOptions options, const Tick& tick,
                                              const std::shared_ptr<const NarrowPhase>& measures) const {
    for (std::string& variable : options.group) variable = robot_.name + "/" + variable;
    options.robots = {robot_.name};
    return std::make_shared<const StateChecker>(tick.snapshot, Kinematics(joinRobots(joined_)), "", measures, options);
  }

 private:
  const LoadedRobot& robot_;
  std::vector<JoinedRobot> joined_;
  StateBatch& batch_;
};

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
                            const Tick& newest, const TransformLookup& transforms,
                            const std::shared_ptr<const NarrowPhase>& narrow_phase, CheckerCache& cache) {
  checkPatterns(asked.ignore);
  if (asked.joint_names.empty() && !positions.empty()) {
    throw Refusal(Code::out_of_range, "the request has " + std::to_string(positions.size()) +
                                          " positions but no joint_names; name the joint of each column");
  }
  const LoadedRobot& robot =
      asked.robot.empty() ? robotWith(asked.joint_names, asked.group, tick) : robotNamed(asked.robot, tick);
  checkModel(robot, tick, newest);
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
  if (doubt.empty()) doubt = followerOf(robot, given, asked.base.has_value(), {}, tick, transforms);
  const OtherJoints others = otherJoints(asked, robot.name, tick);
  // Of one robot alone, the checker takes the pose of the root link from a body that is rigidly connected to it.
  if (!asked.base && (robot.groups.front().members.empty() || !others.empty())) {
    const PresentPose root = presentRoot(robot, tick, transforms);
    batch.world_from_root = root.world_from_frame;
    if (doubt.empty()) doubt = root.doubt;
  }
  const StateCheckerOptions options = optionsOf(asked, robot, tick);
  if (others.empty()) {
    std::shared_ptr<const StateChecker> checker = cache.get(tick, robot, options, narrow_phase);
    checkCounting(*checker, asked);
    return {std::move(checker), std::move(batch), std::move(doubt)};
  }
  JoinedQuestion joined(robot, *batch.world_from_root, batch);
  batch.world_from_root.reset();  // the root link of joined robots is the world
  const std::string placed = asked.base ? robot.name : "";
  for (const auto& [name, values] : others) {
    const LoadedRobot& other = robotNamed(name, tick);
    checkModel(other, tick, newest);
    const std::string doubt_of_other = joined.add(other, values, placed, tick, transforms);
    if (doubt.empty()) doubt = doubt_of_other;
  }
  std::shared_ptr<const StateChecker> checker = joined.checker(options, tick, narrow_phase);
  checkCounting(*checker, asked);
  return {std::move(checker), std::move(batch), std::move(doubt)};
}

}  // namespace hgrid
