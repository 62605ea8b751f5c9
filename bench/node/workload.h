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

/// A world for the node: how it is told of it, and how it moves.
struct Workload {
  std::string title;
  std::size_t bodies = 0;
  double rate = 100.0;                              ///< [Hz] of /tf and of the node's ticks
  bool distances = false;                           ///< somebody listens to ~distances, so that they are measured
  XmlRpc::XmlRpcValue params;                       ///< the node's private parameters
  std::map<std::string, std::string> descriptions;  ///< parameters beside the node
  /// The messages of one cycle of /tf at `t` [s]; their stamps are filled in when they are sent.
  std::function<std::vector<tf2_msgs::TFMessage>(double t)> move;
};

/// Robots on a square lattice, each a chain of `links` links: the first rides on a moving base, the others hang on
/// revolute joints. Boxes, cylinders and spheres in turn. As from robot_state_publisher: a message per robot.
Workload robots(std::size_t count, std::size_t links, double rate);

/// The same robots on the floor of a room of 6.4 x 6.4 x 3.2 m in a building, whose map comes on a topic in the frame
/// "map". `links`: 20 stand under the ceiling.
Workload robotsInBuilding(std::size_t count, std::size_t links, double rate, const std::string& topic);

/// Boxes, each an obstacle in a frame of its own, that fly about and turn; about one near neighbour per body. As from
/// a motion capture system: one message with all.
Workload freeBodies(std::size_t count, double rate);

/// UR5, Panda and PR2 beside each other, swinging all joints, where their descriptions are at hand (HGRID_TEST_DATA,
/// else
/// ../shared/data beside the project); none otherwise.
std::vector<Workload> realRobots(double rate);

}  // namespace bench
}  // namespace hgrid
