// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/states/present_joints.h"

#include <algorithm>

#include "node/states/group_bodies.h"
#include "queries/doubtful_body.h"

namespace hgrid {
namespace {

constexpr double kMostApart = 1e-3;  // [m] and [rad] how far a pose on tf may be from the one that the joints give

bool isNear(const Pose& a, const Pose& b) {
  const Pose apart = a.inverse() * b;
  return apart.translation().norm() <= kMostApart && std::abs(Eigen::AngleAxisd(apart.linear()).angle()) <= kMostApart;
}

/// Reads where joints stand from the poses of their links on tf.
class Reader {
 public:
  Reader(const LoadedRobot& robot, const std::map<std::string, double>& given, const Tick& tick,
         const TransformLookup& transforms)
      : robot_(robot),
        model_(robot.read->model),
        given_(given),
        tick_(tick),
        transforms_(transforms),
        bodies_(robot, *tick.snapshot) {}

  PresentJoints read() {
    for (const RobotLink& link : model_.links) {
      if (link.joint_kind == JointKind::fixed) continue;
      const Pose parent_from_link = poseOf(link);
      if (link.mimic.empty()) append(link, parent_from_link);
    }
    compare();
    return std::move(result_);
  }

 private:
  /// Whether the request gives the value of a joint. Half of a joint does not count.
  std::size_t givenOf(const RobotLink& link) const {
    std::vector<JointVariable> own;
    appendVariables(link, own);
    const auto is_given = [&](const JointVariable& variable) { return given_.count(variable.name) > 0; };
    return static_cast<std::size_t>(std::count_if(own.begin(), own.end(), is_given));
  }

  /// Returns the pose of a link in its parent: the one on tf, or any if nothing depends on it.
  Pose poseOf(const RobotLink& link) {
    std::vector<JointVariable> own;
    const RobotLink& master = masterOf(link, model_);
    appendVariables(master, own);
    const std::size_t given = givenOf(master);
    if (given == own.size() || !bodies_.hasBodies(link.rigid_group)) return link.parent_from_joint;
    const RobotLink& parent = model_.links[static_cast<std::size_t>(link.parent)];
    const std::string& frame = robot_.groups[link.rigid_group].frame;
    const Pose pose =
        parent.group_from_link.inverse() *
        transforms_.atOrNewest(robot_.groups[parent.rigid_group].frame, frame, tick_.snapshot->stamp(),
                               tick_.settings->params.stale_after,
                               "the frame '" + printable(frame) + "' behind joint '" + printable(link.joint) + "'");
    if (result_.doubt.empty()) result_.doubt = bodies_.doubtAbout(link.rigid_group);
    if (given == 0) seen_.emplace_back(&link, pose);
    return pose;
  }

  void append(const RobotLink& link, const Pose& parent_from_link) {
    std::vector<JointVariable> own;
    appendVariables(link, own);
    appendValues(link, parent_from_link, result_.values);
    for (std::size_t i = 0; i < own.size(); ++i) {
      const auto value = given_.find(own[i].name);
      if (value != given_.end()) result_.values[result_.values.size() - own.size() + i] = value->second;
    }
  }

  /// Compares the poses that were read with those that follow from the values.
  void compare() {
    if (seen_.empty()) return;
    const std::vector<Pose> root_from_links = robot_.read->joints->kinematics->rootFromLinks(result_.values);
    for (const auto& [link, pose] : seen_) {
      const auto index = static_cast<std::size_t>(link - model_.links.data());
      const Pose expected = root_from_links[static_cast<std::size_t>(link->parent)].inverse() * root_from_links[index];
      if (!result_.doubt.empty() || isNear(expected, pose)) continue;
      result_.doubt = "the pose of link '" + printable(link->name) + "' on tf is not one that joint '" +
                      printable(link->joint) + "' can give it";
    }
  }

  const LoadedRobot& robot_;
  const RobotModel& model_;
  const std::map<std::string, double>& given_;
  const Tick& tick_;
  const TransformLookup& transforms_;
  const GroupBodies bodies_;
  std::vector<std::pair<const RobotLink*, Pose>> seen_;  // links whose poses on tf decide, and these poses
  PresentJoints result_;
};

}  // namespace

const RobotLink& masterOf(const RobotLink& link, const RobotModel& model) {
  const RobotLink* master = &link;
  for (std::size_t steps = 0; !master->mimic.empty() && steps < model.links.size(); ++steps) {
    const auto found = std::find_if(model.links.begin(), model.links.end(),
                                    [&](const RobotLink& other) { return other.joint == master->mimic; });
    if (found == model.links.end()) break;  // the constructor of Kinematics refuses this
    master = &*found;
  }
  return *master;
}

PresentJoints presentJoints(const LoadedRobot& robot, const std::map<std::string, double>& given, const Tick& tick,
                            const TransformLookup& transforms) {
  return Reader(robot, given, tick, transforms).read();
}

PresentPose presentPose(const LoadedRobot& robot, const std::string& frame, const std::string& what, const Tick& tick,
                        const TransformLookup& transforms) {
  if (frame == tick.world_frame) return {Pose::Identity(), {}};
  PresentPose pose{
      transforms.atOrNewest(tick.world_frame, frame, tick.made.ros, tick.settings->params.stale_after, what), {}};
  const bool is_static = transforms.isKnown(tick.world_frame, frame, Time::max() / 2);  // static poses have no time
  if (!is_static) pose.doubt = GroupBodies(robot, *tick.snapshot).doubtAbout(0);
  return pose;
}

PresentPose presentRoot(const LoadedRobot& robot, const Tick& tick, const TransformLookup& transforms) {
  const Snapshot& snapshot = *tick.snapshot;
  for (const auto& member : robot.groups.front().members) {
    const std::uint32_t index = snapshot.structure().find(robot.bodies[member.first].name);
    if (index == Structure::kNone || snapshot.poses()[index].state == Freshness::unplaced) continue;
    const Body& body = snapshot.structure().bodies[index];
    const BodyPose& pose = snapshot.poses()[index];
    PresentPose root{pose.world_from_body * robot.read->model.links[body.link].group_from_link.inverse(), {}};
    if (pose.reach > 0.0 || pose.state >= Freshness::frozen) root.doubt = doubtOf(body, pose);
    return root;
  }
  const std::string& frame = robot.root_frame;
  return presentPose(robot, frame, "the root frame '" + printable(frame) + "'", tick, transforms);
}

}  // namespace hgrid
