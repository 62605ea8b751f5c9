// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/bodies/kinematics.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "bodies/forward_kinematics.h"
#include "geometry/arc_tangent.h"
#include "geometry/infinity.h"

namespace hgrid {
namespace {

std::string jointText(const RobotLink& link) { return "joint '" + printable(link.joint) + "'"; }

/// Stores a matrix in the order of rows.
std::array<double, 9> rowsOf(const Eigen::Matrix3d& matrix) {
  std::array<double, 9> rows{};
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 3; ++column) {
      rows[static_cast<std::size_t>(3 * row + column)] = matrix(row, column);
    }
  }
  return rows;
}

/// Returns the frame in which a planar joint moves: its z axis is the axis of the joint.
Pose jointFromPlane(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d side = Eigen::Vector3d::Unit(std::abs(axis.x()) > 0.9 ? 1 : 0);
  Pose tilted = Pose::Identity();
  tilted.linear().col(0) = (side - side.dot(axis) * axis).normalized();
  tilted.linear().col(1) = axis.cross(tilted.linear().col(0));
  tilted.linear().col(2) = axis;
  return tilted;
}

/// Returns the angle [rad] by which a rotation turns about an axis, in [-pi, pi].
double angleAbout(const Eigen::Vector3d& axis, const Eigen::Matrix3d& turn) {
  Eigen::Quaterniond rotation(turn);
  if (rotation.w() < 0.0) rotation.coeffs() = -rotation.coeffs();
  return 2.0 * arcTangent(rotation.vec().dot(axis), rotation.w());
}

/// Returns the angle that turns a link in the same way and is within the limits of its joint, if there is one.
double withinLimits(const RobotLink& link, double angle) {
  constexpr double kTurn = 2.0 * M_PI, kSlack = 1e-6;  // [rad]
  if (link.continuous || (link.lower == 0.0 && link.upper == 0.0)) return angle;
  for (const double other : {angle, angle - kTurn, angle + kTurn}) {
    if (other >= link.lower - kSlack && other <= link.upper + kSlack) return other;
  }
  return angle;
}

/// Fills the rotation and translation of a joint. @param parent_from_joint  pose of the joint in its parent group
void setPoses(const RobotLink& link, const Pose& parent_from_joint, JointMotion& joint) {
  const Eigen::Matrix3d origin = parent_from_joint.linear();
  Eigen::Matrix3d across;  // multiplies a vector with the axis, from the left
  across << 0.0, -link.axis.z(), link.axis.y(), link.axis.z(), 0.0, -link.axis.x(), -link.axis.y(), link.axis.x(), 0.0;
  joint.turn = {rowsOf(origin), rowsOf(origin * across), rowsOf(origin * across * across)};
  const Eigen::Vector3d slide = origin * link.axis;
  for (std::size_t i = 0; i < 3; ++i) {
    joint.shift[i] = parent_from_joint.translation()[static_cast<Eigen::Index>(i)];
    if (link.joint_kind == JointKind::prismatic) joint.slide[i] = slide[static_cast<Eigen::Index>(i)];
  }
  joint.axis = link.axis;
  joint.parent_from_plane = parent_from_joint;
  if (link.joint_kind != JointKind::planar) return;
  const Pose tilted = jointFromPlane(link.axis);
  joint.parent_from_plane = parent_from_joint * tilted;
  joint.plane_from_child = tilted.inverse();
}

/// A joint that does not mimic, and how the position of a joint follows from it.
struct Master {
  const RobotLink* link;
  double multiplier = 1.0, offset = 0.0;
};

/// Follows RobotLink::mimic to the joint that does not mimic. @throws Refusal unknown_id, unsupported, nonfinite
Master masterOf(const RobotLink& link, const std::map<std::string, const RobotLink*>& by_joint) {
  Master master{&link};
  for (std::size_t steps = 0; !master.link->mimic.empty(); ++steps) {
    const RobotLink& at = *master.link;
    if (!std::isfinite(at.mimic_multiplier) || !std::isfinite(at.mimic_offset)) {
      throw Refusal(Code::nonfinite, jointText(at) + " mimics with the multiplier " + text(at.mimic_multiplier) +
                                         " and the offset " + text(at.mimic_offset) + "; both must be finite");
    }
    const auto found = by_joint.find(at.mimic);
    if (found == by_joint.end()) {
      throw Refusal(Code::unknown_id, jointText(at) + " mimics joint '" + printable(at.mimic) +
                                          "', which the robot does not have; it must mimic a joint of the robot");
    }
    if (steps == by_joint.size()) {
      throw Refusal(Code::unsupported, jointText(link) + " mimics itself through joint '" + printable(at.joint) +
                                           "'; a joint must not mimic itself");
    }
    master.offset += master.multiplier * at.mimic_offset;
    master.multiplier *= at.mimic_multiplier;
    master.link = found->second;
  }
  return master;
}

bool hasOneVariable(const RobotLink& link) {
  return link.joint_kind == JointKind::revolute || link.joint_kind == JointKind::prismatic;
}

}  // namespace

