// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hgrid {

struct RobotModel;

/// The rigid groups of a robot model as a tree whose edges are the moving joints, with the adjacency of the groups.
///
/// Two groups are adjacent if exactly one moving joint connects them. They are also adjacent if several moving joints
/// connect them in one chain from parent to child, no link of a group between them has geometry, and the origins of
/// consecutive joints (all joints at zero) are at most 1 cm apart: a universal or spherical joint that is written as
/// several joints. Groups on different branches are never adjacent.
class GroupTree {
 public:
  /// @param model  with the groups of findRigidGroups()
  explicit GroupTree(const RobotModel& model);

  std::size_t size() const { return groups_.size(); }
  /// The groups above `group`, toward the root, that are adjacent to it: the nearest first.
  std::vector<std::uint32_t> adjacentAbove(std::uint32_t group) const;
  /// Names of the joints that connect two adjacent groups, from the upper group down. Empty: they are not adjacent.
  std::vector<std::string> jointsBetween(std::uint32_t first, std::uint32_t second) const;

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  struct Group {
    std::uint32_t parent = kNone;  // a smaller index
    std::string joint;             // connects the group to its parent; empty for the root
    double offset = 0.0;           // [m] between the origins of this joint and of the parent's joint
    bool has_geometry = false;     // of any of its links
  };
  std::vector<Group> groups_;
};

}  // namespace hgrid
