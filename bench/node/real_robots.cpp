// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <cmath>
#include <cstdlib>

#include "test/support/robots.h"
#include "workload.h"

namespace hgrid {
namespace bench {
namespace {

constexpr double kApart = 1.2;  // [m] distance of the robot bases, so small that the robots come near each other

geometry_msgs::TransformStamped frameOf(const RobotModel& model, std::size_t link, const std::string& prefix) {
  geometry_msgs::TransformStamped frame;
  const int parent = model.links[link].parent;
  frame.header.frame_id = parent < 0 ? "world" : prefix + "/" + model.links[static_cast<std::size_t>(parent)].name;
  frame.child_frame_id = prefix + "/" + model.links[link].name;
  return frame;
}

void setPose(const Pose& pose, geometry_msgs::Transform& transform) {
  const Eigen::Quaterniond rotation(pose.linear());
  transform.translation.x = pose.translation().x();
  transform.translation.y = pose.translation().y();
  transform.translation.z = pose.translation().z();
  transform.rotation.x = rotation.x();
  transform.rotation.y = rotation.y();
  transform.rotation.z = rotation.z();
  transform.rotation.w = rotation.w();
}

/// Returns the pose of a joint that swings around the middle of its range. `t` is the phase angle of the swing [rad].
Pose swung(const RobotLink& link, double t) {
  const bool limited = link.lower != link.upper;
  const double middle = limited ? 0.5 * (link.lower + link.upper) : 0.0;
  const double range = limited ? 0.3 * (link.upper - link.lower) : 1.0;
  const double position = middle + range * std::sin(t);
  Pose motion = Pose::Identity();
  if (link.joint_kind == JointKind::revolute)
    motion.linear() = Eigen::AngleAxisd(position, link.axis).toRotationMatrix();
  if (link.joint_kind == JointKind::prismatic) motion.translation() = position * link.axis;
  return motion;
}

}  // namespace

std::vector<Workload> realRobots(double rate) {
  if (test::sharedData().empty()) return {};
  const char* others = std::getenv("ROS_PACKAGE_PATH");  // the node needs it to find meshes with package:// paths
  setenv("ROS_PACKAGE_PATH", (test::sharedData() + ":" + (others == nullptr ? "" : others)).c_str(), 1);
  Workload workload;
  workload.title = "UR5, Panda and PR2, distances measured";
  workload.rate = rate;
  workload.distances = true;
  workload.params["rate"] = rate;
  workload.params["world_frame"] = "world";
  struct Moving {
    RobotModel model;
    std::string name;
    tf2_msgs::TFMessage message;
  };
  auto robots = std::make_shared<std::vector<Moving>>();
  for (const std::string name : {"ur5", "panda", "pr2"}) {
    const test::RealRobot robot = test::realRobot(name);
    MeshLoader loader(test::meshPolicy());
    Moving moving{test::readWith(loader, robot.urdf), name, {}};
    workload.descriptions[name + "_description"] = robot.urdf;
    workload.descriptions[name + "_semantic"] = robot.srdf;
    XmlRpc::XmlRpcValue& entry = workload.params["robots"][static_cast<int>(robots->size())];
    entry["name"] = name;
    entry["description"] = name + "_description";
    entry["semantic"] = name + "_semantic";
    entry["tf_prefix"] = name;
    for (std::size_t link = 0; link < moving.model.links.size(); ++link) {
      moving.message.transforms.push_back(frameOf(moving.model, link, name));
      workload.bodies += moving.model.links[link].has_collision;
    }
    robots->push_back(std::move(moving));
  }
  workload.move = [robots](double t) {
    std::vector<tf2_msgs::TFMessage> messages;
    for (std::size_t number = 0; number < robots->size(); ++number) {
      Moving& robot = (*robots)[number];
      for (std::size_t link = 0; link < robot.model.links.size(); ++link) {
        const RobotLink& what = robot.model.links[link];
        Pose pose = what.parent_from_joint * swung(what, 0.5 * t + static_cast<double>(link));
        if (link == 0) pose = Pose(Eigen::Translation3d(kApart * static_cast<double>(number), 0.0, 0.0));
        setPose(pose, robot.message.transforms[link].transform);
      }
      messages.push_back(robot.message);
    }
    return messages;
  };
  return {workload};
}

}  // namespace bench
}  // namespace hgrid
