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

/// A robot and the message that moves it.
struct Moving {
  RobotModel model;
  std::string name;
  tf2_msgs::TFMessage message;
};

/// Adds a real robot to the parameters and descriptions of a workload.
/// @param model  name of its files
Moving addRobot(Workload& workload, const std::string& name, const std::string& model) {
  const test::RealRobot robot = test::realRobot(model);
  MeshLoader loader(test::meshPolicy());
  Moving moving{test::readWith(loader, robot.urdf), name, {}};
  workload.descriptions[name + "_description"] = robot.urdf;
  workload.descriptions[name + "_semantic"] = robot.srdf;
  XmlRpc::XmlRpcValue& robots = workload.params["robots"];
  XmlRpc::XmlRpcValue& entry = robots[robots.valid() ? robots.size() : 0];
  entry["name"] = name;
  entry["description"] = name + "_description";
  entry["semantic"] = name + "_semantic";
  entry["tf_prefix"] = name;
  for (std::size_t link = 0; link < moving.model.links.size(); ++link) {
    moving.message.transforms.push_back(frameOf(moving.model, link, name));
    workload.bodies += moving.model.links[link].has_collision;
  }
  return moving;
}

/// Places a robot, with all joints at zero.
void rest(Moving& robot, const Pose& world_from_root) {
  for (std::size_t link = 0; link < robot.model.links.size(); ++link) {
    setPose(link == 0 ? world_from_root : robot.model.links[link].parent_from_joint,
            robot.message.transforms[link].transform);
  }
}

/// Returns a workload without robots. Also adds the folder of the robots to ROS_PACKAGE_PATH.
Workload emptyWorld(const std::string& title, double rate) {
  const char* others = std::getenv("ROS_PACKAGE_PATH");  // the node needs it to find meshes with package:// paths
  setenv("ROS_PACKAGE_PATH", (test::sharedData() + ":" + (others == nullptr ? "" : others)).c_str(), 1);
  Workload workload;
  workload.title = title;
  workload.rate = rate;
  workload.params["rate"] = rate;
  workload.params["world_frame"] = "world";
  return workload;
}

}  // namespace

std::vector<Workload> realRobots(double rate) {
  if (test::sharedData().empty()) return {};
  Workload workload = emptyWorld("UR5, Panda and PR2, distances measured", rate);
  workload.distances = true;
  auto robots = std::make_shared<std::vector<Moving>>();
  for (const std::string name : {"ur5", "panda", "pr2"}) robots->push_back(addRobot(workload, name, name));
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

Workload pandas(int count, double rate) {
  Workload workload = emptyWorld(std::to_string(count) + " Pandas", rate);
  auto robots = std::make_shared<std::vector<Moving>>();
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  for (int i = 0; i < count; ++i) {
    robots->push_back(addRobot(workload, "panda" + std::to_string(i), "panda"));
    rest(robots->back(), Pose(Eigen::Translation3d(kApart * (i % side), kApart * (i / side), 0.0)));
  }
  workload.move = [robots](double) {
    std::vector<tf2_msgs::TFMessage> messages;
    for (const Moving& robot : *robots) messages.push_back(robot.message);
    return messages;
  };
  return workload;
}

Workload pandaAmong(const std::vector<OrientedBox>& boxes, double rate) {
  Workload workload = emptyWorld("Panda among " + std::to_string(boxes.size()) + " boxes", rate);
  auto robot = std::make_shared<Moving>(addRobot(workload, "panda", "panda"));
  rest(*robot, Pose::Identity());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    XmlRpc::XmlRpcValue& obstacle = workload.params["obstacles"][static_cast<int>(i)];
    const Eigen::Quaterniond turn(boxes[i].world_from_box.linear());
    obstacle["name"] = "b" + std::to_string(i);
    obstacle["shapes"][0]["type"] = "box";
    for (int axis = 0; axis < 3; ++axis) {
      obstacle["shapes"][0]["size"][axis] = boxes[i].size[axis];
      obstacle["pose"]["xyz"][axis] = boxes[i].world_from_box.translation()[axis];
    }
    for (int k = 0; k < 4; ++k) obstacle["pose"]["quaternion"][k] = turn.coeffs()[k];
  }
  workload.bodies += boxes.size();
  workload.move = [robot](double) { return std::vector<tf2_msgs::TFMessage>{robot->message}; };
  return workload;
}

}  // namespace bench
}  // namespace hgrid
