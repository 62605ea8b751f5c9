// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/queries/query_sizes.h"

#include <algorithm>
#include <cmath>

namespace hgrid {
namespace bench {
namespace {

constexpr double kHits = 0.65;  // wanted hits per query

double longestEdge(const Aabb& box) { return double((box.max - box.min).maxCoeff()); }

double medianEdge(const std::vector<Aabb>& boxes) {
  std::vector<double> edges;
  for (const Aabb& box : boxes) edges.push_back(longestEdge(box));
  const auto middle = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2);
  std::nth_element(edges.begin(), middle, edges.end());
  return *middle;
}

/// Returns the expected number of hits of a cube whose center is at a random place in the bounds. Each box adds the
/// probability that the cube hits it.
double hitsOfCube(const std::vector<Aabb>& boxes, const Aabb& bounds, double half_edge) {
  double sum = 0.0;
  for (const Aabb& box : boxes) {
    double share = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double low = std::max(double(bounds.min[axis]), double(box.min[axis]) - half_edge);
      const double high = std::min(double(bounds.max[axis]), double(box.max[axis]) + half_edge);
      share *= (high - low) / double(bounds.max[axis] - bounds.min[axis]);
    }
    sum += share;
  }
  return sum;
}

/// Returns the half edge [m] of cubes with kHits expected hits, limited to the range low .. high.
double halfEdge(const std::vector<Aabb>& boxes, const Aabb& bounds, double low, double high) {
  for (int i = 0; i < 20; ++i) {
    const double middle = 0.5 * (low + high);
    (hitsOfCube(boxes, bounds, middle) < kHits ? low : high) = middle;
  }
  return low;
}

/// Returns the length [m] of segments with kHits expected hits. The area of a box as seen along a segment is, on
/// average over all directions, a quarter of the surface of the box.
double lengthOf(const std::vector<Aabb>& boxes, const Aabb& bounds) {
  double volume = 0.0, swept = 0.0;
  for (const Aabb& box : boxes) {
    const Eigen::Vector3d edges = (box.max - box.min).cast<double>();
    volume += edges.prod();
    swept += 0.5 * (edges.x() * edges.y() + edges.y() * edges.z() + edges.z() * edges.x());
  }
  const double space = (bounds.max - bounds.min).cast<double>().prod();
  return std::max(0.0, kHits * space - volume) / swept;
}

}  // namespace

Aabb boundsOf(const std::vector<Aabb>& boxes) {
  Aabb bounds = boxes.front();
  for (const Aabb& box : boxes) {
    bounds.min = bounds.min.cwiseMin(box.min);
    bounds.max = bounds.max.cwiseMax(box.max);
  }
  return bounds;
}

QuerySizes sizesForEmptySpace(const std::vector<Aabb>& boxes) {
  const Aabb bounds = boundsOf(boxes);
  const double edge = medianEdge(boxes);
  const double half_edge = halfEdge(boxes, bounds, 1e-4 * edge, 2.0 * edge);
  const double radius = 1.15 * half_edge;  // a sphere with this radius meets about as many boxes as the cube
  return {half_edge, radius, std::clamp(lengthOf(boxes, bounds), 1e-4 * edge, 0.2 * longestEdge(bounds))};
}

}  // namespace bench
}  // namespace hgrid
