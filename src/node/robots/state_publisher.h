// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <set>
#include <string>

#include "hgrid_proximity/bodies/robot_model.h"

namespace hgrid {

// What robot_state_publisher (1.15.2 and older) cannot send:
// - It sends a planar joint on /tf_static, as if it were fixed, and a floating joint not at all.
// - It computes the joints that mimic other joints once per message, in the order of their names. So it never has a
//   position for a joint that mimics a mimic joint of a later name.

/// Returns the free frames of a robot: those of the links that a planar or floating joint moves.
std::set<std::string, std::less<>> freeFrames(const RobotModel& model, const std::string& tf_prefix);

/// Returns the frames of links whose joint mimics a mimic joint of a later name. The value of each entry says why
/// robot_state_publisher does not send the frame, as the end of a sentence. It does send the frame if the joint states
/// contain the joint that is mimicked.
std::map<std::string, std::string> unsentFrames(const RobotModel& model, const std::string& tf_prefix);

}  // namespace hgrid
