// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The searches of Partition. Each one brings the structure up to date, asks it for candidates, and tests their boxes.
#include <cmath>
#include <limits>

#include "geometry/rounding.h"
#include "partitions/partition.h"

namespace hgrid {
namespace book {
namespace {

/// Keeps the candidates that pass a test, in ascending order.
template <class Test>
void keep(std::vector<ProxyId>& found, Test&& test) {
  found.erase(std::remove_if(found.begin(), found.end(), [&](ProxyId id) { return !test(id); }), found.end());
  std::sort(found.begin(), found.end());
}

}  // namespace

void Partition::overlappingPairs(std::vector<ProxyPair>& pairs) const {
  prepare();
  const PairBound none;
  PairSink sink(boxes_, fixed_, filter_, none, pairs);
  findPairs(sink);
  sink.finish();
}

bool Partition::boundedPairs(std::vector<ProxyPair>& pairs) const {
  prepare();
  PairSink sink(boxes_, fixed_, filter_, bound_, pairs);
  findPairs(sink);
  if (sink.finish()) return true;
  collectInOrder(pairs);
  return false;
}

/// Collects pairs in the order that PairBound specifies, up to the bound. A search that would exceed the bound needs
/// this, because the partitions find pairs in an order of their own.
void Partition::collectInOrder(std::vector<ProxyPair>& pairs) const {
  pairs.clear();
  std::size_t overlaps = 0;
  std::vector<ProxyId> found;
  std::vector<ProxyPair> mine;
  for (ProxyId id = 0; id < stored_.size(); ++id) {
    if (stored_[id] == 0 || fixed_[id] != 0) continue;
    found.clear();
    candidates(QueryShape(boxes_[id]), found);
    mine.clear();
    for (const ProxyId other : found) {
      const bool counts = other != id && (other > id || fixed_[other] != 0) && overlap(boxes_[id], boxes_[other]);
      if (counts) mine.push_back({std::min(id, other), std::max(id, other)});
    }
    std::sort(mine.begin(), mine.end());  // all of them contain `id`, so they are now sorted by the other id
    const bool cut = mine.size() > bound_.overlaps - overlaps;  // the bound allows only some of these pairs
    if (cut) mine.resize(bound_.overlaps - overlaps);
    overlaps += mine.size();
    for (ProxyPair *pair = mine.data(), *end = filter_(pair, pair + mine.size()); pair != end; ++pair) {
      if (pairs.size() == bound_.pairs) return;
      pairs.push_back(*pair);
    }
    if (cut) return;
  }
}

void Partition::findPairsByQueries(PairSink& sink) const {
  std::vector<ProxyId> found;
  for (ProxyId id = 0; id < stored_.size() && !sink.isFull(); ++id) {
    if (stored_[id] == 0 || fixed_[id] != 0) continue;
    found.clear();
    candidates(QueryShape(boxes_[id]), found);
    for (const ProxyId other : found) {
      if (other > id || (fixed_[other] != 0 && other != id)) sink.tryPair(id, other);
    }
  }
}

void Partition::overlapping(const Aabb& query, std::vector<ProxyId>& found) const {
  found.clear();
  if (!(query.min.array() <= query.max.array()).all()) return;  // also if a coordinate is NaN
  prepare();
  candidates(QueryShape(query), found);
  keep(found, [&](ProxyId id) { return overlap(query, boxes_[id]); });
}

void Partition::overlapping(const Sphere& sphere, std::vector<ProxyId>& found) const {
  found.clear();
  if (!sphere.center.allFinite() || !(sphere.radius >= 0.0)) return;
  prepare();
  candidates(QueryShape(sphere), found);
  keep(found, [&](ProxyId id) { return touches(sphere, boxes_[id]); });
}

void Partition::along(const Segment& segment, std::vector<SegmentHit>& found) const {
  found.clear();
  if (!segment.from.allFinite() || !segment.to.allFinite() || !(segment.radius >= 0.0)) return;
  prepare();
  std::vector<ProxyId> near;
  candidates(QueryShape(segment), near);
  const FirstTouch firstTouch(segment);
  for (const ProxyId id : near) {
    if (const auto along = firstTouch(boxes_[id])) found.push_back({id, *along});
  }
  std::sort(found.begin(), found.end(), [](const SegmentHit& a, const SegmentHit& b) {
    return a.along != b.along ? a.along < b.along : a.id < b.id;
  });
}

void Partition::nearest(const Eigen::Vector3d& point, std::size_t count, double limit,
                        std::vector<NearHit>& found) const {
  found.clear();
  count = std::min(count, count_);
  if (count == 0 || !(limit >= 0.0) || !point.allFinite()) return;
  prepare();
  findNearest(point, count, limit, found);
}

void Partition::findNearest(const Eigen::Vector3d& point, std::size_t count, double limit,
                            std::vector<NearHit>& found) const {
  // Searches spheres of growing radius. The first one reaches into the world by the distance at which `count` boxes are
  // expected, if the boxes are spread evenly.
  const double size = (world_.max.cast<double>() - world_.min.cast<double>()).maxCoeff();
  double step = 0.5 * size * std::cbrt(static_cast<double>(count) / static_cast<double>(count_)) + kLeastLength;
  double radius = std::min(distance(world_, point) + step, limit);
  std::vector<ProxyId> near;
  for (;;) {
    const bool all = !(radius < 1e30);  // looks at all boxes: the bounds of such a sphere may exceed the range of float
    near.clear();
    found.clear();
    constexpr float kFar = std::numeric_limits<float>::max();
    const Aabb everything{{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}};
    candidates(all ? QueryShape(everything) : QueryShape(Sphere{point, radius}), near);
    for (const ProxyId id : near) {
      const double away = distance(boxes_[id], point);
      if (away <= limit) found.push_back({id, away});
    }
    const std::size_t kept = std::min(count, found.size());
    std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kept), found.end(), isNearer);
    const bool enough = kept == count;
    if (all || radius >= limit || (enough && found[kept - 1].distance <= radius)) return found.resize(kept);
    // A candidate beyond the radius may be farther away than a box that was not found. If there are enough candidates,
    // a sphere that reaches the farthest one that was kept decides. Otherwise the sphere grows.
    step *= 2.0;
    radius = std::min(enough ? found[kept - 1].distance : radius + step, limit);
  }
}

}  // namespace book
}  // namespace hgrid
