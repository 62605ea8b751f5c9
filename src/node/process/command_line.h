// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

namespace hgrid {

/// What the node does at its start if a running node already has its name.
enum class NameConflict {
  refuse,   ///< does not start
  wait,     ///< waits until the other node has ended
  replace,  ///< starts; the ROS master then ends the other node
};

/// The options of proximity_node.
struct CommandLine {
  bool help = false;
  NameConflict name_conflict = NameConflict::refuse;
};

/// The text that `--help` prints.
extern const char* const kUsage;

/// Reads the options. Ignores ROS remappings, which contain ":=".
/// @throws std::invalid_argument with one sentence if an argument is unknown, or if options contradict each other
CommandLine readCommandLine(int argc, const char* const* argv);

}  // namespace hgrid
