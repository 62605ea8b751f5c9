// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/Twist.h>
#include <geometry_msgs/Wrench.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/service_traits.h>
#include <shape_msgs/Mesh.h>
#include <shape_msgs/Plane.h>
#include <shape_msgs/SolidPrimitive.h>
#include <std_msgs/ColorRGBA.h>
#include <std_msgs/Header.h>

#include <cstdint>
#include <string>
#include <vector>

namespace hgrid {

/// The messages of moveit_msgs that describe a planning scene. Their names and fields are those of moveit_msgs of
/// Noetic, but that package is not needed: a message type of ROS is identified by a hash of its fields (MD5).
namespace moveit {

struct CollisionObject {
  enum Operation : std::int8_t { ADD = 0, REMOVE = 1, APPEND = 2, MOVE = 3 };

  std_msgs::Header header;
  geometry_msgs::Pose pose;  ///< [m] in header.frame_id
  std::string id;
  std::string type_key, type_db;
  std::vector<shape_msgs::SolidPrimitive> primitives;
  std::vector<geometry_msgs::Pose> primitive_poses;  ///< [m] in the frame of `pose`, as all poses of shapes
  std::vector<shape_msgs::Mesh> meshes;
  std::vector<geometry_msgs::Pose> mesh_poses;
  std::vector<shape_msgs::Plane> planes;
  std::vector<geometry_msgs::Pose> plane_poses;
  std::vector<std::string> subframe_names;
  std::vector<geometry_msgs::Pose> subframe_poses;
  std::int8_t operation = ADD;
};

/// The fields of trajectory_msgs/JointTrajectoryPoint. The node does not use them.
struct JointTrajectoryPoint {
  std::vector<double> positions, velocities, accelerations, effort;
  ros::Duration time_from_start;
};

/// The fields of trajectory_msgs/JointTrajectory.
struct JointTrajectory {
  std_msgs::Header header;
  std::vector<std::string> joint_names;
  std::vector<JointTrajectoryPoint> points;
};

struct AttachedCollisionObject {
  std::string link_name;
  CollisionObject object;
  std::vector<std::string> touch_links;
  JointTrajectory detach_posture;
  double weight = 0.0;
};

/// The fields of sensor_msgs/JointState.
struct JointState {
  std_msgs::Header header;
  std::vector<std::string> name;
  std::vector<double> position, velocity, effort;
};

/// The fields of sensor_msgs/MultiDOFJointState.
struct MultiDofJointState {
  std_msgs::Header header;
  std::vector<std::string> joint_names;
  std::vector<geometry_msgs::Transform> transforms;
  std::vector<geometry_msgs::Twist> twist;
  std::vector<geometry_msgs::Wrench> wrench;
};

struct RobotState {
  JointState joint_state;
  MultiDofJointState multi_dof_joint_state;
  std::vector<AttachedCollisionObject> attached_collision_objects;
  std::uint8_t is_diff = 0;
};

struct AllowedCollisionEntry {
  std::vector<std::uint8_t> enabled;
};

struct AllowedCollisionMatrix {
  std::vector<std::string> entry_names;
  std::vector<AllowedCollisionEntry> entry_values;
  std::vector<std::string> default_entry_names;
  std::vector<std::uint8_t> default_entry_values;
};

/// The fields of LinkPadding and of LinkScale.
struct LinkNumber {
  std::string link_name;
  double value = 0.0;
};

struct ObjectColor {
  std::string id;
  std_msgs::ColorRGBA color;
};

/// The fields of octomap_msgs/OctomapWithPose, with those of octomap_msgs/Octomap.
struct OctomapWithPose {
  std_msgs::Header header;
  geometry_msgs::Pose origin;
  std_msgs::Header octomap_header;
  std::uint8_t binary = 0;
  std::string id;
  double resolution = 0.0;
  std::vector<std::int8_t> data;
};

struct PlanningScene {
  std::string name;
  RobotState robot_state;
  std::string robot_model_name;
  std::vector<geometry_msgs::TransformStamped> fixed_frame_transforms;
  AllowedCollisionMatrix allowed_collision_matrix;
  std::vector<LinkNumber> link_padding, link_scale;
  std::vector<ObjectColor> object_colors;
  std::vector<CollisionObject> collision_objects;  ///< in moveit_msgs, a field of PlanningSceneWorld
  OctomapWithPose octomap;                         ///< in moveit_msgs, a field of PlanningSceneWorld
  std::uint8_t is_diff = 0;
};

/// The service moveit_msgs/GetPlanningScene of Noetic.
struct GetPlanningScene {
  /// Bits of Request::components.
  enum Component : std::uint32_t {
    attached_objects = 4,
    object_names = 8,
    object_geometry = 16,
    allowed_collision_matrix = 128,
    padding_and_scale = 256
  };

