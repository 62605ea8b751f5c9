// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <set>
#include <string>

#include "hgrid_proximity/bodies/robot_model.h"

namespace hgrid {

// What robot_state_publisher cannot send. In version 1.15.2, and in those before, it sends a planar joint on
// /tf_static, as if it were fixed, and a floating joint not at all. A joint that follows another one it computes once
// per message, in the order of the names of the joints.

/// Returns the free frames of a robot: those of the links that a planar or floating joint moves.
std::set<std::string, std::less<>> freeFrames(const RobotModel& model, const std::string& tf_prefix);

/// Returns the frames of the links whose joint follows a follower that comes later, and why they are not sent, as the
/// end of a sentence. They are sent if the joint states contain the followed joint.
std::map<std::string, std::string> unsentFrames(const RobotModel& model, const std::string& tf_prefix);

}  // namespace hgrid
