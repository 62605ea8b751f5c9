// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/to_messages.h"

#include <algorithm>

namespace hgrid {

ros::Time toRos(Time time) {
  return ros::Time().fromNSec(static_cast<std::uint64_t>(std::max<std::int64_t>(0, time.count())));
}

geometry_msgs::Point toPoint(const Eigen::Vector3d& point) {
  geometry_msgs::Point result;
  result.x = point.x();
  result.y = point.y();
  result.z = point.z();
  return result;
}

geometry_msgs::Vector3 toVector(const Eigen::Vector3d& vector) {
  geometry_msgs::Vector3 result;
  result.x = vector.x();
  result.y = vector.y();
  result.z = vector.z();
  return result;
}

geometry_msgs::Pose toPose(const Pose& pose) {
  geometry_msgs::Pose result;
  const Eigen::Quaterniond rotation(pose.linear());
  result.position = toPoint(pose.translation());
  result.orientation.x = rotation.x();
  result.orientation.y = rotation.y();
  result.orientation.z = rotation.z();
  result.orientation.w = rotation.w();
  return result;
}

msg::Code toMsg(Code code, const std::string& sentence) {
  msg::Code result;
  result.value = static_cast<std::uint16_t>(code);
  result.name = name(code);
  result.text = sentence;
  return result;
}

std_msgs::Header headerOf(const Tick& tick) {
  std_msgs::Header header;
  header.frame_id = tick.world_frame;
  if (tick.snapshot) header.stamp = toRos(tick.snapshot->stamp());
  return header;
}

std::vector<std::string> firstOf(const std::vector<std::string>& all, std::size_t most) {
  return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), most))};
}

std::vector<std::string> shortened(const std::vector<std::string>& all, std::size_t most) {
  std::vector<std::string> result = firstOf(all, most);
  if (result.size() < all.size()) result.push_back("... and " + std::to_string(all.size() - result.size()) + " more");
  return result;
}

}  // namespace hgrid
