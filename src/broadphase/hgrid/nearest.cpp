// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "broadphase/hgrid/engine.h"
#include "broadphase/hgrid/found_boxes.h"
#include "geometry/rounding.h"

namespace hgrid {
namespace {

/// Estimates the radius [m] of a sphere that contains `count` boxes of a level.
double likelyRadius(const kernels::Level& level, std::size_t count) {
  if (level.begin == level.end) return std::numeric_limits<double>::infinity();
  double volume = static_cast<double>(count) / (level.end - level.begin);
  for (int i = 0; i < 3; ++i) volume *= (level.grid.last[i] + 1.0) / static_cast<double>(level.grid.inverse[i]);
  return 0.5 * std::cbrt(volume);
}

/// Estimates the radius [m] of a sphere that contains `count` boxes of a layer with one row. `leaf` is the bounds of
/// some of them.
double likelyRadius(const kernels::Level& level, const kernels::Box& leaf, std::size_t count) {
  double longest = kLeastLength;
  std::array<double, 3> sides;
  for (int i = 0; i < 3; ++i) {
    longest = std::max(longest, static_cast<double>(leaf.max[i]) - leaf.min[i]);
    sides[static_cast<std::size_t>(i)] = static_cast<double>(level.around.max[i]) - level.around.min[i];
  }
  std::sort(sides.begin(), sides.end());
  // The boxes may be spread in space, on a surface or on a line.
  const double share = static_cast<double>(count) / (level.end - level.begin), on_line = share * sides[2];
  const double on_surface = std::sqrt(on_line * sides[1]), in_space = std::cbrt(on_line * sides[1] * sides[0]);
  const double along_row = longest * std::max(1.0, static_cast<double>(count) / BoundsTree::kPerLeaf);
  return std::min(along_row, std::max({0.5 * on_line, 0.5 * on_surface, 0.5 * in_space, kLeastLength}));
}

/// Estimates the radius [m] of a sphere that contains `count` of some boxes, whose number and common bounds are given.
double likelyRadius(const kernels::Box& bounds, std::size_t boxes, std::size_t count) {
  double longest = kLeastLength;
  for (int i = 0; i < 3; ++i) longest = std::max(longest, static_cast<double>(bounds.max[i]) - bounds.min[i]);
  return longest * std::cbrt(static_cast<double>(count) / static_cast<double>(boxes));
}

/// Returns the distance [m] of a point from a box, or 0 if the point is inside.
double distanceTo(const kernels::Box& bounds, const Eigen::Vector3d& point) {
  double squared = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double away = std::max({bounds.min[i] - point[i], point[i] - bounds.max[i], 0.0});
    squared += away * away;
  }
  return std::sqrt(squared);
}

/// A search for the boxes nearest to a point. It searches spheres of growing radius around the point.
struct SphereSearch {
  double radius = std::numeric_limits<double>::infinity();  // [m] estimate: a sphere of this radius has enough boxes
  double step = radius;                                     // [m] how much the radius grows if there were too few boxes

