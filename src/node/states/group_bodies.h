// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hgrid_proximity/world/snapshot.h"
#include "node/robots/robot_source.h"

namespace hgrid {

/// Returns the index of the rigid group above a rigid group; the root group is above itself.
std::uint32_t groupAbove(const LoadedRobot& robot, std::uint32_t group);

/// Returns the rigid groups of a robot by the tf frames of their links.
std::map<std::string, std::uint32_t> groupsOfFrames(const LoadedRobot& robot);

/// The bodies of a robot whose poses depend on where a rigid group is.
class GroupBodies {
 public:
  /// Both parameters must outlive this object.
  /// @param snapshot  has the bodies, and the obstacles that are attached to links
  GroupBodies(const LoadedRobot& robot, const Snapshot& snapshot);

  /// Returns whether the group, or a group below it, has a body: a link with geometry, or an obstacle in its frame.
  bool hasBodies(std::uint32_t group) const { return has_bodies_[group]; }
  /// Returns a sentence that names a body because of which nobody knows where the group is, such as one that is STALE
  /// or worse. Looks at the bodies of the group, or of the groups below it if it has none. Empty: no body is in doubt.
  std::string doubtAbout(std::uint32_t group) const;

 private:
  const LoadedRobot& robot_;
  const Snapshot& snapshot_;
  std::vector<std::vector<std::uint32_t>> below_;  // for each group: the groups whose joints are on it
  std::vector<bool> has_bodies_;
};

}  // namespace hgrid
