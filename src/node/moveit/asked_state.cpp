// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/moveit/asked_state.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "node/states/followers.h"
#include "node/states/present_joints.h"
#include "node/states/robot_choice.h"
#include "node/text/frame_names.h"
#include "node/wire/from_messages.h"

namespace hgrid {
namespace {

using State = moveit::RobotState;

void checkLengths(const char* list, std::size_t names, const char* values, std::size_t count) {
  if (names == count) return;
  throw Refusal(Code::out_of_range, std::string(list) + " has " + std::to_string(names) + " names and " +
                                        std::to_string(count) + " " + values + "; there must be one for each name");
}

void check(const State& state) {
  checkLengths("joint_state", state.joint_state.name.size(), "positions", state.joint_state.position.size());
  checkLengths("multi_dof_joint_state", state.multi_dof_joint_state.joint_names.size(), "transforms",
               state.multi_dof_joint_state.transforms.size());
  if (!state.attached_collision_objects.empty()) {
    throw Refusal(Code::unsupported, "the state attaches the object '" +
                                         printable(state.attached_collision_objects.front().object.id) +
                                         "'; attach it in the world with apply_planning_scene instead");
  }
}

geometry_msgs::Pose poseAfter(const geometry_msgs::Transform& transform) {
  geometry_msgs::Pose pose;
  pose.position.x = transform.translation.x;
  pose.position.y = transform.translation.y;
  pose.position.z = transform.translation.z;
  pose.orientation = transform.rotation;
  return pose;
}

/// Checks that a planar joint can have a pose. @throws Refusal conflict
void checkPlanar(const std::string& joint, const Eigen::Vector3d& axis, const Pose& pose) {
  constexpr double kMost = 1e-3;  // [m] and [rad]
  const double out = std::abs(axis.dot(pose.translation())), tilt = (pose.linear() * axis - axis).norm();
  if (out <= kMost && tilt <= kMost) return;
  throw Refusal(Code::conflict, "the transform of joint '" + printable(joint) + "' is " + text(out) +
                                    " m out of the plane of the joint and tilts it by " + text(tilt) +
                                    " rad; the axis of a planar joint must stay perpendicular to its plane");
}

/// Collects values of variables. Joints that mimic others are left out: the joint that they follow decides.
class GivenValues {
 public:
  explicit GivenValues(const LoadedRobot& robot) : robot_(robot) {}

  void addJoint(const std::string& name, double position) {
    const std::string joint = jointOf(name, robot_.name);
    if (robot_.read->joints->kinematics->find(joint) >= 0) return add(joint, position);
    if (!linkOf(joint).mimic.empty()) return;
    throw Refusal(Code::unsupported, "joint '" + printable(joint) +
                                         "' is in joint_state, but it has several values; it must be in "
                                         "multi_dof_joint_state");
  }
  void addPose(const std::string& joint, const Pose& pose) {
    const RobotLink& link = linkOf(joint);
    std::vector<JointVariable> variables;
    std::vector<double> values;
    appendVariables(link, variables);
    appendValues(link, link.parent_from_joint * pose, values);
    if (link.joint_kind == JointKind::planar) checkPlanar(joint, link.axis, pose);
    for (std::size_t i = 0; i < variables.size(); ++i) add(variables[i].name, values[i]);
  }
  /// Returns the values, by name of the variable.
  const std::map<std::string, double>& all() const { return values_; }

 private:
  void add(const std::string& variable, double value) {
    if (values_.emplace(variable, value).second) return;
    throw Refusal(Code::dup_id,
                  "joint value '" + printable(variable) + "' occurs twice in the state; it must occur once");
  }
  const RobotLink& linkOf(const std::string& joint) const {
    const std::vector<RobotLink>& links = robot_.read->model.links;
    const auto found =
        std::find_if(links.begin(), links.end(), [&](const RobotLink& link) { return link.joint == joint; });
    if (found != links.end()) return *found;
    throw Refusal(Code::unsupported, "joint '" + printable(joint) +
                                         "' is virtual, but it is in joint_state; it must be in multi_dof_joint_state");
  }

  const LoadedRobot& robot_;
  std::map<std::string, double> values_;
};

/// Sets the pose of the root link that a virtual joint has in a message. As in MoveIt, a fixed one cannot move it.
void moveRoot(const VirtualJoint& joint, const std::string& frame_of_message, const Pose& pose, const Tick& tick,
              const TransformLookup& transforms, AskedState& asked) {
  if (joint.kind == JointKind::fixed) return;
  const std::string& root = asked.robot.read->model.links.front().name;
  if (joint.child_link != root) {
    throw Refusal(Code::unsupported, "the virtual joint '" + printable(joint.name) + "' moves the link '" +
                                         printable(joint.child_link) + "'; it must move the root link '" +
                                         printable(root) + "'");
  }
  if (joint.kind == JointKind::planar) checkPlanar(joint.name, Eigen::Vector3d::UnitZ(), pose);
  const std::string frame = withoutSlash(frame_of_message.empty() ? joint.parent_frame : frame_of_message);
  const std::string what = "the frame '" + printable(frame) + "' of multi_dof_joint_state";
  const PresentPose found = presentPose(asked.robot, frame, what, tick, transforms);
  asked.batch.world_from_root = found.world_from_frame * pose;
  asked.doubt = found.doubt;
}

}  // namespace

AskedState askedState(const State& state, const std::string& group, const Tick& tick,
                      const TransformLookup& transforms) {
  check(state);
  const std::vector<std::string>& poses_joints = state.multi_dof_joint_state.joint_names;
  std::vector<std::string> names = state.joint_state.name;
  names.insert(names.end(), poses_joints.begin(), poses_joints.end());
  AskedState asked{robotWith(names, group, tick), {}, {}};
  GivenValues given(asked.robot);
  for (std::size_t i = 0; i < state.joint_state.name.size(); ++i) {
    given.addJoint(state.joint_state.name[i], state.joint_state.position[i]);
  }
  for (std::size_t i = 0; i < poses_joints.size(); ++i) {
    const std::string name = jointOf(poses_joints[i], asked.robot.name);
    const Pose pose = fromPose(poseAfter(state.multi_dof_joint_state.transforms[i]),
                               "the transform of joint '" + printable(name) + "'");
    if (const VirtualJoint* joint = asked.robot.read->joints->groups.findVirtual(name)) {
      moveRoot(*joint, state.multi_dof_joint_state.header.frame_id, pose, tick, transforms, asked);
    } else {
      given.addPose(name, pose);
    }
  }
  const bool moves_root = asked.batch.world_from_root.has_value();
  PresentJoints joints = presentJoints(asked.robot, given.all(), tick, transforms);
  asked.batch.positions = std::move(joints.values);
  if (asked.doubt.empty()) asked.doubt = std::move(joints.doubt);
  if (asked.doubt.empty()) asked.doubt = followerOf(asked.robot, given.all(), moves_root, {}, tick, transforms);
  // The checker takes the pose of the root link from a body that is rigidly connected to it, if there is one.
  if (!moves_root && asked.robot.groups.front().members.empty()) {
    const std::string& frame = asked.robot.root_frame;
    const PresentPose root =
        presentPose(asked.robot, frame, "the root frame '" + printable(frame) + "'", tick, transforms);
    asked.batch.world_from_root = root.world_from_frame;
    if (asked.doubt.empty()) asked.doubt = root.doubt;
  }
  return asked;
}

}  // namespace hgrid