  /// Uses an estimate about some boxes, if it makes the sphere smaller. `away` [m] is the distance of these boxes from
  /// the point. A sphere of radius `within` [m] whose center is among these boxes contains enough of them.
  void consider(double within, double away) {
    if (!(away + within < radius)) return;
    radius = away + within;
    step = within;
  }
};

/// Estimates the first radius for a search for `count` boxes around a point.
template <class Engine>
SphereSearch searchAround(const Engine& engine, const Eigen::Vector3d& point, std::size_t count) {
  SphereSearch search;
  for (std::size_t number = 0; number < engine.layers.size(); ++number) {
    if (number == Engine::kLoose && engine.isHashed()) {
      const kernels::Box bounds = engine.singles.around();
      search.consider(likelyRadius(bounds, engine.singles.size(), count), distanceTo(bounds, point));
      continue;
    }
    const Layer& layer = engine.layers[number];
    layer.bounds().visit([&](const kernels::Box& bounds) { return distanceTo(bounds, point) < search.radius; },
                         [&](std::uint32_t number, const kernels::Box& bounds) {
                           const double within = layer.isOneRow() ? likelyRadius(layer.levels().front(), bounds, count)
                                                                  : likelyRadius(layer.levels()[number], count);
                           search.consider(within, distanceTo(bounds, point));
                         });
  }
  return search;
}

bool nearer(const NearHit& a, const NearHit& b) {
  return a.distance != b.distance ? a.distance < b.distance : a.id < b.id;
}

/// Keeps the nearest `count` hits and sorts them. `count` must be at least 1. If there are many more hits, most of
/// those that are too far are removed first: hits are counted in rings around the point, and those beyond the last ring
/// that is needed are removed. These loops have no branches that could be mispredicted.
/// @param radius  [m] where the rings end; hits may be farther away
void keepNearest(std::vector<NearHit>& hits, std::size_t count, double radius) {
  constexpr std::size_t kFew = 8, kRings = 32;
  constexpr double kLeastRadius = 1e-300;  // [m] of a division
  if (hits.size() <= 1) return;
  if (count == 1) {
    std::iter_swap(hits.begin(), std::min_element(hits.begin(), hits.end(), nearer));
    return hits.resize(1);
  }
  if (hits.size() > count + kFew) {
    const double scale = kRings / std::max(radius, kLeastRadius);
    const auto ringOf = [scale](const NearHit& hit) {  // the last ring if the product is NaN
      return static_cast<std::uint32_t>(std::min(kRings - 1.0, hit.distance * scale));
    };
    std::array<std::uint32_t, kRings> in_ring{};
    for (const NearHit& hit : hits) ++in_ring[ringOf(hit)];
    std::size_t last = 0, within = in_ring[0];
    while (within < count) within += in_ring[++last];
    std::size_t size = 0;
    for (const NearHit hit : hits) {
      hits[size] = hit;
      size += ringOf(hit) <= last ? 1 : 0;
    }
    hits.resize(size);
  }
  const auto end = hits.begin() + static_cast<std::ptrdiff_t>(std::min(count, hits.size()));
  const bool many = hits.size() > 2 * count;  // for example because the point is far away
  if (many) std::nth_element(hits.begin(), end, hits.end(), nearer);
  std::sort(hits.begin(), many ? end : hits.end(), nearer);
  hits.erase(end, hits.end());
}

}  // namespace

void HGrid::nearest(const Eigen::Vector3d& point, std::size_t count, double limit, std::vector<NearHit>& found) const {
  found.clear();
  const Engine& e = *engine_;
  count = std::min(count, e.stored);
  if (count == 0 || !(limit >= 0.0)) return;
  // Searches spheres of growing radius until a sphere contains enough boxes. Each search finds all boxes within the
  // radius.
  SphereSearch search = searchAround(e, point, count);
  for (double radius = std::min(search.radius, limit);;) {
    const bool all = !(radius < 1e30);  // the coordinates of a larger sphere may exceed the range of float
    found.clear();
    if (all) {
      for (ProxyId id = 0; id < e.layer_of.size(); ++id) {
        if (!e.isStored(id)) continue;
        const double away = distance(e.boxes[id], point);
        if (away <= limit) found.push_back({id, away});
      }
    } else {
      visitFound(e, boxOf(Sphere{point, radius}), [&](const auto& boxes, const PositionWriter& places) {
        std::size_t size = found.size();
        found.resize(size + places.size());
        for (const std::uint32_t place : places) {  // Store unconditionally and advance by 0 or 1: no misprediction
          const double away = distance(boxes.boxAt(place), point);
          found[size] = {boxes.idAt(place), away};
          size += away <= limit ? 1 : 0;
        }
        found.resize(size);
      });
    }
    // The search also finds boxes that are farther away than the radius: they are in the corners of the box around the
    // sphere. If the search found enough boxes, the next radius is the distance of the farthest box that is kept.
    const bool enough = found.size() >= count, last = all || radius >= limit;
    if (enough || last) keepNearest(found, count, radius);
    if (last || (enough && found.back().distance <= radius)) return;
    radius = std::min(enough ? found.back().distance : radius + std::max(search.step, 0.25 * radius), limit);
    search.step *= 2.0;
  }
}

}  // namespace hgrid
