// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tracks/placed_report.h"

#include <algorithm>
#include <map>

#include "hgrid_proximity/refusal.h"

namespace hgrid {

std::vector<std::pair<std::string, Time>> framesOf(const TrackReport& report) {
  std::vector<std::pair<std::string, Time>> frames;
  for (const TrackReport::Reported& pose : report.poses) frames.emplace_back(pose.frame, pose.stamp);
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

std::vector<PlacedReport> placedInWorld(const TrackReport& report, const TransformLookup& transforms,
                                        const std::string& world_frame, bool upright, double world_limit) {
  std::map<std::pair<std::string, Time>, Pose> world_from;
  for (const auto& [frame, stamp] : framesOf(report)) {
    Pose& pose = world_from.emplace(std::pair(frame, stamp), Pose::Identity()).first->second;
    if (frame == world_frame) continue;
    std::string why;
    const auto found = transforms.at(world_frame, frame, stamp, &why);
    if (!found) {
      throw Refusal(transforms.newest(world_frame, frame) ? Code::extrapolation : Code::unknown_frame,
                    "the pose of frame '" + printable(frame) + "' in '" + world_frame + "' at " + text(seconds(stamp)) +
                        " s is not known: " + printable(why, 300));
    }
    pose = found->pose();
  }
  std::vector<PlacedReport> placed;
  for (const TrackReport::Reported& reported : report.poses) {
    Pose pose = world_from.at({reported.frame, reported.stamp}) * reported.frame_from_track;
    if (upright) pose.linear().setIdentity();
    checkWithin(pose.translation(), world_limit, reported.id.empty() ? "a pose" : "marker '" + reported.id + "'");
    placed.push_back({reported.id, reported.stamp, pose});
  }
  return placed;
}

}  // namespace hgrid
