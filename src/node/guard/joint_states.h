// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "hgrid_proximity/world/snapshot.h"
#include "node/params/params.h"
#include "node/wire/scene_types.h"

namespace hgrid {

/// Returns the name of the topic with the joint states of a robot: `joint_states` of its entry in ~robots, or else
/// "joint_states" where its robot_state_publisher listens in most cases: in the namespace of its description, or if the
/// description has none, in the namespace that is its tf_prefix.
std::string jointStatesTopic(const RobotParams& robot);

/// The newest positions of joints in messages of sensor_msgs/JointState. Any thread may use it.
class JointStates {
 public:
  /// Stores the positions of a message. A position that is not finite is not known.
  /// @param topic    as jointStatesTopic() returns it
  /// @param arrival  [ROS time] counts if the message has no stamp
  void take(const std::string& topic, const moveit::JointState& message, Time arrival);
  /// Forgets the messages of a topic.
  void forget(const std::string& topic);
  /// Returns where a joint is [rad or m] according to a message; nullopt: no message about this time tells.
  /// @param time        [ROS time]
  /// @param most_apart  [s] largest difference between this time and the stamp of the message
  std::optional<double> position(const std::string& topic, const std::string& robot, const std::string& joint,
                                 Time time, double most_apart) const;

 private:
  struct Position {
    double value = 0.0;
    Time stamp{0};
  };
  using Positions = std::map<std::string, Position>;  // by name of the joint

  mutable std::mutex mutex_;
  std::map<std::string, Positions> topics_;  // guarded by mutex_
};

}  // namespace hgrid
