// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/duration.h>

#include <string>

#include "node/guard/robot_path.h"

namespace hgrid {

/// Longest time that a path may take [s].
inline constexpr double kLongestPath = 86400.0;

/// Returns the time of a point of a path.
/// @param index  index of the point, for the error sentence
/// @throws Refusal out_of_range if `from_start` is negative or longer than kLongestPath
Time timeOfPoint(Time start, const ros::Duration& from_start, std::size_t index);

/// The path that a message commands or plans, and when it starts.
struct PathCommand {
  RobotPath path;           ///< without the name of the robot; without points: the robot stops
  Time start;               ///< [ROS time] when the robot begins to move to the first point
  bool is_stamped = false;  ///< whether the message says when the path starts
  bool is_plan = false;     ///< whether the message only shows what may be commanded later
};

/// Reads a message that commands or plans a path: trajectory_msgs/JointTrajectory,
/// control_msgs/FollowJointTrajectoryActionGoal or moveit_msgs/DisplayTrajectory (of Noetic), whose parts
/// follow one another.
/// @param bytes    the serialized message
/// @param md5      of the type of the message
/// @param arrival  [ROS time] when the path starts, unless the trajectory has a stamp; the stamps of a
/// DisplayTrajectory do not count
/// @throws Refusal truncated; limit for too many positions; conflict for a joint that is named twice; out_of_range for
/// a point with the wrong number of positions or a time that is out of range; unsupported for another type, or for
/// joints that have several degrees of freedom
PathCommand readPathMessage(const std::string& bytes, const std::string& md5, Time arrival);

}  // namespace hgrid
