// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <cmath>

#include "bench/workload/layouts.h"
#include "bench/workload/random_points.h"

namespace hgrid {
namespace bench {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Returns a row of n cubes with usualEdge() and a distance of `step` [m]. The origin is in the middle of the row.
Layout chain(std::size_t n, const Vector3d& step) {
  Layout layout;
  layout.side = double(n) * step.maxCoeff();
  const Region& sway = layout.addRegion(Vector3f::Constant(-0.1f), Vector3f::Constant(0.1f));
  Random random(1);
  for (std::size_t i = 0; i < n; ++i) {
    const auto edge = static_cast<float>(usualEdge(random));
    layout.addSwaying(Vector3f::Constant(edge), edge, (double(i) - 0.5 * double(n)) * step, sway);
  }
  return layout;
}

}  // namespace

Layout lineLayout(std::size_t n) { return chain(n, {0.0, 0.0, 0.7}); }

Layout diagonalLayout(std::size_t n) { return chain(n, Vector3d::Constant(0.35 / std::sqrt(3.0))); }

Layout levyLayout(std::size_t n) {
  constexpr double kShortest = 0.5;  // [m]
  Layout layout;
  const Region& sway = layout.addRegion(Vector3f::Constant(-0.1f), Vector3f::Constant(0.1f));
  Random random(1);
  Vector3d at = Vector3d::Zero(), low = at, high = at;
  for (std::size_t i = 0; i < n; ++i) {
    const auto edge = static_cast<float>(usualEdge(random));
    layout.addSwaying(Vector3f::Constant(edge), edge, at, sway);
    // The probability density of the step length is proportional to step^-2.5.
    const double step = kShortest * std::pow(1.0 - random.uniform(0.0, 1.0), -1.0 / 1.5);
    at += step * direction(random);
    low = low.cwiseMin(at), high = high.cwiseMax(at);
  }
  layout.side = (high - low).maxCoeff();
  return layout;
}

Layout torusLayout(std::size_t n) {
  constexpr double kPi = 3.14159265358979, kMajor = 10e3, kMinor = 1e3;  // [m]
  Layout layout;
  layout.side = 2.0 * (kMajor + kMinor);
  const Region& sway = layout.addRegion(Vector3f::Constant(-2.f), Vector3f::Constant(2.f));
  Random random(1);
  while (layout.walkers.size() < n) {
    const double around = random.uniform(-kPi, kPi), across = random.uniform(-kPi, kPi);
    const double radius = kMajor + kMinor * std::cos(across);
    if (random.uniform(0.0, kMajor + kMinor) > radius) continue;  // makes the boxes equally dense on the whole surface
    Vector3f edges;
    for (int axis = 0; axis < 3; ++axis) edges[axis] = static_cast<float>(random.uniform(2.0, 10.0));
    const Vector3d at(radius * std::cos(around), radius * std::sin(around), kMinor * std::sin(across));
    layout.addSwaying(edges, 5.f, at, sway);
  }
  return layout;
}

}  // namespace bench
}  // namespace hgrid
