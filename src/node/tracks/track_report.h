// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "node/params/params.h"
#include "node/time/clock_watch.h"

namespace hgrid {

/// What one message of a tracker says.
struct TrackReport {
  /// The pose of one track.
  struct Reported {
    std::string id;     ///< "7" or "namespace/7"; empty if the message has no ids
    std::string frame;  ///< tf frame of the pose
    Time stamp{0};      ///< [ROS time]
    Pose frame_from_track = Pose::Identity();
  };
  std::vector<Reported> poses;  ///< sorted by id if the message has ids, otherwise in the order of the message
  bool has_ids = false;         ///< true: no id is there twice
  Time stamp{0};                ///< [ROS time] newest stamp of the message; if it has none: when it arrived
  Moment arrival;               ///< when the message arrived

  std::size_t ignored = 0;    ///< number of markers whose namespace does not match TrackerParams::namespaces
  std::size_t unrotated = 0;  ///< number of orientations of four zeros, which count as no rotation
  bool unstamped = false;     ///< whether a stamp is 0, so that the time of arrival was used
};

/// Checks and reads the bytes of a message of the tracker: a visualization_msgs/MarkerArray or a
/// geometry_msgs/PoseArray, as tracker.type says.
///
/// The markers of an array are read in their order. DELETE and DELETEALL remove markers that came before in the same
/// array; they do nothing else, because a track ends when it is no longer reported.
/// @param arrival     when the message arrived
/// @param max_future  [s] as ~limits/max_future
/// @throws Refusal truncated, limit (max_tracks), nonfinite, bad_rotation, clock, bad_id or dup_id for an id, or
/// unsupported for an action or a kind of marker that has no single pose
TrackReport readTrackReport(const std::string& bytes, const TrackerParams& tracker, const Moment& arrival,
                            double max_future);

}  // namespace hgrid
