// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <gtest/gtest.h>
#include <ros/node_handle.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "robots_puppets.h"
#include "robots_witness.h"

namespace hgrid {
namespace test {

constexpr auto kPatience = std::chrono::seconds(30);  // how long a test waits for the node before it fails

constexpr double kPeriod = 1.0 / 50;  // [s] one period of ~rate in robots.test
constexpr double kMargin = 0.1;       // [m] value of ~margin in robots.test

/// One of the three robots.
struct Robot {
  std::string name;
  std::size_t bodies, shapes;  ///< number of links with <collision>, and number of shapes, in its URDF
  Eigen::Vector3d base;        ///< [m] position of its root in the world frame, near the other robots
  double yaw;                  ///< [rad] rotation of its root in the world frame
  std::unique_ptr<WitnessRobot> witness;

  Eigen::Isometry3d worldFromRoot() const;
};

/// A work cell: UR5, Panda and PR2 with their robot_state_publishers, and the node.
class Cell {
 public:
  Cell();

  std::vector<Robot> robots;
  std::vector<std::unique_ptr<Child>> publishers;
  std::unique_ptr<Child> proximity;
  std::unique_ptr<Puppeteer> puppeteer;
  std::unique_ptr<PairsListener> pairs;

 private:
  void placeBases();

  ros::NodeHandle node_;
  ros::Publisher static_publisher_;
};

/// Fixture whose tests share one Cell. Each test begins when the world of the node is complete.
class RobotsTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite();
  static void TearDownTestSuite();
  void SetUp() override;

  static Cell* cell_;
};

}  // namespace test
}  // namespace hgrid
