// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Vector3.h>

#include <cstdint>
#include <string>
#include <vector>

#include "node/wire/scene_types.h"

namespace hgrid {
namespace moveit {

// The messages of the service moveit_msgs/GetStateValidity of Noetic, with the names and fields of moveit_msgs.

struct JointConstraint {
  std::string joint_name;
  double position = 0.0, tolerance_above = 0.0, tolerance_below = 0.0, weight = 0.0;
};

struct BoundingVolume {
  std::vector<shape_msgs::SolidPrimitive> primitives;
  std::vector<geometry_msgs::Pose> primitive_poses;
  std::vector<shape_msgs::Mesh> meshes;
  std::vector<geometry_msgs::Pose> mesh_poses;
};

struct PositionConstraint {
  std_msgs::Header header;
  std::string link_name;
  geometry_msgs::Vector3 target_point_offset;
  BoundingVolume constraint_region;
  double weight = 0.0;
};

struct OrientationConstraint {
  std_msgs::Header header;
  geometry_msgs::Quaternion orientation;
  std::string link_name;
  double absolute_x_axis_tolerance = 0.0, absolute_y_axis_tolerance = 0.0, absolute_z_axis_tolerance = 0.0;
  std::uint8_t parameterization = 0;
  double weight = 0.0;
};

struct VisibilityConstraint {
  double target_radius = 0.0;
  geometry_msgs::PoseStamped target_pose;
  std::int32_t cone_sides = 0;
  geometry_msgs::PoseStamped sensor_pose;
  double max_view_angle = 0.0, max_range_angle = 0.0;
  std::uint8_t sensor_view_direction = 0;
  double weight = 0.0;
};

struct Constraints {
  std::string name;
  std::vector<JointConstraint> joint_constraints;
  std::vector<PositionConstraint> position_constraints;
  std::vector<OrientationConstraint> orientation_constraints;
  std::vector<VisibilityConstraint> visibility_constraints;
};

struct ContactInformation {
  enum BodyType : std::uint32_t { ROBOT_LINK = 0, WORLD_OBJECT = 1, ROBOT_ATTACHED = 2 };

  std_msgs::Header header;
  geometry_msgs::Point position;
  geometry_msgs::Vector3 normal;
  double depth = 0.0;
  std::string contact_body_1;
  std::uint32_t body_type_1 = ROBOT_LINK;
  std::string contact_body_2;
  std::uint32_t body_type_2 = ROBOT_LINK;
};

struct CostSource {
  double cost_density = 0.0;
  geometry_msgs::Vector3 aabb_min, aabb_max;
};

struct ConstraintEvalResult {
  std::uint8_t result = 0;
  double distance = 0.0;
};

struct GetStateValidity {
  struct Request {
    RobotState robot_state;
    std::string group_name;
    Constraints constraints;
  };
  struct Response {
    std::uint8_t valid = 0;
    std::vector<ContactInformation> contacts;
    std::vector<CostSource> cost_sources;
    std::vector<ConstraintEvalResult> constraint_result;
  };
};

}  // namespace moveit
}  // namespace hgrid

namespace ros {
namespace serialization {

// Reads and writes the fields of each type in the order in which moveit_msgs sends them.

template <>
struct Serializer<hgrid::moveit::JointConstraint> {
  template <typename Stream, typename Constraint>
  static void allInOne(Stream& stream, Constraint constraint) {
    stream.next(constraint.joint_name);
    stream.next(constraint.position);
    stream.next(constraint.tolerance_above);
    stream.next(constraint.tolerance_below);
    stream.next(constraint.weight);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::BoundingVolume> {
  template <typename Stream, typename Volume>
  static void allInOne(Stream& stream, Volume volume) {
    stream.next(volume.primitives);
    stream.next(volume.primitive_poses);
    stream.next(volume.meshes);
    stream.next(volume.mesh_poses);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::PositionConstraint> {
  template <typename Stream, typename Constraint>
  static void allInOne(Stream& stream, Constraint constraint) {
    stream.next(constraint.header);
    stream.next(constraint.link_name);
    stream.next(constraint.target_point_offset);
    stream.next(constraint.constraint_region);
    stream.next(constraint.weight);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::OrientationConstraint> {
  template <typename Stream, typename Constraint>
  static void allInOne(Stream& stream, Constraint constraint) {
    stream.next(constraint.header);
    stream.next(constraint.orientation);
    stream.next(constraint.link_name);
    stream.next(constraint.absolute_x_axis_tolerance);
    stream.next(constraint.absolute_y_axis_tolerance);
    stream.next(constraint.absolute_z_axis_tolerance);
    stream.next(constraint.parameterization);
    stream.next(constraint.weight);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::VisibilityConstraint> {
  template <typename Stream, typename Constraint>
  static void allInOne(Stream& stream, Constraint constraint) {
    stream.next(constraint.target_radius);
    stream.next(constraint.target_pose);
    stream.next(constraint.cone_sides);
    stream.next(constraint.sensor_pose);
    stream.next(constraint.max_view_angle);
    stream.next(constraint.max_range_angle);
    stream.next(constraint.sensor_view_direction);
    stream.next(constraint.weight);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::Constraints> {
  template <typename Stream, typename Constraints>
  static void allInOne(Stream& stream, Constraints constraints) {
    stream.next(constraints.name);
    stream.next(constraints.joint_constraints);
    stream.next(constraints.position_constraints);
    stream.next(constraints.orientation_constraints);
    stream.next(constraints.visibility_constraints);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::ContactInformation> {
  template <typename Stream, typename Contact>
  static void allInOne(Stream& stream, Contact contact) {
    stream.next(contact.header);
    stream.next(contact.position);
    stream.next(contact.normal);
    stream.next(contact.depth);
    stream.next(contact.contact_body_1);
    stream.next(contact.body_type_1);
    stream.next(contact.contact_body_2);
    stream.next(contact.body_type_2);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::CostSource> {
  template <typename Stream, typename Source>
  static void allInOne(Stream& stream, Source source) {
    stream.next(source.cost_density);
    stream.next(source.aabb_min);
    stream.next(source.aabb_max);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::ConstraintEvalResult> {
  template <typename Stream, typename Result>
  static void allInOne(Stream& stream, Result result) {
    stream.next(result.result);
    stream.next(result.distance);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::GetStateValidity::Request> {
  template <typename Stream, typename Request>
  static void allInOne(Stream& stream, Request request) {
    stream.next(request.robot_state);
    stream.next(request.group_name);
    stream.next(request.constraints);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<hgrid::moveit::GetStateValidity::Response> {
  template <typename Stream, typename Response>
  static void allInOne(Stream& stream, Response response) {
    stream.next(response.valid);
    stream.next(response.contacts);
    stream.next(response.cost_sources);
    stream.next(response.constraint_result);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

}  // namespace serialization

namespace service_traits {

template <>
struct MD5Sum<hgrid::moveit::GetStateValidity::Request> {
  static const char* value() { return "06ea62db671e4dbf878eaca241db51ad"; }
};
template <>
struct DataType<hgrid::moveit::GetStateValidity::Request> {
  static const char* value() { return "moveit_msgs/GetStateValidity"; }
};

}  // namespace service_traits

namespace message_traits {

template <>
struct DataType<hgrid::moveit::GetStateValidity::Request> {
  static const char* value() { return "moveit_msgs/GetStateValidityRequest"; }
};
template <>
struct DataType<hgrid::moveit::GetStateValidity::Response> {
  static const char* value() { return "moveit_msgs/GetStateValidityResponse"; }
};

}  // namespace message_traits
}  // namespace ros
