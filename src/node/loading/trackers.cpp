// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/loading/trackers.h"

#include "node/params/body_params.h"
#include "node/world/track_bodies.h"
#include "node/world/world.h"

namespace hgrid {

void Trackers::start() {
  const Params& params = commons_.settings.params;
  for (const TrackerParams& tracker : params.trackers) {
    TrackSource::Sink sink;
    // Each job replaces the one before: a set has all tracks.
    sink.put = [this, name = tracker.name](std::shared_ptr<const TrackSet> set) {
      jobs_.add("tracks of " + name, [name, set](World& world) { world.setTracks(name, set); });
    };
    sink.follow = [this, source = SourceId::ofTracker(tracker.name)](const std::vector<std::string>& frames) {
      jobs_.add("frames of " + source.name, [source, frames](World& world) { world.setDataFrames(source, frames); });
    };
    sources_.push_back(std::make_unique<TrackSource>(node_, tracker, trackMaxSpeed(tracker, params), params,
                                                     transforms_, newest_, sink, commons_.ledger));
  }
}

}  // namespace hgrid
