// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/markers/state_markers.h"

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "node/markers/marker_parts.h"

namespace hgrid {
namespace {

constexpr std::size_t kMostShownStates = 20;
constexpr double kStatesApart = 5.0;  // [text heights]

/// The bodies of one source whose pose is STALE or worse.
struct OldBodies {
  std::map<Freshness, std::size_t, std::greater<>> count;  // for each state, worst first
  std::size_t total = 0;
  Eigen::AlignedBox3d around;  // [m, world] their boxes, or positions of bodies without boxes
  std::uint32_t last = 0;      // index of the last of them
};

std::string textOf(const Structure& structure, std::uint32_t source, const OldBodies& old) {
  if (old.total == 1) return structure.bodies[old.last].name + ": " + name(old.count.begin()->first);
  std::string text = structure.sources[source];
  const char* separator = ": ";
  for (const auto& [state, count] : old.count) {
    text += separator + std::to_string(count) + " " + name(state);
    separator = ", ";
  }
  return text;
}

}  // namespace

std::vector<visualization_msgs::Marker> stateMarkers(const Tick& tick, const MarkerScale& scale) {
  std::vector<Label> labels;
  if (tick.snapshot) {
    const Snapshot& snapshot = *tick.snapshot;
    const Structure& structure = snapshot.structure();
    std::map<std::uint32_t, OldBodies> old_of;  // by the index of the source
    for (const std::uint32_t body : snapshot.watched()) {
      const BodyPose& pose = snapshot.poses()[body];
      if (pose.state < Freshness::stale || pose.state == Freshness::unplaced) continue;
      OldBodies& old = old_of[structure.source_of[body]];
      ++old.count[pose.state];
      ++old.total;
      old.around.extend(pose.world_from_body.translation());
      for (ProxyId proxy = structure.first_proxy[body]; proxy < structure.first_proxy[body + 1]; ++proxy) {
        if (!structure.isPlane(proxy))
          old.around.extend(inDouble(snapshot.boxes()[proxy]).translate(snapshot.origin()));
      }
      old.last = body;
    }
    std::vector<std::pair<std::uint32_t, OldBodies>> worst_first(old_of.begin(), old_of.end());
    std::stable_sort(worst_first.begin(), worst_first.end(), [](const auto& a, const auto& b) {
      return a.second.count.begin()->first > b.second.count.begin()->first;
    });
    if (worst_first.size() > kMostShownStates) worst_first.resize(kMostShownStates);
    for (const auto& [source, old] : worst_first) {
      Eigen::Vector3d place = old.around.center();
      place.z() = old.around.max().z() + scale.text_height;
      labels.push_back({place, textOf(structure, source, old)});
    }
  }
  return textsOf(tick, "states", kMostShownStates, scale.text_height,
                 joinedLabels(labels, kStatesApart * scale.text_height, "\n"));
}

}  // namespace hgrid
