// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
// proximity_node: which robot links and obstacles are near each other? See README.md.

#include <ros/ros.h>

#include <exception>

#include "proximity_node.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "proximity");
  ros::NodeHandle node, private_node("~");
  try {
    const hgrid::ProximityNode proximity(node, private_node);
    ros::waitForShutdown();
  } catch (const std::exception& error) {  // while a node handle lives: with the last one roscpp closes the log
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return 0;
}
