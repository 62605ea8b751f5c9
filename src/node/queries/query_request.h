// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Vector3.h>
#include <hgrid_proximity/Shape.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/queries/query.h"
#include "node/params/params.h"
#include "node/tf/transform_lookup.h"
#include "node/tick/tick.h"

namespace hgrid {

/// The options that all requests for queries have in common.
struct QueryOptions {
  const std::string& frame;                 ///< frame of the geometry; empty: the world frame
  const std::vector<std::string>& include;  ///< see QueryScope
  const std::vector<std::string>& exclude;  ///< see QueryScope
  std::uint32_t limit;                      ///< 0: ~max_hits, which is also the upper limit
  bool exact;
  bool respect_allowed;
  const std::string& as_body;  ///< name of the body whose allowed pairs are left out if respect_allowed is true
  std::optional<std::chrono::steady_clock::time_point> deadline;
};

/// A request for queries, prepared for a snapshot.
struct PreparedQuery {
  const Snapshot& snapshot;
  std::string frame;              ///< without a slash at the beginning; empty: the world frame
  Pose world_from_frame;          ///< [m]
  QueryScope scope;               ///< what the query asks about
  std::optional<std::size_t> of;  ///< number of bodies that the query asks about; nullopt: all bodies

  /// Reads a box. @throws Refusal what fromPose() throws
  QueryBox boxOf(const geometry_msgs::Pose& frame_from_box, const geometry_msgs::Vector3& size) const;
  /// Reads a shape. @throws Refusal what fromPose() and fromShape() throw
  QueryShape shapeOf(const ::hgrid_proximity::Shape& shape, const Params& params) const;
};

/// Prepares a request. @param tick  it has a snapshot, and must outlive the result
/// @param narrow_phase  used if the request is exact; must outlive the result
/// @throws Refusal unknown_id for a pattern of `include` that can match no body, if no body remains, and for an unknown
/// `as_body`; bad_id, limit for patterns; unknown_frame, extrapolation for the frame
PreparedQuery prepare(const QueryOptions& options, const Tick& tick, const Params& params,
                      const TransformLookup& transforms, const NarrowPhase& narrow_phase);

/// Returns the index of the body of this name. @throws Refusal unknown_id
std::uint32_t indexOf(const Snapshot& snapshot, const std::string& name);

}  // namespace hgrid
