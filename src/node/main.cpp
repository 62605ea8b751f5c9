// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
// proximity_node: reports which robot links and obstacles are near each other. See README.md.
//
// Exit codes: 0 after SIGINT, SIGTERM, SIGHUP or `rosnode kill`; 1 if the node cannot start, for
// example because a parameter is wrong; NameWatch::kExitCode if another node has taken the name.

#include <ros/ros.h>

#include <exception>

#include "node/name_watch.h"
#include "node/proximity_node.h"
#include "node/shutdown.h"

int main(int argc, char** argv) {
  hgrid::shutDownOnSignals();  // before ros::init(), which may wait for the master
  ros::init(argc, argv, "proximity", ros::init_options::NoSigintHandler);
  const hgrid::NameWatch name_watch;
  ros::NodeHandle node, private_node("~");
  try {
    const hgrid::ProximityNode proximity(node, private_node);
    ros::waitForShutdown();
  } catch (const std::exception& error) {  // node handles still exist: the last one closes the log
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return name_watch.nameTaken() ? hgrid::NameWatch::kExitCode : 0;
}
