// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hgrid {

struct RobotModel;

/// A tree of the rigid groups of a robot model. Its edges are the moving joints. It decides which groups are adjacent:
/// those that one joint connects, or several joints that count as one.
///
/// LinkMatrix decides which of their links are adjacent. If several joints connect two adjacent groups, these joints
/// are a universal or spherical joint that the URDF describes as several joints. Groups on different branches are never
/// adjacent.
class GroupTree {
 public:
  /// @param model  a robot model; call findRigidGroups() for it before
  explicit GroupTree(const RobotModel& model);

  /// Returns the number of groups.
  std::size_t size() const { return groups_.size(); }
  /// Returns the groups between the root and `group` that are adjacent to `group`, the nearest first.
  std::vector<std::uint32_t> adjacentAbove(std::uint32_t group) const;
  /// Returns the names of the joints that connect two adjacent groups, from the upper group down. The list is empty if
  /// the groups are not adjacent.
  std::vector<std::string> jointsBetween(std::uint32_t first, std::uint32_t second) const;

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  struct Group {
    std::uint32_t parent = kNone;  // index of the parent group, always smaller than the index of this group
    std::string joint;             // name of the joint that connects the group to its parent; empty for the root
    double offset = 0.0;           // [m] distance of the origins of this joint and of the parent group's joint
    bool has_geometry = false;     // whether any of its links has geometry
  };
  std::vector<Group> groups_;
};

}  // namespace hgrid
