// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/markers.h"

#include <algorithm>
#include <cmath>

#include "node/messages/to_messages.h"

namespace hgrid {
namespace {

using visualization_msgs::Marker;

constexpr int kMostTexts = 20;  // only the nearest pairs have a text, because more texts would be unreadable
constexpr auto kQueryShownFor = std::chrono::seconds(3);

std_msgs::ColorRGBA color(double r, double g, double b, double a) {
  std_msgs::ColorRGBA result;
  result.r = static_cast<float>(r);
  result.g = static_cast<float>(g);
  result.b = static_cast<float>(b);
  result.a = static_cast<float>(a);
  return result;
}

/// Returns the color of a level. Color-blind people can distinguish these colors, too (after Okabe and Ito, 2008).
std_msgs::ColorRGBA levelColor(int level) {
  static const std_msgs::ColorRGBA kColors[] = {color(0.34, 0.71, 0.91, 0.9), color(0.90, 0.62, 0.00, 0.9),
                                                color(0.00, 0.62, 0.45, 0.9), color(0.80, 0.47, 0.65, 0.9),
                                                color(0.94, 0.89, 0.26, 0.9), color(0.00, 0.45, 0.70, 0.9)};
  return kColors[static_cast<std::size_t>(std::max(level, 0)) % 6];
}

std_msgs::ColorRGBA verdictColor(Verdict verdict) {
  if (verdict == Verdict::hit) return color(0.84, 0.37, 0.0, 0.5);
  return verdict == Verdict::clear ? color(0.0, 0.62, 0.45, 0.5) : color(0.6, 0.6, 0.6, 0.5);
}

Marker marker(const Tick& tick, const char* layer, int id, int type) {
  Marker result;
  result.header = headerOf(tick);
  result.ns = layer;
  result.id = id;
  result.type = type;
  result.action = Marker::DELETE;  // changed to ADD when there is something to draw
  result.pose.orientation.w = 1.0;
  result.scale.x = result.scale.y = result.scale.z = 0.01;
  result.color = color(1.0, 1.0, 1.0, 1.0);
  return result;
}

void addLine(Marker& lines, const Eigen::Vector3d& from, const Eigen::Vector3d& to, const std_msgs::ColorRGBA& tint) {
  lines.action = Marker::ADD;
  for (const Eigen::Vector3d& end : {from, to}) {
    lines.points.push_back(toPoint(end));
    lines.colors.push_back(tint);
  }
}

void addEdges(Marker& lines, const Aabb& box, const Eigen::Vector3d& origin, const std_msgs::ColorRGBA& tint) {
  const auto corner = [&](int bits) {
    Eigen::Vector3d point;
    for (int axis = 0; axis < 3; ++axis)
      point[axis] = origin[axis] + (bits >> axis & 1 ? box.max[axis] : box.min[axis]);
    return point;
  };
  for (int bits = 0; bits < 8; ++bits) {
    for (int axis = 0; axis < 3; ++axis) {
      if ((bits >> axis & 1) == 0) addLine(lines, corner(bits), corner(bits | 1 << axis), tint);
    }
  }
}

void addPair(Marker& lines, const Snapshot& snapshot, const NearPair& pair) {
  const Structure& structure = snapshot.structure();
  double least = std::numeric_limits<double>::infinity();
  ProxyId first = 0, second = 0;
  for (ProxyId i = structure.first_proxy[pair.first]; i < structure.first_proxy[pair.first + 1]; ++i) {
    for (ProxyId j = structure.first_proxy[pair.second]; j < structure.first_proxy[pair.second + 1]; ++j) {
      const double gap = distance(snapshot.boxes()[i], snapshot.boxes()[j]);
      if (gap < least) least = gap, first = i, second = j;
    }
  }
  if (std::isinf(least)) return;  // a map has no boxes; markers of its distances show its pairs
  BoxPoints points = nearestPoints(inDouble(snapshot.boxes()[first]), inDouble(snapshot.boxes()[second]));
  if (least == 0.0) {  // the boxes overlap: draw from center to center
    points.on_first = inDouble(snapshot.boxes()[first]).center();
    points.on_second = inDouble(snapshot.boxes()[second]).center();
  }
  const double nearness = pair.margin > 0.0 ? 1.0 - pair.gap / pair.margin : 1.0;
  addLine(lines, points.on_first + snapshot.origin(), points.on_second + snapshot.origin(),
          color(1.0, 1.0 - 0.9 * nearness, 0.1, 1.0));
}

/// Returns a color between green (as far away as `farthest` [m]) and red (in contact), or gray if nothing was measured.
std_msgs::ColorRGBA distanceColor(const PairDistance& pair, double farthest) {
  if (std::isnan(pair.proximity.distance)) return color(0.6, 0.6, 0.6, 1.0);
  const double nearness = farthest > 0.0 ? 1.0 - std::min(1.0, pair.proximity.distance / farthest) : 1.0;
  return color(std::min(1.0, 2.0 * nearness), std::min(1.0, 2.0 - 2.0 * nearness), 0.1, 1.0);
}

std::string distanceText(const PairDistance& pair) {
  if (pair.proximity.status != Measure::apart) return name(pair.proximity.status);
  return std::to_string(std::lround(1e3 * pair.proximity.distance)) + " mm";
}

/// Adds a line between the nearest points of each pair, and fills `texts` with the distances of the first pairs.
void addDistances(const PairDistances& distances, Marker& lines, std::vector<Marker>& texts) {
  double farthest = 0.0;
  for (const PairDistance& pair : distances.pairs) {
    if (std::isfinite(pair.proximity.distance)) farthest = std::max(farthest, pair.proximity.distance);
  }
  std::size_t written = 0;
  for (const PairDistance& pair : distances.pairs) {
    if (!pair.proximity.on_first.allFinite() || !pair.proximity.on_second.allFinite()) continue;
    const std_msgs::ColorRGBA tint = distanceColor(pair, farthest);
    addLine(lines, pair.proximity.on_first, pair.proximity.on_second, tint);
    if (written == texts.size()) continue;
    Marker& text = texts[written++];
    text.action = Marker::ADD;
    text.text = distanceText(pair);
    text.color = tint;
    text.pose.position = toPoint(0.5 * (pair.proximity.on_first + pair.proximity.on_second));
    text.pose.position.z += text.scale.z;  // beside the line, not on it
  }
}

}  // namespace

void QuerySketch::show(const Sphere& sphere, Verdict verdict) {
  const std::lock_guard<std::mutex> lock(mutex_);
  sphere_ = Drawn<Sphere>{sphere, verdict, std::chrono::steady_clock::now()};
}

void QuerySketch::show(const Segment& segment, Verdict verdict) {
  const std::lock_guard<std::mutex> lock(mutex_);
  segment_ = Drawn<Segment>{segment, verdict, std::chrono::steady_clock::now()};
}

std::optional<QuerySketch::Drawn<Sphere>> QuerySketch::sphere() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return sphere_;
}

