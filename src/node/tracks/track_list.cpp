// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tracks/track_list.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

/// Learns the period of data from its newest two stamps. Data that is not newer does not change it.
void noteStep(Time before, Time after, FramePace& pace) {
  if (after > before) pace.noteStep(seconds(after - before));
}

}  // namespace

/// Returns the id of each pose. @param last_id  the last new id; grows with each new track
std::vector<std::string> TrackList::assigned(const TrackReport& report, const std::vector<PlacedReport>& placed,
                                             const Moment& now, std::uint64_t& last_id) const {
  std::vector<std::string> ids;
  for (const PlacedReport& pose : placed) ids.push_back(pose.id);
  if (report.has_ids) return ids;
  // A tuple of distance, track and pose: equal distances are decided by the order of tracks and poses.
  std::vector<std::tuple<double, Tracks::const_iterator, std::size_t>> near;
  const double age = DataTime(report.stamp, report.arrival).age(now, simulated_);
  for (auto track = tracks_.begin(); track != tracks_.end(); ++track) {
    const double elapsed = std::max(0.0, track->second.time.age(now, simulated_) - age);
    const double gate = max_speed_ * elapsed + tracker_.noise;
    const Eigen::Vector3d from = track->second.world_from_track.translation();
    for (std::size_t pose = 0; pose < placed.size(); ++pose) {
      const double distance = (placed[pose].world_from_track.translation() - from).norm();
      if (distance <= gate) near.emplace_back(distance, track, pose);
    }
  }
  std::sort(near.begin(), near.end(), [](const auto& a, const auto& b) {
    if (std::get<0>(a) != std::get<0>(b)) return std::get<0>(a) < std::get<0>(b);
    const std::string &id_a = std::get<1>(a)->first, &id_b = std::get<1>(b)->first;
    return id_a != id_b ? id_a < id_b : std::get<2>(a) < std::get<2>(b);
  });
  std::set<std::string> taken;
  for (const auto& [distance, track, pose] : near) {
    if (ids[pose].empty() && taken.insert(track->first).second) ids[pose] = track->first;
  }
  for (std::string& id : ids) {
    if (id.empty()) id = std::to_string(++last_id);
  }
  return ids;
}

std::size_t TrackList::take(const TrackReport& report, const std::vector<PlacedReport>& placed, const Moment& now) {
  forget(now);
  std::uint64_t last_id = last_id_;
  const std::vector<std::string> ids = assigned(report, placed, now, last_id);
  Tracks next = tracks_;
  std::size_t too_old = 0;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const DataTime time(placed[i].stamp, report.arrival);
    const auto [entry, is_new] = next.try_emplace(ids[i]);
    Known& track = entry->second;
    if (!is_new && isOlder(time.stamp, track.time.stamp, report.arrival)) {
      ++too_old;
      continue;
    }
    if (!is_new) noteStep(track.time.stamp, time.stamp, track.pace);
    track.world_from_track = placed[i].world_from_track;
    track.time = time;
  }
  if (next.size() > static_cast<std::size_t>(tracker_.max_tracks)) {
    throw Refusal(Code::limit, "with it, there would be " + std::to_string(next.size()) +
                                   " tracks, including those that are no longer reported; at most " +
                                   std::to_string(tracker_.max_tracks) + " are allowed (max_tracks of this tracker)");
  }
  tracks_.swap(next);
  last_id_ = last_id;
  refused_.clear();
  if (!heard_ || !isOlder(report.stamp, newest_.stamp, report.arrival)) {
    if (heard_) noteStep(newest_.stamp, report.stamp, pace_);
    newest_ = DataTime(report.stamp, report.arrival);
  }
  heard_ = true;
  return too_old;
}

/// Returns whether a stamp is older than the newest one. A newest one that is far ahead of ROS time does not count: it
/// is of the time before the clock was set back.
bool TrackList::isOlder(Time stamp, Time newest, const Moment& arrival) const {
  return stamp < newest && seconds(newest - arrival.ros) <= max_future_;
}

bool TrackList::isForgotten(const Known& track, const Moment& now) const {
  return freshnessOf(track.time.age(now, simulated_) - tracker_.forget, periodOf(track), limits_) >= Freshness::lost;
}

bool TrackList::forget(const Moment& now) {
  const std::size_t before = tracks_.size();
  for (auto track = tracks_.begin(); track != tracks_.end();) {
    track = isForgotten(track->second, now) ? tracks_.erase(track) : std::next(track);
  }
  return tracks_.size() != before;
}

TrackSet TrackList::set() const {
  TrackSet set;
  for (const auto& [id, track] : tracks_) {
    set.tracks.push_back({id, track.world_from_track, track.time, periodOf(track)});
  }
  set.heard = heard_;
  set.newest = newest_;
  set.period = pace_.period();
  set.refused = refused_;
  return set;
}

}  // namespace hgrid
