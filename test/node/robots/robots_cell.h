// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <gtest/gtest.h>
#include <ros/node_handle.h>

#include <memory>
#include <string>
#include <vector>

#include "robots_puppets.h"
#include "robots_witness.h"

namespace hgrid {
namespace test {

constexpr double kMargin = 0.1;       // [m] as in robots.test
constexpr double kPeriod = 1.0 / 50;  // [s] as in robots.test

/// One of the three robots.
struct Robot {
  std::string name;
  std::size_t bodies, shapes;  ///< links with <collision>, and their shapes, as counted in its URDF
  Eigen::Vector3d base;        ///< [m] of its root in the world, near the others
  double yaw;                  ///< [rad]
  std::unique_ptr<WitnessRobot> witness;

  Eigen::Isometry3d worldFromRoot() const;
};

/// UR5, Panda and PR2 with their robot_state_publishers, and the node beside them.
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

/// A cell for the tests of a suite; they begin when the node has a complete world.
class RobotsTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite();
  static void TearDownTestSuite();
  void SetUp() override;

  static Cell* cell_;
};

}  // namespace test
}  // namespace hgrid