void appendVariables(const RobotLink& link, std::vector<JointVariable>& variables) {
  const auto add = [&](const char* part, bool is_angle) {
    JointVariable variable;
    variable.joint = link.joint;
    variable.name = link.joint + part;
    variable.lower = -kInfinity;
    variable.upper = kInfinity;
    variable.is_angle = is_angle;
    variables.push_back(variable);
  };
  switch (link.joint_kind) {
    case JointKind::fixed:
      break;
    case JointKind::revolute:
    case JointKind::prismatic:
      add("", link.joint_kind == JointKind::revolute);
      variables.back().is_continuous = link.continuous;
      if (link.continuous || (link.lower == 0.0 && link.upper == 0.0)) break;
      variables.back().lower = link.lower;
      variables.back().upper = link.upper;
      break;
    case JointKind::planar:
      add("/x", false), add("/y", false), add("/theta", true);
      variables.back().is_continuous = true;
      break;
    case JointKind::floating:
      add("/trans_x", false), add("/trans_y", false), add("/trans_z", false);
      const int first = static_cast<int>(variables.size());
      for (const char* part : {"/rot_x", "/rot_y", "/rot_z", "/rot_w"}) {
        add(part, false);
        variables.back().quaternion = first;
      }
      break;
  }
}

Kinematics::Kinematics(const RobotModel& model) {
  auto state = std::make_shared<State>();
  state->name = model.name;
  std::map<std::string, const RobotLink*> by_joint;
  std::map<std::string, std::uint32_t> first_variable;
  for (const RobotLink& link : model.links) {
    state->links.push_back(link.name);
    state->group_of_link.push_back(link.rigid_group);
    state->group_from_link.push_back(link.group_from_link);
    by_joint[link.joint] = &link;
    first_variable[link.joint] = static_cast<std::uint32_t>(state->variables.size());
    if (link.mimic.empty()) appendVariables(link, state->variables);
  }
  for (std::uint32_t i = 0; i < model.group_roots.size(); ++i) {
    const RobotLink& link = model.links[model.group_roots[i]];
    JointMotion joint;
    joint.link = model.group_roots[i];
    if (link.parent >= 0) {
      const RobotLink& parent = model.links[static_cast<std::size_t>(link.parent)];
      const Master master = masterOf(link, by_joint);
      joint.mimics = master.link != &link;
      if (joint.mimics && !(hasOneVariable(link) && hasOneVariable(*master.link))) {
        throw Refusal(Code::unsupported, jointText(link) + " mimics " + jointText(*master.link) +
                                             "; both must be revolute, continuous or prismatic");
      }
      if (!link.has_axis) {
        throw Refusal(Code::bad_geometry, jointText(link) + " has an axis of length 0; it must have a direction");
      }
      joint.kind = link.joint_kind;
      joint.parent = parent.rigid_group;
      joint.variable = first_variable.at(master.link->joint);
      joint.multiplier = master.multiplier;
      joint.offset = master.offset;
      if (hasOneVariable(link) && !link.continuous && (link.lower != 0.0 || link.upper != 0.0)) {
        joint.lower = link.lower;
        joint.upper = link.upper;
      }
      if (joint.mimics) state->variables[joint.variable].is_mimicked = true;
      setPoses(link, parent.group_from_link * link.parent_from_joint, joint);
    }
    state->groups.push_back(joint);
  }
  state_ = std::move(state);
}

void appendValues(const RobotLink& link, const Pose& parent_from_link, std::vector<double>& values) {
  const Pose joint_from_link = link.parent_from_joint.inverse() * parent_from_link;
  const Eigen::Vector3d shift = joint_from_link.translation();
  switch (link.joint_kind) {
    case JointKind::fixed:
      return;
    case JointKind::revolute:
      return values.push_back(withinLimits(link, angleAbout(link.axis, joint_from_link.linear())));
    case JointKind::prismatic:
      return values.push_back(shift.dot(link.axis));
    case JointKind::planar: {
      const Pose plane = jointFromPlane(link.axis);
      values.insert(values.end(), {shift.dot(plane.linear().col(0)), shift.dot(plane.linear().col(1)),
                                   angleAbout(link.axis, joint_from_link.linear())});
      return;
    }
    case JointKind::floating: {
      const Eigen::Quaterniond turn = Eigen::Quaterniond(joint_from_link.linear()).normalized();
      values.insert(values.end(), {shift.x(), shift.y(), shift.z(), turn.x(), turn.y(), turn.z(), turn.w()});
      return;
    }
  }
}

const std::string& Kinematics::name() const { return state_->name; }
const std::vector<JointVariable>& Kinematics::variables() const { return state_->variables; }
const std::vector<std::string>& Kinematics::links() const { return state_->links; }
const std::vector<std::uint32_t>& Kinematics::groupOfLink() const { return state_->group_of_link; }
const std::vector<Pose>& Kinematics::groupFromLink() const { return state_->group_from_link; }

int Kinematics::find(const std::string& variable) const {
  const std::vector<JointVariable>& all = state_->variables;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const JointVariable& one) { return one.name == variable; });
  return found == all.end() ? -1 : static_cast<int>(found - all.begin());
}

std::vector<Pose> Kinematics::rootFromLinks(const std::vector<double>& state) const {
  std::vector<FourDoubles> values;
  for (const double value : state) values.push_back(fourDoubles(value));
  GroupPoses groups;
  forwardKinematics(*this, values, Pose::Identity(), nullptr, groups);
  std::vector<Pose> poses;
  for (std::size_t link = 0; link < state_->links.size(); ++link) {
    poses.push_back(groups.in_world[state_->group_of_link[link]].of(0) * state_->group_from_link[link]);
  }
  return poses;
}

}  // namespace hgrid
