// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Vector3.h>
#include <hgrid_proximity/Code.h>
#include <ros/time.h>
#include <std_msgs/Header.h>

#include <string>
#include <vector>

#include "hgrid_proximity/refusal.h"
#include "node/tick/tick.h"

namespace hgrid {

// Converts values of the library into parts of messages.

namespace msg = ::hgrid_proximity;

ros::Time toRos(Time time);
geometry_msgs::Vector3 toVector(const Eigen::Vector3d& vector);
geometry_msgs::Point toPoint(const Eigen::Vector3d& point);
geometry_msgs::Pose toPose(const Pose& pose);
msg::Code toMsg(Code code, const std::string& sentence);
/// Returns a header with the time and the world frame of a tick. The time is 0 while there is no world.
std_msgs::Header headerOf(const Tick& tick);
/// Returns the first strings of a list, at most `most`.
std::vector<std::string> firstOf(const std::vector<std::string>& all, std::size_t most);
/// Returns the same list. If there are more strings, the list ends with "... and N more" in addition.
std::vector<std::string> shortened(const std::vector<std::string>& all, std::size_t most);

}  // namespace hgrid