  struct Request {
    std::uint32_t components = 0;
  };
  struct Response {
    PlanningScene scene;
  };
};

/// The service moveit_msgs/ApplyPlanningScene of Noetic.
struct ApplyPlanningScene {
  struct Request {
    PlanningScene scene;
  };
  struct Response {
    std::uint8_t success = 0;
  };
};

/// The MD5 of a message type, as its publishers send it. Undefined for other types.
template <class Message>
inline constexpr const char* kMd5 = nullptr;
template <>
inline constexpr const char* kMd5<CollisionObject> = "dbba710596087da521c07564160dfccb";
template <>
inline constexpr const char* kMd5<AttachedCollisionObject> = "30199ef516f64c8bc1edb1084ce4584e";
template <>
inline constexpr const char* kMd5<PlanningScene> = "acfc50bcfd6c7b978066bfa7c786002c";

}  // namespace moveit
}  // namespace hgrid

namespace ros {
namespace serialization {

// Reads and writes the fields of each type in the order in which moveit_msgs sends them.

template <>
struct Serializer<hgrid::moveit::CollisionObject> {
  template <typename Stream, typename Object>
  static void allInOne(Stream& stream, Object object) {
    stream.next(object.header);
    stream.next(object.pose);
    stream.next(object.id);
    stream.next(object.type_key);
    stream.next(object.type_db);
    stream.next(object.primitives);
    stream.next(object.primitive_poses);
    stream.next(object.meshes);
    stream.next(object.mesh_poses);
    stream.next(object.planes);
    stream.next(object.plane_poses);
    stream.next(object.subframe_names);
    stream.next(object.subframe_poses);
    stream.next(object.operation);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::JointTrajectoryPoint> {
  template <typename Stream, typename Point>
  static void allInOne(Stream& stream, Point point) {
    stream.next(point.positions);
    stream.next(point.velocities);
    stream.next(point.accelerations);
    stream.next(point.effort);
    stream.next(point.time_from_start);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::JointTrajectory> {
  template <typename Stream, typename Trajectory>
  static void allInOne(Stream& stream, Trajectory trajectory) {
    stream.next(trajectory.header);
    stream.next(trajectory.joint_names);
    stream.next(trajectory.points);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::AttachedCollisionObject> {
  template <typename Stream, typename Attached>
  static void allInOne(Stream& stream, Attached attached) {
    stream.next(attached.link_name);
    stream.next(attached.object);
    stream.next(attached.touch_links);
    stream.next(attached.detach_posture);
    stream.next(attached.weight);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::JointState> {
  template <typename Stream, typename State>
  static void allInOne(Stream& stream, State state) {
    stream.next(state.header);
    stream.next(state.name);
    stream.next(state.position);
    stream.next(state.velocity);
    stream.next(state.effort);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::MultiDofJointState> {
  template <typename Stream, typename State>
  static void allInOne(Stream& stream, State state) {
    stream.next(state.header);
    stream.next(state.joint_names);
    stream.next(state.transforms);
    stream.next(state.twist);
    stream.next(state.wrench);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::RobotState> {
  template <typename Stream, typename State>
  static void allInOne(Stream& stream, State state) {
    stream.next(state.joint_state);
    stream.next(state.multi_dof_joint_state);
    stream.next(state.attached_collision_objects);
    stream.next(state.is_diff);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::AllowedCollisionEntry> {
  template <typename Stream, typename Entry>
  static void allInOne(Stream& stream, Entry entry) {
    stream.next(entry.enabled);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::AllowedCollisionMatrix> {
  template <typename Stream, typename Matrix>
  static void allInOne(Stream& stream, Matrix matrix) {
    stream.next(matrix.entry_names);
    stream.next(matrix.entry_values);
    stream.next(matrix.default_entry_names);
    stream.next(matrix.default_entry_values);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::LinkNumber> {
  template <typename Stream, typename Number>
  static void allInOne(Stream& stream, Number number) {
    stream.next(number.link_name);
    stream.next(number.value);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::ObjectColor> {
  template <typename Stream, typename Color>
  static void allInOne(Stream& stream, Color color) {
    stream.next(color.id);
    stream.next(color.color);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::OctomapWithPose> {
  template <typename Stream, typename Octomap>
  static void allInOne(Stream& stream, Octomap octomap) {
    stream.next(octomap.header);
    stream.next(octomap.origin);
    stream.next(octomap.octomap_header);
    stream.next(octomap.binary);
    stream.next(octomap.id);
    stream.next(octomap.resolution);
    stream.next(octomap.data);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::PlanningScene> {
  template <typename Stream, typename Scene>
  static void allInOne(Stream& stream, Scene scene) {
    stream.next(scene.name);
    stream.next(scene.robot_state);
    stream.next(scene.robot_model_name);
    stream.next(scene.fixed_frame_transforms);
    stream.next(scene.allowed_collision_matrix);
    stream.next(scene.link_padding);
    stream.next(scene.link_scale);
    stream.next(scene.object_colors);
    stream.next(scene.collision_objects);
    stream.next(scene.octomap);
    stream.next(scene.is_diff);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::GetPlanningScene::Request> {
  template <typename Stream, typename Request>
  static void allInOne(Stream& stream, Request request) {
    stream.next(request.components);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::GetPlanningScene::Response> {
  template <typename Stream, typename Response>
  static void allInOne(Stream& stream, Response response) {
    stream.next(response.scene);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::ApplyPlanningScene::Request> {
  template <typename Stream, typename Request>
  static void allInOne(Stream& stream, Request request) {
    stream.next(request.scene);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::ApplyPlanningScene::Response> {
  template <typename Stream, typename Response>
  static void allInOne(Stream& stream, Response response) {
    stream.next(response.success);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

}  // namespace serialization

namespace service_traits {

template <>
struct MD5Sum<hgrid::moveit::GetPlanningScene::Request> {
  static const char* value() { return "65cf69d3e7a0342e16374024d4eeef65"; }
};
template <>
struct DataType<hgrid::moveit::GetPlanningScene::Request> {
  static const char* value() { return "moveit_msgs/GetPlanningScene"; }
};
template <>
struct MD5Sum<hgrid::moveit::ApplyPlanningScene::Request> {
  static const char* value() { return "d4d1599e0b6f71a6a8a10cb34780619c"; }
};
template <>
struct DataType<hgrid::moveit::ApplyPlanningScene::Request> {
  static const char* value() { return "moveit_msgs/ApplyPlanningScene"; }
};

}  // namespace service_traits

namespace message_traits {

template <>
struct DataType<hgrid::moveit::GetPlanningScene::Request> {
  static const char* value() { return "moveit_msgs/GetPlanningSceneRequest"; }
};
template <>
struct DataType<hgrid::moveit::GetPlanningScene::Response> {
  static const char* value() { return "moveit_msgs/GetPlanningSceneResponse"; }
};
template <>
struct DataType<hgrid::moveit::ApplyPlanningScene::Request> {
  static const char* value() { return "moveit_msgs/ApplyPlanningSceneRequest"; }
};
template <>
struct DataType<hgrid::moveit::ApplyPlanningScene::Response> {
  static const char* value() { return "moveit_msgs/ApplyPlanningSceneResponse"; }
};

}  // namespace message_traits
}  // namespace ros
