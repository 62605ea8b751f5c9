// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/scene/link_matrix.h"
#include "hgrid_proximity/scene/robot_model.h"
#include "test/support/bodies.h"
#include "test/support/shapes.h"

namespace hgrid {
namespace test {

/// Appends a link below `parent` (-1: a root) and returns its index.
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

/// A tree of `count` links with joints and geometry as it comes.
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

}  // namespace test
}  // namespace hgrid
