// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <XmlRpcValue.h>
#include <tf2_msgs/TFMessage.h>

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace hgrid {
namespace bench {

/// A world for the node: the parameters that describe it, and a function that moves it.
struct Workload {
  std::string title;
  std::size_t bodies = 0;
  double rate = 100.0;                              ///< [Hz] rate of /tf and of the node's ticks
  bool distances = false;                           ///< subscribe to ~distances, so that the node measures them
  XmlRpc::XmlRpcValue params;                       ///< the node's private parameters
  std::map<std::string, std::string> descriptions;  ///< further parameters in the node's namespace
  /// Returns the messages of one cycle of /tf at time `t` [s], without stamps.
  std::function<std::vector<tf2_msgs::TFMessage>(double t)> move;
};

/// Returns robots on a square lattice. Each robot is a chain of `links` links, which are boxes, cylinders and spheres
/// in turn. The first link is on a moving base; revolute joints connect the others. There is one message per robot, as
/// from robot_state_publisher.
Workload robots(std::size_t count, std::size_t links, double rate);

/// Returns the same robots on the floor of a room of 6.4 x 6.4 x 3.2 m in a building. The map of the building comes on
/// `topic`, in the frame "map". Robots with 20 links fit under the ceiling.
Workload robotsInBuilding(std::size_t count, std::size_t links, double rate, const std::string& topic);

/// Returns boxes that fly around and turn. Each box is an obstacle with its own frame and has about one near neighbor.
/// There is one message with all frames, as from a motion capture system.
Workload freeBodies(std::size_t count, double rate);

/// Returns one workload: UR5, Panda and PR2 beside each other, swinging all joints. Returns no workload if their
/// descriptions are not found. They are searched in HGRID_TEST_DATA or, if that is not set, in ../shared/data beside
/// the project.
std::vector<Workload> realRobots(double rate);

}  // namespace bench
}  // namespace hgrid
