// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/process/command_line.h"

#include <stdexcept>
#include <string>

#include "hgrid_proximity/refusal.h"

namespace hgrid {

const char* const kUsage =
    R"(usage: rosrun hgrid_proximity proximity_node [--wait | --replace] [REMAPPING...]

Reports which robot links, obstacles and map cells are near each other.

options:
  -h, --help  print this text and end, without a connection to the ROS master
  --wait      if a running node has the name of this node, wait until that node has ended, then start
  --replace   if a running node has the name of this node, start all the same; that node then ends
Without --wait and --replace, the node does not start if a running node has its name.

ROS remappings:
  __name:=NAME         name of the node; the default is proximity
  __ns:=NAMESPACE      namespace of the node
  _PARAMETER:=VALUE    value of a parameter, such as _margin:=0.2; config/params.yaml lists all parameters
  NAME:=OTHER_NAME     other name of a topic or parameter, such as robot_description:=/arm/robot_description

exit codes:
  0  the node was ended by SIGINT, SIGTERM, SIGHUP or `rosnode kill`
  1  the node could not start, for example because a parameter is wrong
  2  an argument is wrong
  3  another node took the name of this node
  4  a running node had the name of this node, so this node did not start
)";

CommandLine readCommandLine(int argc, const char* const* argv) {
  CommandLine line;
  bool wait = false, replace = false;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.find(":=") != std::string::npos) continue;
    if (word == "--help" || word == "-h") {
      line.help = true;
    } else if (word == "--wait") {
      wait = true;
    } else if (word == "--replace") {
      replace = true;
    } else {
      throw std::invalid_argument("the argument '" + printable(word) + "' is unknown; --help lists all options");
    }
  }
  if (wait && replace) throw std::invalid_argument("--wait and --replace exclude each other; give one of them");
  if (wait) line.name_conflict = NameConflict::wait;
  if (replace) line.name_conflict = NameConflict::replace;
  return line;
}

}  // namespace hgrid
