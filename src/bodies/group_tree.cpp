// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bodies/group_tree.h"

#include <algorithm>

#include "hgrid_proximity/bodies/robot_model.h"

namespace hgrid {
namespace {

// [m] Two joint origins that are at most this far apart count as one place. It is 1 cm plus the rounding error of two
// origins that are exactly 1 cm apart.
constexpr double kOnePlace = 0.01 + 1e-9;

}  // namespace

GroupTree::GroupTree(const RobotModel& model) : groups_(model.group_roots.size()) {
  for (const RobotLink& link : model.links) {
    if (link.hasGeometry()) groups_[link.rigid_group].has_geometry = true;
  }
  for (std::uint32_t i = 0; i < groups_.size(); ++i) {
    const RobotLink& root = model.links[model.group_roots[i]];  // its origin is the origin of the group's joint
    if (root.parent < 0) continue;
    const RobotLink& parent = model.links[static_cast<std::size_t>(root.parent)];
    groups_[i].parent = parent.rigid_group;
    groups_[i].joint = root.joint;
    groups_[i].offset = (parent.group_from_link * root.parent_from_joint).translation().norm();
  }
}

std::vector<std::uint32_t> GroupTree::adjacentAbove(std::uint32_t group) const {
  std::vector<std::uint32_t> above;
  while (groups_[group].parent != kNone) {
    const Group& here = groups_[group];
    above.push_back(here.parent);
    // Whether the joint of this group and the joint of its parent group together act as one joint.
    const bool one_joint = here.offset <= kOnePlace && !groups_[here.parent].has_geometry;
    if (!one_joint) break;
    group = here.parent;
  }
  return above;
}

std::vector<std::string> GroupTree::jointsBetween(std::uint32_t first, std::uint32_t second) const {
  const auto [upper, lower] = std::minmax(first, second);
  const std::vector<std::uint32_t> above = adjacentAbove(lower);
  const auto end = std::find(above.begin(), above.end(), upper);
  if (end == above.end()) return {};
  std::vector<std::string> joints = {groups_[lower].joint};
  for (auto group = above.begin(); group != end; ++group) joints.push_back(groups_[*group].joint);
  std::reverse(joints.begin(), joints.end());
  return joints;
}

}  // namespace hgrid
