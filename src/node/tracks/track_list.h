// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "node/params/params.h"
#include "node/tf/frame_pace.h"
#include "node/time/data_time.h"
#include "node/time/freshness.h"
#include "node/tracks/placed_report.h"

namespace hgrid {

/// A track as a tick needs it.
struct Track {
  std::string id;
  Pose world_from_track = Pose::Identity();  ///< as it was reported last
  DataTime time;                             ///< of the newest report
  double period = 0.0;                       ///< [s] usual time between its reports; 0: not known yet
};

/// All that is known about the tracks of one tracker.
struct TrackSet {
  std::vector<Track> tracks;  ///< sorted by id
  bool heard = false;         ///< whether a message of the tracker was used
  DataTime newest;            ///< of its newest message; valid if heard
  double period = 0.0;        ///< [s] usual time between its messages; 0: not known yet
  std::string refused;        ///< why a message after the newest used one was refused; empty: none was
};

/// Keeps the tracks of one tracker: takes what the tracker reports, and ends tracks that it no longer reports.
///
/// Poses without ids are assigned to the tracks by nearest neighbor: first the pair of a track and a pose with the
/// smallest distance, then the next one, until no pose is near enough. A pose is near enough to a track if the track
/// can have moved there at its largest speed, or up to TrackerParams::noise farther. Every other pose is a new track.
///
/// Only one thread may use it.
class TrackList {
 public:
  /// @param max_speed  [m/s] largest speed of a track
  /// @param params     ~late_after, ~stale_after, ~lost_after and ~limits/max_future count
  /// @param simulated  whether /clock drives ROS time
  TrackList(const TrackerParams& tracker, double max_speed, const Params& params, bool simulated)
      : tracker_(tracker),
        max_speed_(max_speed),
        limits_{params.late_after, params.stale_after, params.lost_after},
        max_future_(params.max_future),
        simulated_(simulated) {}

  /// Takes the content of one message. If this throws, the list stays as it was.
  /// @param placed  the poses of `report`, in the same order
  /// @returns how many poses were left out because they are older than the track's newest one
  /// @throws Refusal limit (max_tracks)
  std::size_t take(const TrackReport& report, const std::vector<PlacedReport>& placed, const Moment& now);
  /// Notes that a message could not be used.
  void noteRefused(const std::string& sentence) { refused_ = sentence; }
  /// Ends the tracks that have been LOST for TrackerParams::forget. @returns whether there were any
  bool forget(const Moment& now);
  TrackSet set() const;

 private:
  struct Known {
    Pose world_from_track = Pose::Identity();
    DataTime time;
    FramePace pace;
  };
  using Tracks = std::map<std::string, Known>;  // by id

  std::vector<std::string> assigned(const TrackReport& report, const std::vector<PlacedReport>& placed,
                                    const Moment& now, std::uint64_t& last_id) const;
  double periodOf(const Known& track) const { return std::max(track.pace.period(), pace_.period()); }
  bool isForgotten(const Known& track, const Moment& now) const;
  bool isOlder(Time stamp, Time newest, const Moment& arrival) const;

  TrackerParams tracker_;
  double max_speed_;
  AgeLimits limits_;
  double max_future_;
  bool simulated_;
  Tracks tracks_;
  bool heard_ = false;
  DataTime newest_;
  FramePace pace_;             // of the messages
  std::uint64_t last_id_ = 0;  // of tracks that are reported without ids
  std::string refused_;
};

}  // namespace hgrid
