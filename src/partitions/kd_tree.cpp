// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "partitions/kd_tree.h"

namespace hgrid {
namespace book {

void KdTree::candidates(const QueryShape& shape, std::vector<ProxyId>& found) const {
  tree_.visit(shape, [&](ProxyId id) {
    if (overlap(shape.bounds(), box(id))) found.push_back(id);
  });
}

std::optional<SegmentHit> KdTree::firstAlong(const Segment& segment) const {
  if (!segment.from.allFinite() || !segment.to.allFinite() || !(segment.radius >= 0.0)) return std::nullopt;
  prepare();
  const FirstTouch firstTouch(segment);
  const double length = (segment.to - segment.from).norm();
  std::optional<SegmentHit> first;
  tree_.visitAlong(QueryShape(segment), [&](ProxyId id) {
    const auto along = firstTouch(box(id));
    const bool is_first = along && (!first || *along < first->along || (*along == first->along && id < first->id));
    if (is_first) first = SegmentHit{id, *along};
    return first && length > 0.0 ? first->along / length : 1.0;
  });
  return first;
}

void KdTree::findNearest(const Eigen::Vector3d& point, std::size_t count, double limit,
                         std::vector<NearHit>& found) const {
  // `found` is a heap with the farthest hit in front. The sphere begins to shrink when the heap has `count` hits.
  tree_.visitNear(point, limit, [&](ProxyId id) {
    const NearHit hit{id, distance(box(id), point)};
    const bool is_full = found.size() == count;
    if (hit.distance <= limit && (!is_full || isNearer(hit, found.front()))) {
      if (is_full) {
        std::pop_heap(found.begin(), found.end(), isNearer);
        found.pop_back();
      }
      found.push_back(hit);
      std::push_heap(found.begin(), found.end(), isNearer);
    }
    return found.size() == count ? found.front().distance : limit;
  });
  std::sort_heap(found.begin(), found.end(), isNearer);
}

void KdTree::checkStructure() const {
  std::vector<ProxyId> held = tree_.ids();
  std::sort(held.begin(), held.end());
  require(held == storedIds(), "each box is in one leaf");
  std::vector<ProxyId> found;
  for (const ProxyId id : held) {
    found.clear();
    candidates(QueryShape(box(id)), found);
    require(std::count(found.begin(), found.end(), id) == 1, "a search with a stored box finds it");
  }
}

void KdTree::draw(std::vector<Aabb>& regions) const {
  tree_.visitRegions(world(), [&](const Aabb& region) { regions.push_back(region); });
}

}  // namespace book
}  // namespace hgrid
