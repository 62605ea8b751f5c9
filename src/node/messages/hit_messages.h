// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Hit.h>

#include <cstdint>
#include <string>
#include <vector>

#include "hgrid_proximity/queries/query_answer.h"
#include "hgrid_proximity/world/snapshot.h"
#include "node/messages/to_messages.h"

namespace hgrid {

/// Converts the hits of queries about one snapshot into messages.
class HitWriter {
 public:
  /// @param snapshot          must outlive this object
  /// @param frame_from_world  [m] pose of the world in the frame of the response
  /// @param age_since         [s] time since the snapshot was made
  HitWriter(const Snapshot& snapshot, const Pose& frame_from_world, double age_since);

  /// Returns a hit as a message, with points and normals in the frame of the response.
  msg::Hit message(const QueryHit& hit) const;
  /// Returns the age [s] of the pose of a body; 0 if the body is fixed.
  double age(std::uint32_t body) const;
  /// Returns how far the pose of a body can be trusted: a constant of BodyState.
  std::uint8_t state(std::uint32_t body) const { return static_cast<std::uint8_t>(snapshot_.poses()[body].state); }
  /// Returns whether a body is an obstacle that is attached to a link.
  bool isCarried(std::uint32_t body) const;
  /// Returns a point [m] of the world frame in the frame of the response.
  geometry_msgs::Point point(const Eigen::Vector3d& in_world) const { return toPoint(frame_from_world_ * in_world); }
  /// Returns a direction of the world frame in the frame of the response.
  geometry_msgs::Vector3 vector(const Eigen::Vector3d& in_world) const {
    return toVector(frame_from_world_.linear() * in_world);
  }

 private:
  const Snapshot& snapshot_;
  const Pose frame_from_world_;
  const double age_since_;
  std::vector<std::uint32_t> carried_;  // sorted
};

}  // namespace hgrid