std::optional<QuerySketch::Drawn<Segment>> QuerySketch::segment() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return segment_;
}

visualization_msgs::MarkerArray markers(const Tick& tick, const QuerySketch& queries, const PairDistances* distances) {
  Marker boxes = marker(tick, "boxes", 0, Marker::LINE_LIST),
         not_fresh = marker(tick, "not_fresh", 0, Marker::LINE_LIST),
         pairs = marker(tick, "pairs", 0, Marker::LINE_LIST), nearest = marker(tick, "distances", 0, Marker::LINE_LIST),
         query_sphere = marker(tick, "queries", 0, Marker::SPHERE), ray = marker(tick, "queries", 1, Marker::LINE_LIST);
  boxes.scale.x = 0.004;
  not_fresh.scale.x = 0.012;
  pairs.scale.x = 0.02;
  nearest.scale.x = 0.008;
  std::vector<Marker> texts;
  for (int i = 0; i < kMostTexts; ++i) {
    texts.push_back(marker(tick, "distance_texts", i, Marker::TEXT_VIEW_FACING));
    texts.back().scale.z = 0.05;
  }
  if (tick.snapshot) {
    const Snapshot& snapshot = *tick.snapshot;
    for (ProxyId proxy = 0; proxy < snapshot.boxes().size(); ++proxy) {
      const Freshness state = snapshot.poses()[snapshot.structure().body_of_proxy[proxy]].state;
      if (state == Freshness::unplaced) continue;
      const bool trusted = state <= Freshness::late;
      addEdges(trusted ? boxes : not_fresh, snapshot.boxes()[proxy], snapshot.origin(),
               trusted ? levelColor(snapshot.broadPhase().levelOf(proxy)) : color(0.9, 0.1, 0.1, 1.0));
    }
    for (const NearPair& pair : snapshot.pairs()) addPair(pairs, snapshot, pair);
  }
  if (distances != nullptr) addDistances(*distances, nearest, texts);
  const auto now = std::chrono::steady_clock::now();
  const auto sphere = queries.sphere();
  if (sphere && now - sphere->at < kQueryShownFor) {
    query_sphere.action = Marker::ADD;
    query_sphere.pose.position = toPoint(sphere->geometry.center);
    query_sphere.scale.x = query_sphere.scale.y = query_sphere.scale.z = std::max(0.02, 2.0 * sphere->geometry.radius);
    query_sphere.color = verdictColor(sphere->verdict);
  }
  const auto segment = queries.segment();
  if (segment && now - segment->at < kQueryShownFor) {
    ray.scale.x = std::max(0.01, 2.0 * segment->geometry.radius);
    addLine(ray, segment->geometry.from, segment->geometry.to, verdictColor(segment->verdict));
  }
  visualization_msgs::MarkerArray array;
  array.markers = {boxes, not_fresh, pairs, nearest, query_sphere, ray};
  array.markers.insert(array.markers.end(), texts.begin(), texts.end());
  return array;
}

visualization_msgs::MarkerArray markersGone(const Tick& tick) {
  visualization_msgs::MarkerArray array;
  array.markers.push_back(marker(tick, "boxes", 0, Marker::LINE_LIST));
  array.markers.back().action = Marker::DELETEALL;
  return array;
}

}  // namespace hgrid
