// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/guard/joint_states.h"

#include <cmath>

#include "node/time/ros_time.h"

namespace hgrid {
namespace {

constexpr std::size_t kMostJoints = 10000;  // of one topic

}  // namespace

std::string jointStatesTopic(const RobotParams& robot) {
  if (!robot.joint_states.empty()) return robot.joint_states;
  const std::size_t slash = robot.description.rfind('/');
  if (slash != std::string::npos && slash > 0) return robot.description.substr(0, slash) + "/joint_states";
  if (!robot.tf_prefix.empty()) return robot.tf_prefix + "/joint_states";
  return slash == 0 ? "/joint_states" : "joint_states";
}

void JointStates::take(const std::string& topic, const moveit::JointState& message, Time arrival) {
  const ros::Time stamp = message.header.stamp;
  const Time time = stamp.isZero() ? arrival : fromRos(stamp);
  const std::lock_guard<std::mutex> lock(mutex_);
  Positions& positions = topics_[topic];
  for (std::size_t i = 0; i < message.name.size() && i < message.position.size(); ++i) {
    const std::string& joint = message.name[i];
    if (!std::isfinite(message.position[i])) {
      positions.erase(joint);
    } else if (positions.size() < kMostJoints || positions.count(joint) > 0) {
      positions[joint] = {message.position[i], time};
    }
  }
}

void JointStates::forget(const std::string& topic) {
  const std::lock_guard<std::mutex> lock(mutex_);
  topics_.erase(topic);
}

std::optional<double> JointStates::position(const std::string& topic, const std::string& robot,
                                            const std::string& joint, Time time, double most_apart) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto positions = topics_.find(topic);
  if (positions == topics_.end()) return std::nullopt;
  for (const std::string& name : {joint, robot + "/" + joint}) {
    const auto found = positions->second.find(name);
    if (found == positions->second.end()) continue;
    if (std::abs(seconds(found->second.stamp - time)) <= most_apart) return found->second.value;
  }
  return std::nullopt;
}

}  // namespace hgrid
