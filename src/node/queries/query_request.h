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
  std::uint32_t limit;                      ///< largest number of hits; 0, or more than ~limits/max_hits, means ~limits/max_hits
  bool exact;                               ///< true: measure the shapes of bodies; false: only their boxes
  bool respect_allowed;        ///< true: leave out as_body and the bodies whose pair with as_body is switched off
  const std::string& as_body;  ///< name of a body; read only if respect_allowed is true, and then required
  std::optional<std::chrono::steady_clock::time_point> deadline;  ///< when the query stops; nullopt: no deadline
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

/// Checks the options of a request and looks up its frame.
/// @param tick          must have a snapshot and must outlive the result
/// @param narrow_phase  used if options.exact is true; must outlive the result
/// @throws Refusal unknown_id if a glob of `include` can match no body, if `exclude` leaves no body, or if as_body is
/// unknown
/// @throws Refusal bad_id if as_body is empty but required, or if a glob is too long; limit if there are too many globs
/// @throws Refusal unknown_frame or extrapolation if the pose of the frame is not known
PreparedQuery prepare(const QueryOptions& options, const Tick& tick, const Params& params,
                      const TransformLookup& transforms, const NarrowPhase& narrow_phase);

/// Returns the index of the body of this name. @throws Refusal unknown_id
std::uint32_t indexOf(const Snapshot& snapshot, const std::string& name);

}  // namespace hgrid
