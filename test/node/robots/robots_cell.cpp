// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "robots_cell.h"

#include <geometry_msgs/TransformStamped.h>
#include <ros/param.h>
#include <tf2_msgs/TFMessage.h>

#include <regex>

#include "test/node/support/built.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {

Cell* RobotsTest::cell_ = nullptr;

namespace {

/// Returns the URDF with "PREFIX/" before the name of each link. (Some versions of robot_state_publisher have no
/// tf_prefix.)
std::string withPrefix(const std::string& prefix, const std::string& urdf) {
  return std::regex_replace(urdf, std::regex("link( name)?=\""), "$&" + prefix + "/");
}

}  // namespace

Eigen::Isometry3d Robot::worldFromRoot() const {
  return Eigen::Translation3d(base) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
}

Cell::Cell() {
  robots.push_back({"ur5", 8, 8, {0.8, 0.35, 0.6}, 2.5, nullptr});
  robots.push_back({"panda", 11, 17, {0.7, -0.35, 0.5}, 3.6, nullptr});
  robots.push_back({"pr2", 32, 32, {0.0, 0.0, 0.0}, 0.1, nullptr});
  std::vector<Puppeteer::Puppet> puppets;
  for (Robot& robot : robots) {
    const RealRobot real = realRobot(robot.name);
    robot.witness = std::make_unique<WitnessRobot>(real.urdf, real.srdf, [](const std::string& uri) {
      return sharedData() + "/" + uri.substr(std::string("package://").size());
    });
    ros::param::set("/" + robot.name + "/robot_description", real.urdf);
    ros::param::set("/" + robot.name + "/robot_description_semantic", real.srdf);
    ros::param::set("/" + robot.name + "/tf_description", withPrefix(robot.name, real.urdf));
    publishers.push_back(std::make_unique<Child>(
        std::vector<std::string>{"rosrun", "robot_state_publisher", "robot_state_publisher", "__ns:=/" + robot.name,
                                 "robot_description:=tf_description", "_publish_frequency:=200"}));
    puppets.push_back({robot.name, robot.witness.get()});
  }
  placeBases();
  proximity = std::make_unique<Child>(std::vector<std::string>{built(HGRID_NODE)});
  puppeteer = std::make_unique<Puppeteer>(node_, puppets, 7);
  pairs = std::make_unique<PairsListener>(node_);
}

void Cell::placeBases() {
  static_publisher_ = node_.advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
  tf2_msgs::TFMessage message;
  for (const Robot& robot : robots) {
    const Eigen::Quaterniond turn(robot.worldFromRoot().linear());
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = ros::Time::now();
    transform.header.frame_id = "world";
    transform.child_frame_id = robot.name + "/" + robot.witness->root();
    transform.transform.translation.x = robot.base.x();
    transform.transform.translation.y = robot.base.y();
    transform.transform.translation.z = robot.base.z();
    transform.transform.rotation.x = turn.x();
    transform.transform.rotation.y = turn.y();
    transform.transform.rotation.z = turn.z();
    transform.transform.rotation.w = turn.w();
    message.transforms.push_back(transform);
  }
  static_publisher_.publish(message);
}

void RobotsTest::SetUpTestSuite() {
  if (!sharedData().empty()) cell_ = new Cell;
}

void RobotsTest::TearDownTestSuite() {
  delete cell_;
  cell_ = nullptr;
}

void RobotsTest::SetUp() {
  HGRID_NEEDS_SHARED_DATA();
  const auto complete = [](const hgrid_proximity::Pairs& pairs) { return bool(pairs.world.complete); };
  ASSERT_TRUE(cell_->pairs->waitFor(complete, kPatience)) << "the world did not become complete within 30 s";
}

}  // namespace test
}  // namespace hgrid
