// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/queries/judge.h"

#include <algorithm>
#include <cmath>

#include "bench/queries/exact.h"

namespace hgrid {
namespace bench {
namespace {

/// Replaces `hits` with the boxes that the sphere touches. Returns false if rounding may decide whether a box is a hit.
bool hitsOfSphere(const Sphere& sphere, const std::vector<Aabb>& boxes, double doubt, std::vector<ProxyId>& hits) {
  const double low = std::pow(std::max(0.0, sphere.radius - doubt), 2), high = std::pow(sphere.radius + doubt, 2);
  hits.clear();
  bool clear = true;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const double squared = squaredGap(boxes[i], sphere.center);
    if (squared > high) continue;
    clear = clear && squared <= low;
    hits.push_back(static_cast<ProxyId>(i));
  }
  return clear;
}

bool hitsOfSegment(const Segment& segment, const std::vector<Aabb>& boxes, double doubt, std::vector<ProxyId>& hits) {
  const SlabTest test(segment);
  hits.clear();
  bool clear = true;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!test.meets(boxes[i], doubt)) continue;
    clear = clear && test.meets(boxes[i], -doubt);
    hits.push_back(static_cast<ProxyId>(i));
  }
  return clear;
}

bool hitsOfBox(const Aabb& box, const std::vector<Aabb>& boxes, std::vector<ProxyId>& hits) {
  hits.clear();
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (overlap(box, boxes[i])) hits.push_back(static_cast<ProxyId>(i));
  }
  return true;
}

bool hitsOfNearest(const Eigen::Vector3d& point, std::size_t k, const std::vector<Aabb>& boxes, double doubt,
                   std::vector<ProxyId>& hits) {
  std::vector<std::pair<double, ProxyId>> all;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    all.emplace_back(std::sqrt(squaredGap(boxes[i], point)), static_cast<ProxyId>(i));
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(k + 1), all.end());
  hits.clear();
  for (std::size_t i = 0; i < k; ++i) hits.push_back(all[i].second);
  return all[k].first - all[k - 1].first > doubt;
}

}  // namespace

Judge::Judge(QueryKind kind, const QuerySet& queries, const std::vector<Aabb>& boxes) {
  const double doubt = doubtOf(boxes);
  std::vector<ProxyId> hits;
  const auto answer = [&](std::size_t i) {
    switch (kind) {
      case QueryKind::sphere:
        return hitsOfSphere(queries.spheres[i], boxes, doubt, hits);
      case QueryKind::segment:
        return hitsOfSegment(queries.segments[i], boxes, doubt, hits);
      case QueryKind::box:
        return hitsOfBox(queries.boxes[i], boxes, hits);
      case QueryKind::nearest:
      case QueryKind::nearest8:
        break;
    }
    return hitsOfNearest(queries.spheres[i].center, countOf(kind), boxes, doubt, hits);
  };
  for (std::size_t i = 0; i < std::min(kFirst, queries.size()); ++i) {
    judged_.push_back(answer(i));
    if (!judged_.back()) continue;
    ++judged_count_;
    count_ += hits.size();
    for (const ProxyId id : hits) checksum_.add(hit(i, id));
  }
}

}  // namespace bench
}  // namespace hgrid
