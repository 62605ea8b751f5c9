// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Random robots with all kinds of joints, and forward kinematics that share nothing with the product.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/kinematics.h"
#include "test/support/models.h"

namespace hgrid {
namespace test {

inline Eigen::Vector3d randomAxis(Random& random) {
  if (random.chance(0.3)) return (random.chance(0.5) ? 1.0 : -1.0) * Eigen::Vector3d::Unit(random.below(3));
  Eigen::Vector3d axis;
  do {
    axis << random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1);
  } while (axis.norm() < 0.1);
  return axis.normalized();
}

inline bool turnsOrSlides(const RobotLink& link) {
  return link.joint_kind == JointKind::revolute || link.joint_kind == JointKind::prismatic;
}

/// Returns a random tree of links without shapes. It has all kinds of joints. Some joints have limits, some turn
/// without limits, and some mimic another joint, which may mimic a joint itself.
/// @param reach  [m] how far links are from their parents
inline RobotModel randomMechanism(Random& random, int count, double reach) {
  const JointKind kinds[] = {JointKind::fixed,    JointKind::revolute,  JointKind::revolute, JointKind::revolute,
                             JointKind::revolute, JointKind::prismatic, JointKind::planar,   JointKind::floating};
  RobotModel model;
  model.name = "robot";
  for (int i = 0; i < count; ++i) {
    const int parent = i == 0 ? -1 : random.chance(0.7) ? i - 1 : random.below(i);
    addLink(model, "link" + std::to_string(i), parent, kinds[random.below(8)], false);
    RobotLink& link = model.links.back();
    link.parent_from_joint = randomPose(random, reach);
    link.axis = randomAxis(random);
    link.continuous = link.joint_kind == JointKind::revolute && random.chance(0.3);
    if (turnsOrSlides(link) && random.chance(0.6)) {
      link.lower = random.uniform(-2, 0);
      link.upper = random.uniform(0, 2);
    }
    if (!turnsOrSlides(link) || !random.chance(0.5)) continue;
    const RobotLink& master = model.links[std::size_t(random.below(i + 1))];
    if (!turnsOrSlides(master) || master.joint == link.joint) continue;
    link.mimic = master.joint;
    link.mimic_multiplier = random.uniform(-2, 2);
    link.mimic_offset = random.uniform(-0.5, 0.5);
  }
  findRigidGroups(model);
  return model;
}

/// Returns random values for the variables of a robot. Most are within the limits.
inline std::vector<double> randomState(Random& random, const Kinematics& kinematics) {
  std::vector<double> state;
  for (const JointVariable& variable : kinematics.variables()) {
    const bool has_limits = std::isfinite(variable.lower) && random.chance(0.9);
    state.push_back(has_limits ? random.uniform(variable.lower, variable.upper)
                               : random.uniform(variable.is_angle ? -6 : -0.5, variable.is_angle ? 6 : 0.5));
  }
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (kinematics.variables()[i].quaternion != int(i)) continue;
    const Eigen::Quaterniond turn(randomPose(random, 0.0).linear());
    for (std::size_t k = 0; k < 4; ++k) state[i + k] = turn.coeffs()[Eigen::Index(k)];
  }
  return state;
}

/// Computes the poses of links by the definition of each joint, link by link.
class JointOracle {
 public:
  JointOracle(const RobotModel& model, const Kinematics& kinematics, const std::vector<double>& state) : model_(model) {
    for (std::size_t i = 0; i < state.size(); ++i) values_[kinematics.variables()[i].name] = state[i];
  }

  /// Returns the pose of a link in the root frame.
  Pose rootFromLink(int index) const {
    const RobotLink& link = model_.links[std::size_t(index)];
    if (link.parent < 0) return Pose::Identity();
    return rootFromLink(link.parent) * link.parent_from_joint * motionOf(link);
  }

  /// Returns whether a joint is beyond its limits.
  bool isBeyondLimits() const {
    for (const RobotLink& link : model_.links) {
      if (!turnsOrSlides(link) || link.parent < 0 || link.continuous || (link.lower == 0 && link.upper == 0)) continue;
      if (positionOf(link) < link.lower || positionOf(link) > link.upper) return true;
    }
    return false;
  }

 private:
  double positionOf(const RobotLink& link) const {
    if (link.mimic.empty()) return values_.at(link.joint);
    for (const RobotLink& master : model_.links) {
      if (master.joint == link.mimic) return link.mimic_multiplier * positionOf(master) + link.mimic_offset;
    }
    return 0.0;
  }
  double value(const RobotLink& link, const char* part) const { return values_.at(link.joint + part); }

  Pose motionOf(const RobotLink& link) const {
    Pose motion = Pose::Identity();
    switch (link.joint_kind) {
      case JointKind::fixed:
        break;
      case JointKind::revolute:
        motion.linear() = Eigen::AngleAxisd(positionOf(link), link.axis).toRotationMatrix();
        break;
      case JointKind::prismatic:
        motion.translation() = positionOf(link) * link.axis;
        break;
      case JointKind::planar: {
        const Eigen::Vector3d side =
            std::abs(link.axis.x()) > 0.9 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
        const Eigen::Vector3d y = link.axis.cross(side).normalized(), x = y.cross(link.axis);
        motion.translation() = value(link, "/x") * x + value(link, "/y") * y;
        motion.linear() = Eigen::AngleAxisd(value(link, "/theta"), link.axis).toRotationMatrix();
        break;
      }
      case JointKind::floating:
        motion.translation() << value(link, "/trans_x"), value(link, "/trans_y"), value(link, "/trans_z");
        motion.linear() = Eigen::Quaterniond(value(link, "/rot_w"), value(link, "/rot_x"), value(link, "/rot_y"),
                                             value(link, "/rot_z"))
                              .toRotationMatrix();
        break;
    }
    return motion;
  }

  const RobotModel& model_;
  std::map<std::string, double> values_;
};

}  // namespace test
}  // namespace hgrid
