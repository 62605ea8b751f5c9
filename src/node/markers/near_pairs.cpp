// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/markers/near_pairs.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "node/messages/pair_points.h"

namespace hgrid {
namespace {

constexpr std::size_t kMostPairs = 2000;

/// A near pair, before its points are computed.
struct Candidate {
  const NearPair* pair;
  const PairDistance* measured;  // null: not measured
  double distance;               // [m]
};

/// Returns a nearest point on each of two boxes, or on a plane and a box [m], relative to the origin of the snapshot.
BoxPoints pointsOf(const Snapshot& snapshot, ProxyId first, ProxyId second) {
  const bool plane_first = snapshot.structure().isPlane(first), plane_second = snapshot.structure().isPlane(second);
  const Eigen::AlignedBox3d a = inDouble(snapshot.boxes()[first]), b = inDouble(snapshot.boxes()[second]);
  if (!plane_first && !plane_second) return nearestPoints(a, b);
  const HalfSpace& plane = snapshot.halfSpaceOf(plane_first ? first : second);
  const Eigen::Vector3d corner = deepestCorner(plane, plane_first ? b : a);
  const Eigen::Vector3d on_plane = corner - signedDistance(plane, corner) * plane.normal;
  return plane_first ? BoxPoints{on_plane, corner} : BoxPoints{corner, on_plane};
}

/// Returns the pair with the nearest points of its boxes. nullopt if one of the bodies is a map.
std::optional<DrawnPair> byBoxes(const Snapshot& snapshot, const NearPair& pair) {
  const Structure& structure = snapshot.structure();
  double least = std::numeric_limits<double>::infinity();
  ProxyId first = 0, second = 0;
  for (ProxyId i = structure.first_proxy[pair.first]; i < structure.first_proxy[pair.first + 1]; ++i) {
    for (ProxyId j = structure.first_proxy[pair.second]; j < structure.first_proxy[pair.second + 1]; ++j) {
      const double gap = snapshot.gapOfProxies(i, j);
      if (gap < least) least = gap, first = i, second = j;
    }
  }
  if (std::isinf(least)) return std::nullopt;
  const BoxPoints points = pointsOf(snapshot, first, second);
  DrawnPair drawn;
  drawn.on_first = points.on_first + snapshot.origin();
  drawn.on_second = points.on_second + snapshot.origin();
  return drawn;
}

DrawnPair byShapes(const PairDistance& pair) {
  const PairPoints points = pointsOf(pair);
  DrawnPair drawn;
  drawn.on_first = points.on_first;
  drawn.on_second = points.on_second;
  drawn.measured = true;
  if (pair.proximity.status != Measure::apart) drawn.status = name(pair.proximity.status);
  return drawn;
}

/// Lists the near pairs. Pairs whose boxes are near but whose shapes are not are left out: there are many in a crowd.
/// @param report  [m] a pair that `distances` does not list is known to be farther apart than this
std::vector<Candidate> candidatesOf(const Snapshot& snapshot, const PairDistances* distances, double report) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, const PairDistance*> listed;
  if (distances != nullptr) {
    for (const PairDistance& pair : distances->pairs) listed[{pair.first, pair.second}] = &pair;
  }
  std::vector<Candidate> candidates;
  for (const NearPair& pair : snapshot.pairs()) {
    Candidate candidate{&pair, nullptr, pair.gap};
    const auto found = listed.find({pair.first, pair.second});
    if (found != listed.end()) {
      const Proximity& proximity = found->second->proximity;
      const bool known = !std::isnan(proximity.distance);
      candidate.distance = isContact(proximity.status) ? 0.0 : known ? proximity.distance : found->second->lower_bound;
      const PairPoints points = pointsOf(*found->second);
      if (points.on_first.allFinite() && points.on_second.allFinite()) candidate.measured = found->second;
    } else if (distances != nullptr) {
      candidate.distance = std::max(pair.gap, report + snapshot.growthOf(pair.first, pair.second));
      if (candidate.distance >= pair.margin) continue;
    }
    candidates.push_back(candidate);
  }
  return candidates;
}

std::vector<std::optional<double>> nearnessOf(const Snapshot& snapshot, const std::vector<Candidate>& candidates) {
  std::vector<std::optional<double>> nearness(snapshot.structure().bodies.size());
  for (const Candidate& candidate : candidates) {
    const double margin = candidate.pair->margin;
    const double near = margin > 0.0 ? std::clamp(1.0 - candidate.distance / margin, 0.0, 1.0) : 1.0;
    for (const std::uint32_t body : {candidate.pair->first, candidate.pair->second}) {
      nearness[body] = std::max(nearness[body].value_or(0.0), near);
    }
  }
  return nearness;
}

}  // namespace

NearPairs nearPairs(const Tick& tick, const PairDistances* distances) {
  NearPairs near;
  if (!tick.snapshot) return near;
  const Snapshot& snapshot = *tick.snapshot;
  std::vector<Candidate> candidates = candidatesOf(snapshot, distances, tick.settings->params.reportDistance());
  near.count = candidates.size();
  near.nearness = nearnessOf(snapshot, candidates);
  std::stable_sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    const bool a_measured = a.measured != nullptr, b_measured = b.measured != nullptr;
    return a_measured != b_measured ? a_measured : a.distance < b.distance;
  });
  if (candidates.size() > kMostPairs) candidates.resize(kMostPairs);
  for (const Candidate& candidate : candidates) {
    std::optional<DrawnPair> drawn =
        candidate.measured != nullptr ? byShapes(*candidate.measured) : byBoxes(snapshot, *candidate.pair);
    if (!drawn) continue;
    drawn->first = candidate.pair->first;
    drawn->second = candidate.pair->second;
    drawn->distance = candidate.distance;
    near.drawn.push_back(std::move(*drawn));
  }
  return near;
}

}  // namespace hgrid
