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

// Parts of messages from values of the library.

namespace msg = ::hgrid_proximity;

ros::Time toRos(Time time);
geometry_msgs::Vector3 toVector(const Eigen::Vector3d& vector);
geometry_msgs::Point toPoint(const Eigen::Vector3d& point);
geometry_msgs::Pose toPose(const Pose& pose);
msg::Code toMsg(Code code, const std::string& sentence);
/// Time and world frame of a tick; time 0 while there is no world.
std_msgs::Header headerOf(const Tick& tick);
/// The first `most` strings.
std::vector<std::string> firstOf(const std::vector<std::string>& all, std::size_t most);

}  // namespace hgrid
