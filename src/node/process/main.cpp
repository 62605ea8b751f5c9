// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
// proximity_node: reports which robot links and obstacles are near each other. See README.md. kUsage in
// command_line.cpp lists the options and exit codes.

#include <ros/ros.h>

#include <cstdio>
#include <exception>
#include <optional>

#include "node/process/command_line.h"
#include "node/process/name_holder.h"
#include "node/process/name_watch.h"
#include "node/process/proximity_node.h"
#include "node/process/shutdown.h"

int main(int argc, char** argv) {
  hgrid::CommandLine line;
  try {
    line = hgrid::readCommandLine(argc, argv);
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "proximity_node: %s\n", error.what()), 2;
  }
  if (line.help) return std::fputs(hgrid::kUsage, stdout), 0;

  hgrid::shutDownOnSignals();  // before ros::init(), which may wait for the master
  ros::init(argc, argv, "proximity", ros::init_options::NoSigintHandler);
  if (const std::optional<int> code = hgrid::exitCodeOfNameConflict(line.name_conflict)) return *code;
  const hgrid::NameWatch name_watch;
  ros::NodeHandle node, private_node("~");
  // roscpp reads this parameter at the first log line, and thereby registers the node at the master. If the first line
  // said that another node has taken the name, this registration would end that other node.
  bool ignored = false;
  ros::param::getCached("/rosout_disable_topics_generation", ignored);
  try {
    const hgrid::ProximityNode proximity(node, private_node);
    ros::waitForShutdown();
  } catch (const std::exception& error) {  // node handles still exist: the last one closes the log
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return name_watch.nameTaken() ? hgrid::NameWatch::kExitCode : 0;
}
