// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/pair_markers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "node/messages/marker_parts.h"
#include "node/messages/to_messages.h"

namespace hgrid {
namespace {

using visualization_msgs::Marker;

constexpr std::size_t kMostPairs = 2000;
constexpr std::size_t kMostNames = 8;  // more texts on the screen could not be read
constexpr double kTextHeight = 0.04;   // [m]

/// What is drawn of one pair.
struct DrawnPair {
  std::uint32_t first = 0, second = 0;
  Eigen::Vector3d on_first = Eigen::Vector3d::Zero(), on_second = Eigen::Vector3d::Zero();  // [m, world]
  double distance = 0.0;                                                                    // [m]
  double nearness = 0.0;  // 0: the distance equals the margin; 1: contact
  bool measured = false;  // whether the points and the distance are those of the shapes; false: of the boxes
  std::string note;       // text in place of the distance; empty: the distance is shown
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
  drawn.distance = pair.gap;
  return drawn;
}

DrawnPair byShapes(const PairDistance& pair, double margin) {
  DrawnPair drawn;
  drawn.on_first = pair.proximity.on_first;
  drawn.on_second = pair.proximity.on_second;
  drawn.distance = pair.proximity.distance;
  drawn.measured = true;
  drawn.nearness = margin > 0.0 ? std::clamp(1.0 - drawn.distance / margin, 0.0, 1.0) : 1.0;
  if (pair.proximity.status != Measure::apart) drawn.note = name(pair.proximity.status);
  return drawn;
}

std_msgs::ColorRGBA colorOf(const DrawnPair& pair) {
  if (!pair.measured) return rgba(0.7, 0.7, 0.7, 0.8);
  return rgba(std::min(1.0, 2.0 * pair.nearness), std::min(1.0, 2.0 - 2.0 * pair.nearness), 0.1, 1.0);
}

/// Returns the pairs to draw: first those whose shapes were measured, then the others, each by distance. In a crowd of
/// bodies, many boxes overlap although the shapes are far apart, so boxes say little about which pairs are the nearest.
std::vector<DrawnPair> drawnPairs(const Snapshot& snapshot, const PairDistances* distances) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, const PairDistance*> measured;
  if (distances != nullptr) {
    for (const PairDistance& pair : distances->pairs) {
      if (pair.proximity.on_first.allFinite() && pair.proximity.on_second.allFinite())
        measured[{pair.first, pair.second}] = &pair;
    }
  }
  std::vector<const NearPair*> nearest;
  for (const NearPair& pair : snapshot.pairs()) nearest.push_back(&pair);
  std::stable_sort(nearest.begin(), nearest.end(),
                   [](const NearPair* a, const NearPair* b) { return a->gap < b->gap; });
  if (nearest.size() > kMostPairs) nearest.resize(kMostPairs);
  std::vector<DrawnPair> drawn;
  for (const NearPair* pair : nearest) {
    const auto found = measured.find({pair->first, pair->second});
    std::optional<DrawnPair> one =
        found != measured.end() ? byShapes(*found->second, pair->margin) : byBoxes(snapshot, *pair);
    if (!one) continue;
    one->first = pair->first;
    one->second = pair->second;
    drawn.push_back(std::move(*one));
  }
  std::stable_sort(drawn.begin(), drawn.end(), [](const DrawnPair& a, const DrawnPair& b) {
    return a.measured != b.measured ? a.measured : a.distance < b.distance;
  });
  return drawn;
}

std::string labelOf(const Snapshot& snapshot, const DrawnPair& pair) {
  const BodyList& bodies = snapshot.structure().bodies;
  const std::string millimeters = std::to_string(std::lround(1e3 * pair.distance)) + " mm";
  const std::string distance = !pair.measured ? "at least " + millimeters : pair.note.empty() ? millimeters : pair.note;
  return bodies[pair.first].name + " to " + bodies[pair.second].name + ": " + distance;
}

/// Finds a place for each text such that no text covers another. A text that is too near to an earlier text is placed
/// above it.
class TextPlaces {
 public:
  Eigen::Vector3d placeFor(Eigen::Vector3d wanted) {
    constexpr double kWidth = 25.0 * kTextHeight, kApart = 1.2 * kTextHeight, kStep = 1.3 * kTextHeight;
    for (std::size_t i = 0; i < taken_.size();) {
      const Eigen::Vector3d away = wanted - taken_[i];
      if (away.head<2>().norm() < kWidth && std::abs(away.z()) < kApart) {
        wanted.z() = taken_[i].z() + kStep;  // higher than before, so the loop ends
        i = 0;                               // the new place may be too near to an earlier text
      } else {
        ++i;
      }
    }
    taken_.push_back(wanted);
    return wanted;
  }

 private:
  std::vector<Eigen::Vector3d> taken_;
};

}  // namespace

std::vector<Marker> pairMarkers(const Tick& tick, const PairDistances* distances) {
  std::vector<Marker> markers = {markerOf(tick, "pairs", 0, Marker::LINE_LIST),
                                 markerOf(tick, "pairs", 1, Marker::SPHERE_LIST)};
  markers[0].scale.x = 0.008;
  markers[1].scale.x = markers[1].scale.y = markers[1].scale.z = 0.02;
  for (std::size_t i = 0; i < kMostNames; ++i) {
    markers.push_back(markerOf(tick, "pair_names", static_cast<int>(i), Marker::TEXT_VIEW_FACING));
    markers.back().scale.z = kTextHeight;
  }
  if (!tick.snapshot) return markers;
  TextPlaces places;
  std::size_t named = 0;
  for (const DrawnPair& pair : drawnPairs(*tick.snapshot, distances)) {
    const std_msgs::ColorRGBA color = colorOf(pair);
    addLine(markers[0], pair.on_first, pair.on_second, color);
    addLine(markers[1], pair.on_first, pair.on_second, color);
    if (named == kMostNames) continue;
    Marker& text = markers[2 + named++];
    text.action = Marker::ADD;
    text.text = labelOf(*tick.snapshot, pair);
    text.color = color;
    Eigen::Vector3d wanted = 0.5 * (pair.on_first + pair.on_second);
    wanted.z() += 1.5 * kTextHeight;  // beside the line, not on it
    text.pose.position = toPoint(places.placeFor(wanted));
  }
  return markers;
}

}  // namespace hgrid
