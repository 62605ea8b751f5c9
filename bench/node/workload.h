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

#include "hgrid_proximity/geometry/oriented_box.h"

namespace hgrid {
namespace bench {

/// A world for the node: the parameters that describe it, and a function that moves it.
struct Workload {
  std::string title;
  std::size_t bodies = 0;
  double rate = 100.0;                              ///< [Hz] rate of /tf and of the node's ticks
  bool distances = false;                           ///< whether to subscribe to ~distances
  bool by_poses = false;                            ///< whether ~poses moves the bodies, which are obstacles; else /tf
  XmlRpc::XmlRpcValue params;                       ///< the node's private parameters
  std::map<std::string, std::string> descriptions;  ///< robot descriptions: parameters in the node's namespace
  /// Returns the messages of one cycle of /tf at time `t` [s], without stamps. With `by_poses`, it returns one message,
  /// whose child frames are the names of the obstacles.
  std::function<std::vector<tf2_msgs::TFMessage>(double t)> move;
};

/// Returns robots on a square lattice. Each robot is a chain of `links` links, whose shapes are boxes, cylinders and
/// spheres in turn. The first link is on a moving base. Revolute joints connect the others. Each robot has its own
/// message, like the messages of robot_state_publisher.
Workload robots(std::size_t count, std::size_t links, double rate);

/// Returns the robots of robots(), but on the floor of a room of 6.4 x 6.4 x 3.2 m in a building. The node receives the
/// map of the building on `topic`, in the frame "map". Robots with up to 20 links fit under the ceiling.
Workload robotsInBuilding(std::size_t count, std::size_t links, double rate, const std::string& topic);

/// Returns the workload in a building. The node receives the map of the building on `topic`, in the frame "map".
Workload inBuilding(Workload workload, const std::string& topic);

/// Returns boxes that fly around and turn. Each box is an obstacle with its own frame and has about one near neighbor.
/// One message contains all frames, like the message of a motion capture system.
Workload freeBodies(std::size_t count, double rate);
/// The same, but messages of ~poses move the obstacles.
Workload freeBodiesByPoses(std::size_t count, double rate);
/// The same, but only the first `moving` bodies move. The others are obstacles that are fixed in the world.
Workload freeBodies(std::size_t count, std::size_t moving, double rate);

/// Returns one workload: UR5, Panda and PR2 beside each other. All their joints swing. Returns no workload if the robot
/// descriptions are not found in the folder HGRID_TEST_DATA. If that variable is not set, the folder is ../shared/data
/// beside the project.
std::vector<Workload> realRobots(double rate);
/// Returns `count` Pandas at rest on a square lattice, 1.2 m apart, with the names panda0, panda1, and so on. The root link
/// of the first one is at the origin of the world. The descriptions of the robots must exist, see realRobots().
Workload pandas(int count, double rate);
/// Returns a Panda that rests among fixed boxes. Its root link is at the origin of the world. The descriptions of the
/// robots must exist, see realRobots().
Workload pandaAmong(const std::vector<OrientedBox>& boxes, double rate);

}  // namespace bench
}  // namespace hgrid
