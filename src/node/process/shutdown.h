// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

namespace hgrid {

/// Makes SIGINT, SIGTERM and SIGHUP end the node in the same way: roscpp unregisters the node from the master, then
/// ros::waitForShutdown() returns. If the process still runs two seconds after the first of these signals, for example
/// because the master does not answer, it ends at once with exit code 0. If SIGHUP is ignored before this call, as
/// under nohup, it stays ignored.
///
/// Call this once, before ros::init(), which must be given ros::init_options::NoSigintHandler.
void shutDownOnSignals();

/// Returns whether one of these signals has arrived. Any thread may call this.
bool endRequested();

}  // namespace hgrid
