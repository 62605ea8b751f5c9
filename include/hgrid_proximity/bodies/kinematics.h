// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/robot_model.h"

namespace hgrid {

/// One of the numbers that describe how the joints of a robot stand.
///
/// - A revolute or prismatic joint has one variable, which has the name of the joint.
/// - A planar joint has three: `<joint>/x` and `<joint>/y` [m], then `<joint>/theta` [rad].
/// - A floating joint has seven: `<joint>/trans_x`, `trans_y`, `trans_z` [m], then the quaternion `<joint>/rot_x`,
///   `rot_y`, `rot_z`, `rot_w`.
/// - A fixed joint has none, and neither has a joint that mimics another joint.
struct JointVariable {
  std::string name;       ///< name of the variable
  std::string joint;      ///< name of its joint
  double lower = 0.0;     ///< [rad] or [m] lower limit; -infinity: none
  double upper = 0.0;     ///< [rad] or [m] upper limit; infinity: none
  bool is_angle = false;  ///< whether it is an angle [rad]
  /// Whether it is the angle of a continuous or planar joint, for which a full turn is the same pose. A revolute joint
  /// whose limits are not known is none: its controller may count turns.
  bool is_continuous = false;
  /// Whether another joint mimics its joint. Only Kinematics::variables() has this.
  bool is_mimicked = false;
  /// Index of the first of the four variables of the quaternion that it belongs to; -1: it belongs to none.
  int quaternion = -1;

  /// Returns whether adding a full turn to its value does not change where the links are: its joint is continuous or
  /// planar, and no joint mimics it. Such a joint can take the shorter way around the circle.
  bool turnsFreely() const { return is_continuous && !is_mimicked; }
};

/// Appends the variables that the joint of a link has if it does not mimic another joint.
void appendVariables(const RobotLink& link, std::vector<JointVariable>& variables);

/// Appends the values of these variables with which a link has a given pose in its parent link. Of a pose that the
/// joint cannot reach, only the part counts that the joint can follow. An angle is within the limits of its joint if
/// another full turn brings it there; otherwise it is between -pi and pi.
void appendValues(const RobotLink& link, const Pose& parent_from_link, std::vector<double>& values);

/// The joints of a robot, prepared for computing the poses of its links. Immutable; copies share memory.
///
/// A joint moves its link in the frame that RobotLink::parent_from_joint describes. A revolute joint turns the link
/// about RobotLink::axis, and a prismatic joint shifts the link along this axis. A planar joint shifts the link by x
/// and y in the plane that is perpendicular to the axis, then turns the link about the axis by theta. Its x direction
/// is the x axis of the frame, projected onto the plane. If the axis is nearly parallel to x (a component above 0.9),
/// it is the projected y axis instead. Its y direction is the cross product of the axis and its x direction.
class Kinematics {
 public:
  /// @param model  a robot model; findRigidGroups() must have been called for it
  /// @throws Refusal unknown_id if a joint mimics a joint that the model does not have
  /// @throws Refusal unsupported if it mimics a joint that does not have exactly one variable, if it is planar or
  /// floating itself, or if joints mimic each other in a loop
  /// @throws Refusal nonfinite if a multiplier or an offset is not finite
  /// @throws Refusal bad_geometry if a joint that needs an axis has none
  explicit Kinematics(const RobotModel& model);

  /// Returns the name of the robot in the URDF.
  const std::string& name() const;
  /// Returns the variables. A state of the robot is one value for each of them, in this order.
  const std::vector<JointVariable>& variables() const;
  /// Returns the index of the variable with this name, or -1.
  int find(const std::string& variable) const;
  /// Returns the names of the links, by their index in the model.
  const std::vector<std::string>& links() const;
  /// Returns the index of the rigid group of each link.
  const std::vector<std::uint32_t>& groupOfLink() const;
  /// Returns the pose of each link in the frame of the first link of its rigid group.
  const std::vector<Pose>& groupFromLink() const;

  /// Returns the poses of all links in the root frame, for one state.
  /// @param state  one value for each variable, in the order of variables(); quaternions must be unit quaternions
  std::vector<Pose> rootFromLinks(const std::vector<double>& state) const;

  struct State;  ///< the prepared joints; private to the library
  /// Returns the prepared joints. Only the library itself can use the result.
  const State& state() const { return *state_; }

 private:
  std::shared_ptr<const State> state_;
};

}  // namespace hgrid
