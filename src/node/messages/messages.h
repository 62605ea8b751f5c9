// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Bodies.h>
#include <hgrid_proximity/Code.h>
#include <hgrid_proximity/Status.h>
#include <hgrid_proximity/WorldState.h>

#include "node/diagnostics/ledger.h"
#include "node/params/params.h"
#include "node/tick/stopwatch.h"
#include "node/tick/tick.h"

namespace hgrid {

// From the product's values to its messages. Every function here only copies.

namespace msg = ::hgrid_proximity;

ros::Time toRos(Time time);
geometry_msgs::Vector3 toVector(const Eigen::Vector3d& vector);
geometry_msgs::Point toPoint(const Eigen::Vector3d& point);
geometry_msgs::Pose toPose(const Pose& pose);

msg::Code toMsg(Code code, const std::string& sentence);

/// Stamp and world frame of a tick; stamp 0 while there is no world.
std_msgs::Header headerOf(const Tick& tick);
/// Why candidate pairs may be missing from a snapshot's list, as a reason of an incomplete world. Empty if none are.
std::string truncationOf(const Snapshot& snapshot);
/// @param age_since  [s] that passed since the tick was made
msg::WorldState worldState(const Tick& tick, const Params& params, std::uint64_t config_hash, double age_since);
msg::Bodies bodies(const Tick& tick);
msg::Status status(const Tick& tick, const msg::WorldState& world, const Params& params, const Ledger& ledger,
                   const Stopwatch& stopwatch);

}  // namespace hgrid
