// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "hgrid_proximity/world/scene.h"
#include "node/health/ledger.h"
#include "node/params/params.h"
#include "node/tick/tick.h"
#include "node/tracks/track_list.h"

namespace hgrid {

/// Returns the largest speed of the tracks of a tracker [m/s].
double trackMaxSpeed(const TrackerParams& tracker, const Params& params);

/// Keeps the bodies of tracks in the scene up to date: which ones there are, their poses and their states.
///
/// A track keeps the pose at which it was reported last, and that pose grows old. A tracker is a source that is not
/// complete while its newest message was refused, or is so old that a pose of this age would be LOST.
class TrackBodies {
 public:
  /// @param simulated  whether /clock drives ROS time
  TrackBodies(const Params& params, bool simulated, NarrowPhase& narrow_phase, Scene& scene, Ledger& ledger);

  /// Replaces all tracks of a tracker. If the scene has no room for them, the tracks before stay, and the tracker is
  /// not complete until the next call. If this throws, which only lack of memory can cause, nothing has changed.
  /// @param tracker  as TrackerParams::name
  /// @param set      not null
  void set(const std::string& tracker, std::shared_ptr<const TrackSet> set, const std::string& world_frame);
  /// Updates the pose and state of every track. Appends to the troubles of `tick`, and to `gaps` for each tracker that
  /// is not complete.
  void update(const Moment& now, bool clock_frozen, Tick& tick, std::vector<SourceGap>& gaps);

 private:
  struct Tracker {
    Body body;  // of a track, without its name
    const TrackerParams* params = nullptr;
    std::shared_ptr<const TrackSet> set;   // null: no set yet
    std::map<std::string, BodyId> bodies;  // by id of the track; those of `set`
    std::string no_room;                   // why the scene refused the newest set; empty: it did not
    bool placed = false;                   // whether all bodies have the poses and the stamps of `set`
  };
  Body bodyOf(const Tracker& tracker, const std::string& id, const std::string& world_frame) const;
  bool updateOne(const Track& track, BodyId body, const Moment& now, bool clock_frozen, bool place, Tick& tick);
  void appendGap(const std::string& source, const Tracker& tracker, const Moment& now, bool clock_frozen,
                 std::vector<SourceGap>& gaps) const;

  const Params& params_;
  const AgeLimits limits_;
  bool simulated_;
  Scene& scene_;
  Ledger& ledger_;
  std::map<std::string, Tracker> trackers_;  // by name
  Time time_{0};                             // [ROS time] when the newest tick was made
};

}  // namespace hgrid
