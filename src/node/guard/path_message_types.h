// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Twist.h>
#include <ros/serialization.h>
#include <std_msgs/Header.h>

#include <cstdint>
#include <string>
#include <vector>

#include "node/wire/checked.h"
#include "node/wire/scene_types.h"

namespace hgrid {

/// MD5 of control_msgs/FollowJointTrajectoryActionGoal.
inline constexpr const char* kActionGoal = "cff5c1d533bf2f82dd0138d57f4304bb";

/// Messages with paths of robots. Their names and fields are those of moveit_msgs and control_msgs, but these packages
/// are not needed: a message type of ROS is identified by a hash of its fields (MD5).
namespace moveit {

/// The fields of trajectory_msgs/MultiDOFJointTrajectoryPoint.
struct MultiDofPoint {
  std::vector<geometry_msgs::Transform> transforms;
  std::vector<geometry_msgs::Twist> velocities, accelerations;
  ros::Duration time_from_start;
};

/// The fields of trajectory_msgs/MultiDOFJointTrajectory.
struct MultiDofTrajectory {
  std_msgs::Header header;
  std::vector<std::string> joint_names;
  std::vector<MultiDofPoint> points;
};

struct RobotTrajectory {
  JointTrajectory joint_trajectory;
  MultiDofTrajectory multi_dof_joint_trajectory;
};

struct DisplayTrajectory {
  std::string model_id;
  std::vector<RobotTrajectory> trajectory;
  RobotState trajectory_start;
};

/// The fields of control_msgs/JointTolerance.
struct JointTolerance {
  std::string name;
  double position = 0.0, velocity = 0.0, acceleration = 0.0;
};

/// The fields of control_msgs/FollowJointTrajectoryActionGoal, with those of its parts.
struct FollowJointTrajectoryActionGoal {
  std_msgs::Header header;
  ros::Time goal_stamp;
  std::string goal_id;
  JointTrajectory trajectory;
  std::vector<JointTolerance> path_tolerance, goal_tolerance;
  ros::Duration goal_time_tolerance;
};

/// The fields of actionlib_msgs/GoalID.
struct ActionGoalId {
  ros::Time stamp;
  std::string id;
};

/// The fields of actionlib_msgs/GoalStatus.
struct ActionGoalStatus {
  ActionGoalId goal;
  std::uint8_t status = 0;
  std::string text;
};

/// The fields of actionlib_msgs/GoalStatusArray.
struct ActionGoalStatusArray {
  std_msgs::Header header;
  std::vector<ActionGoalStatus> status_list;
};

/// The fields of control_msgs/FollowJointTrajectoryActionResult, with those of its parts.
struct FollowJointTrajectoryActionResult {
  std_msgs::Header header;
  ActionGoalStatus status;
  std::int32_t error_code = 0;
  std::string error_string;
};

}  // namespace moveit
}  // namespace hgrid

namespace ros {
namespace serialization {

template <>
struct Serializer<hgrid::moveit::MultiDofPoint> {
  template <typename Stream, typename Point>
  static void allInOne(Stream& stream, Point point) {
    stream.next(point.transforms);
    stream.next(point.velocities);
    stream.next(point.accelerations);
    stream.next(point.time_from_start);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::MultiDofTrajectory> {
  template <typename Stream, typename Trajectory>
  static void allInOne(Stream& stream, Trajectory trajectory) {
    stream.next(trajectory.header);
    stream.next(trajectory.joint_names);
    stream.next(trajectory.points);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::RobotTrajectory> {
  template <typename Stream, typename Trajectory>
  static void allInOne(Stream& stream, Trajectory trajectory) {
    stream.next(trajectory.joint_trajectory);
    stream.next(trajectory.multi_dof_joint_trajectory);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::DisplayTrajectory> {
  template <typename Stream, typename Display>
  static void allInOne(Stream& stream, Display display) {
    stream.next(display.model_id);
    stream.next(display.trajectory);
    stream.next(display.trajectory_start);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::JointTolerance> {
  template <typename Stream, typename Tolerance>
  static void allInOne(Stream& stream, Tolerance tolerance) {
    stream.next(tolerance.name);
    stream.next(tolerance.position);
    stream.next(tolerance.velocity);
    stream.next(tolerance.acceleration);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::FollowJointTrajectoryActionGoal> {
  template <typename Stream, typename Goal>
  static void allInOne(Stream& stream, Goal goal) {
    stream.next(goal.header);
    stream.next(goal.goal_stamp);
    stream.next(goal.goal_id);
    stream.next(goal.trajectory);
    stream.next(goal.path_tolerance);
    stream.next(goal.goal_tolerance);
    stream.next(goal.goal_time_tolerance);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::ActionGoalId> {
  template <typename Stream, typename Id>
  static void allInOne(Stream& stream, Id id) {
    stream.next(id.stamp);
    stream.next(id.id);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::ActionGoalStatus> {
  template <typename Stream, typename Status>
  static void allInOne(Stream& stream, Status status) {
    stream.next(status.goal);
    stream.next(status.status);
    stream.next(status.text);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::ActionGoalStatusArray> {
  template <typename Stream, typename Array>
  static void allInOne(Stream& stream, Array array) {
    stream.next(array.header);
    stream.next(array.status_list);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::FollowJointTrajectoryActionResult> {
  template <typename Stream, typename Result>
  static void allInOne(Stream& stream, Result result) {
    stream.next(result.header);
    stream.next(result.status);
    stream.next(result.error_code);
    stream.next(result.error_string);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

}  // namespace serialization
}  // namespace ros

namespace hgrid {

/// Returns the message in these bytes. @throws Refusal truncated
template <class Message>
Message readMessage(const std::string& bytes) {
  Checked<Message> message;
  message.read(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  return message.value();
}

}  // namespace hgrid
