// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/missing_sources.h"

namespace hgrid {

MissingSources::MissingSources(const Params& params) {
  for (const MapParams& map : params.maps) {
    set(SourceId::ofMap(map.name),
        "NOT_READY map '" + map.name + "': " +
            (map.topic.empty() ? "its file has not been read yet" : "no message has arrived on " + map.topic + " yet"));
  }
  for (const CloudParams& cloud : params.clouds) {
    set(SourceId::ofCloud(cloud.name),
        "NOT_READY cloud '" + cloud.name + "': no message has arrived on " + cloud.topic + " yet");
  }
  for (const TrackerParams& tracker : params.trackers) {
    set(SourceId::ofTracker(tracker.name),
        "NOT_READY tracker '" + tracker.name + "': no " +
            (tracker.type == TrackerType::markers ? "visualization_msgs/MarkerArray" : "geometry_msgs/PoseArray") +
            " has arrived on " + tracker.topic + " yet");
  }
}

void MissingSources::appendGaps(std::vector<SourceGap>& gaps) const {
  for (const auto& [source, sentence] : sentences_) gaps.push_back(gapOf(source, sentence));
}

}  // namespace hgrid
