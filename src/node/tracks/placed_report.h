// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "node/tf/transform_lookup.h"
#include "node/tracks/track_report.h"

namespace hgrid {

/// A track that was reported, placed in the world.
struct PlacedReport {
  std::string id;  ///< as in TrackReport
  Time stamp{0};
  Pose world_from_track = Pose::Identity();
};

/// Returns the frames and stamps of the poses, each of them once.
std::vector<std::pair<std::string, Time>> framesOf(const TrackReport& report);

/// Places all poses in the world: each where its frame was at its stamp.
/// @param upright  as TrackerParams::upright
/// @throws Refusal unknown_frame or extrapolation if tf does not know the pose of a frame at its stamp; out_of_range if
/// a position is beyond `world_limit` [m]
std::vector<PlacedReport> placedInWorld(const TrackReport& report, const TransformLookup& transforms,
                                        const std::string& world_frame, bool upright, double world_limit);

}  // namespace hgrid
