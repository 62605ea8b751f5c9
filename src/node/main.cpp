// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
// proximity_node: which robot links and obstacles are near each other? See README.md.

#include <console_bridge/console.h>
#include <ros/ros.h>

#include <exception>

#include "proximity_node.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "proximity");
  // tf2 warns of every single transform that is old or comes twice; the node counts them.
  console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);
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
