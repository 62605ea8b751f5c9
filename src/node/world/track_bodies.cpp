// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/track_bodies.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"
#include "node/params/body_params.h"
#include "node/sources/source_id.h"

namespace hgrid {
namespace {

/// Returns the body of a track without its name, its frame and what depends on them.
Body blankBody(const TrackerParams& tracker) {
  Body body;
  body.kind = BodyKind::track;
  body.mobility = Mobility::moving;
  body.shapes = tracker.shapes;
  return body;
}

}  // namespace

double trackMaxSpeed(const TrackerParams& tracker, const Params& params) {
  Body body = blankBody(tracker);
  body.name = joined(SourceId::ofTracker(tracker.name).name, "*");  // what matches this glob matches every track
  applyObstacleParams(params, tracker.margin, tracker.max_speed, body);
  return body.max_speed;
}

TrackBodies::TrackBodies(const Params& params, bool simulated, NarrowPhase& narrow_phase, Scene& scene, Ledger& ledger)
    : params_(params),
      limits_{params.late_after, params.stale_after, params.lost_after},
      simulated_(simulated),
      scene_(scene),
      ledger_(ledger) {
  for (const TrackerParams& tracker : params.trackers) {
    Tracker& one = trackers_[tracker.name];
    one.params = &tracker;
    one.body = blankBody(tracker);
    makeSolids(narrow_phase, one.body);  // the tracks share them
  }
}

Body TrackBodies::bodyOf(const Tracker& tracker, const std::string& id, const std::string& world_frame) const {
  Body body = tracker.body;
  body.name = joined(SourceId::ofTracker(tracker.params->name).name, id);
  body.frame = world_frame;
  applyObstacleParams(params_, tracker.params->margin, tracker.params->max_speed, body);
  return body;
}

void TrackBodies::set(const std::string& name, std::shared_ptr<const TrackSet> set, const std::string& world_frame) {
  Tracker& tracker = trackers_.at(name);
  std::map<std::string, BodyId> next;
  std::vector<BodyId> out;
  std::vector<Body> in;
  std::vector<BodyId*> entering;
  for (const Track& track : set->tracks) {
    const auto known = tracker.bodies.find(track.id);
    BodyId& body = next[track.id];
    if (known != tracker.bodies.end()) {
      body = known->second;
    } else {
      in.push_back(bodyOf(tracker, track.id, world_frame));
      entering.push_back(&body);
    }
  }
  for (const auto& [id, body] : tracker.bodies) {
    if (next.count(id) == 0) out.push_back(body);
  }
  try {
    std::vector<BodyId> added;
    if (!in.empty() || !out.empty()) added = scene_.exchange(out, std::move(in));
    for (std::size_t i = 0; i < added.size(); ++i) *entering[i] = added[i];
  } catch (const Refusal& refusal) {
    ledger_.refuse("track/" + name + ".unplaced", refusal);
    tracker.no_room = std::string(hgrid::name(refusal.code())) + " " + refusal.what();
    return;
  }
  // The code below does not allocate, so it cannot fail.
  tracker.bodies.swap(next);
  tracker.set = std::move(set);
  tracker.no_room.clear();
  tracker.placed = false;
}

void TrackBodies::update(const Moment& now, bool clock_frozen, Tick& tick, std::vector<SourceGap>& gaps) {
  const bool went_back = now.ros < time_;
  for (auto& [name, tracker] : trackers_) {
    const std::size_t before = gaps.size();
    appendGap(SourceId::ofTracker(name).name, tracker, now, clock_frozen, gaps);
    if (gaps.size() > before) tick.not_ready.push_back(gaps.back().sentence);
    if (!tracker.set) continue;
    const bool place = !tracker.placed || went_back;
    bool placed = true;
    auto body = tracker.bodies.begin();
    for (const Track& track : tracker.set->tracks) {  // both are sorted by id
      if (!updateOne(track, (body++)->second, now, clock_frozen, place, tick)) placed = false;
    }
    tracker.placed = placed;  // only now, because placing may run out of memory
  }
  time_ = now.ros;
}

/// @returns whether the body has the pose and the stamp of the track; false: place it again in the next tick
bool TrackBodies::updateOne(const Track& track, BodyId body, const Moment& now, bool clock_frozen, bool place,
                            Tick& tick) {
  const double age = track.time.age(now, simulated_);
  Freshness state = clock_frozen ? Freshness::frozen : freshnessOf(age, track.period, limits_);
  std::optional<Refusal> refused;
  try {
    // The report can be newer than the tick, which waits for tf, but not newer than now.
    if (place) scene_.place(body, track.world_from_track, std::min(now.ros, track.time.stamp));
  } catch (const Refusal& refusal) {
    ledger_.refuse("pose.refused", refusal);
    state = Freshness::invalid;
    refused = refusal;
  }
  scene_.setState(body, state, age, 0, track.period);
  if (state != Freshness::fresh) {
    tick.troubles.push_back({scene_.body(body).name, tick.world_frame, state, age, track.time.stamp,
                             refused ? refused->code() : Code::tf_timeout,
                             refused ? refused->what() : "its tracker reported it " + secondsText(age) + " ago"});
  }
  return !refused && track.time.stamp <= now.ros;
}

/// Appends a gap if persons or vehicles may be there that the tracker does not report. A tracker of which no message
/// was used yet is a missing source and needs no gap.
void TrackBodies::appendGap(const std::string& source, const Tracker& tracker, const Moment& now, bool clock_frozen,
                            std::vector<SourceGap>& gaps) const {
  std::string sentence;
  if (!tracker.no_room.empty()) {
    sentence = "REFUSED '" + source + "': the world has no room for its tracks (" + tracker.no_room + ")";
    gaps.push_back({source, joined(source, "*"), sentence});
    return;
  }
  if (!tracker.set) return;
  const TrackSet& set = *tracker.set;
  const double age = set.newest.age(now, simulated_);
  const Freshness state = clock_frozen ? Freshness::frozen : freshnessOf(age, set.period, limits_);
  if (state >= Freshness::lost) {
    sentence =
        std::string(hgrid::name(state)) + " " + source + ": its newest usable message is " + secondsText(age) + " old";
    if (!set.refused.empty()) sentence += "; a later message was refused: " + set.refused;
  } else if (!set.refused.empty()) {
    sentence = "REFUSED '" + source + "': its newest message could not be used (" + set.refused +
               "), so tracks may be missing";
  }
  if (!sentence.empty()) gaps.push_back({source, joined(source, "*"), sentence});
}

}  // namespace hgrid
