// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/workload/layout.h"

#include <cmath>

namespace hgrid {
namespace bench {

using Eigen::Vector3f;

const Region& Layout::addRegion(const Vector3f& low, const Vector3f& high) {
  regions.push_back({low, high});
  return regions.back();
}

void Layout::addCube(double edge, const Vector3f& center, const Region& region) {
  halves.push_back(Vector3f::Constant(static_cast<float>(0.5 * edge)));
  walkers.emplace_back(walkers.size(), center, static_cast<float>(edge), region);
}

void Layout::addBox(const Vector3f& edges, float size, const Vector3f& center, const Region& region) {
  halves.push_back(0.5f * edges);
  walkers.emplace_back(walkers.size(), center, size, region);
}

void Layout::addSwaying(const Vector3f& edges, float size, const Eigen::Vector3d& rest, const Region& sway) {
  rests.push_back(rest.cast<float>());
  addBox(edges, size, Vector3f::Zero(), sway);
}

Vector3f randomPoint(Random& random, const Region& region) {
  Vector3f point;
  for (int axis = 0; axis < 3; ++axis)
    point[axis] = static_cast<float>(random.uniform(double(region.low[axis]), double(region.high[axis])));
  return point;
}

double usualSide(double n) { return std::cbrt(4.0 * n); }

}  // namespace bench
}  // namespace hgrid
