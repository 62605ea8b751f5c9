// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/bodies/link_matrix.h"
#include "hgrid_proximity/bodies/robot_model.h"
#include "test/support/bodies.h"
#include "test/support/shapes.h"

namespace hgrid {
namespace test {

/// Appends a link with the parent link of index `parent` (-1: none, a root) and returns its index.
inline int addLink(RobotModel& model, const std::string& name, int parent, JointKind kind = JointKind::revolute,
                   bool has_collision = true) {
  RobotLink link;
  link.name = name;
  link.parent = parent;
  link.joint = parent < 0 ? "" : name + "_joint";
  link.joint_kind = parent < 0 ? JointKind::fixed : kind;
  link.has_collision = has_collision;
  if (has_collision) link.shapes.push_back(shapeOf(Shape::sphere(0.1)));
  model.links.push_back(link);
  return int(model.links.size()) - 1;
}

/// Returns a small humanoid robot. Its moving links have no geometry. Each shape is on a link "<part>_shape", which a
/// fixed joint connects to a moving link.
///
/// The waist and the wrists are universal joints, written as two joints each. The shoulders are spherical joints,
/// written as three joints each. The two joints of the neck are 6 cm apart, so they do not form a universal joint.
inline RobotModel humanoid() {
  RobotModel model;
  model.name = "humanoid";
  const auto addPart = [&](const std::string& name, int parent, const Eigen::Vector3d& origin, bool has_shape) {
    const int part = addLink(model, name, parent, JointKind::revolute, false);
    model.links.back().parent_from_joint.translation() = origin;
    if (has_shape) addLink(model, name + "_shape", part, JointKind::fixed);
    return part;
  };
  const int pelvis = addPart("pelvis", -1, {0, 0, 0}, true);
  const int torso = addPart("torso", addPart("waist", pelvis, {0, 0, 0.2}, false), {0, 0, 0}, true);
  addPart("head", addPart("neck", torso, {0, 0, 0.5}, false), {0, 0, 0.06}, true);
  for (const std::string side : {"left_", "right_"}) {
    const double y = side == "left_" ? 0.2 : -0.2;
    const int swing = addPart(side + "shoulder_swing", torso, {0, y, 0.4}, false);
    const int lift = addPart(side + "shoulder_lift", swing, {0, 0, 0}, false);
    const int upper_arm = addPart(side + "upper_arm", lift, {0, 0.005, 0}, true);
    const int forearm = addPart(side + "forearm", upper_arm, {0, 0, -0.3}, true);
    addPart(side + "hand", addPart(side + "wrist", forearm, {0, 0, -0.25}, false), {0, 0, -0.01}, true);
  }
  findRigidGroups(model);
  return model;
}

/// Returns a random tree of `count` links with random joints. About 70 % of the links have geometry.
inline RobotModel randomModel(Random& random, int count) {
  RobotModel model;
  model.name = "robot";
  const JointKind kinds[] = {JointKind::fixed, JointKind::revolute, JointKind::prismatic, JointKind::revolute};
  for (int i = 0; i < count; ++i) {
    const int parent = i == 0 ? -1 : random.chance(0.6) ? i - 1 : random.below(i);
    addLink(model, "link" + std::to_string(i), parent, kinds[random.below(4)], random.chance(0.7));
    model.links.back().parent_from_joint = randomPose(random, 0.5);
  }
  findRigidGroups(model);
  return model;
}

inline LinkMatrix matrixOf(const RobotModel& model, const LinkRules& rules = {}) {
  std::vector<std::string> warnings;
  return LinkMatrix(model, rules, warnings);
}

/// Returns the bodies of a robot as an importer would create them: one per link with geometry.
inline std::vector<Body> bodiesOf(const RobotModel& model, const std::string& robot,
                                  const std::shared_ptr<const LinkMatrix>& matrix) {
  std::vector<Body> bodies;
  for (std::uint32_t i = 0; i < model.links.size(); ++i) {
    if (!model.links[i].has_collision) continue;
    bodies.push_back(linkBody(model, i, robot, matrix));
    bodies.back().max_speed = 0.5;
  }
  return bodies;
}

}  // namespace test
}  // namespace hgrid
