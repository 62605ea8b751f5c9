// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <cmath>

#include "bench/workload/layouts.h"

namespace hgrid {
namespace bench {
namespace {

using Eigen::Vector3f;

/// Random edge lengths in low .. high [m]. Their logarithms are uniformly distributed.
struct LogUniform {
  double low, high;

  double edge(Random& random) const { return std::exp(random.uniform(std::log(low), std::log(high))); }
  /// Returns the expected value of edge^power.
  double moment(int power) const {
    return (std::pow(high, power) - std::pow(low, power)) / (power * std::log(high / low));
  }
  /// Returns the side [m] of a cube of space in which each of n cubes has about one overlap.
  double side(double n) const { return std::cbrt(n * (2.0 * moment(3) + 6.0 * moment(1) * moment(2)) / 2.0); }
};

const Region& addCube(Layout& layout, double side) {
  layout.side = side;
  return layout.addRegion(Vector3f::Zero(), Vector3f::Constant(static_cast<float>(side)));
}

Layout logUniformLayout(std::size_t n, const LogUniform& edges) {
  Layout layout;
  const Region& region = addCube(layout, edges.side(double(n)));
  Random random(1);
  for (std::size_t i = 0; i < n; ++i) {
    const double edge = edges.edge(random);
    layout.addCube(edge, randomPoint(random, region), region);
  }
  return layout;
}

}  // namespace

Layout uniformLayout(std::size_t n) {
  Layout layout;
  const Region& region = addCube(layout, usualSide(double(n)));
  Random random(1);
  for (std::size_t i = 0; i < n; ++i) {
    const double edge = usualEdge(random);
    layout.addCube(edge, randomPoint(random, region), region);
  }
  return layout;
}

Layout mixedLayout(std::size_t n) { return logUniformLayout(n, {0.01, 10.0}); }

Layout sizesLayout(std::size_t n) { return logUniformLayout(n, {1e-3, 1e3}); }

Layout floorLayout(std::size_t n) {
  Layout layout;
  layout.side = std::sqrt(2.0 * double(n));
  const auto side = static_cast<float>(layout.side);
  const Region& ground = layout.addRegion(Vector3f::Zero(), {side, side, 0.1f});
  const Region& air = layout.addRegion(Vector3f::Zero(), {side, side, 20.f});
  Random random(1);
  for (std::size_t i = 0; i < n; ++i) {
    const Region& region = random.below(10) == 0 ? air : ground;
    const double edge = usualEdge(random);
    layout.addCube(edge, randomPoint(random, region), region);
  }
  return layout;
}

Layout towerLayout(std::size_t n) {
  constexpr std::size_t kFloors = 25;
  Layout layout;
  layout.side = std::sqrt(2.0 * double(n) / double(kFloors));
  const auto side = static_cast<float>(layout.side);
  for (std::size_t i = 0; i < kFloors; ++i) {
    const float height = 4.f * static_cast<float>(i);
    layout.addRegion({0.f, 0.f, height}, {side, side, height + 0.1f});
    layout.addRegion({0.f, 0.f, height}, {side, side, height + 3.f});
  }
  Random random(1);
  for (std::size_t i = 0; i < n; ++i) {
    const Region& region = layout.regions[2 * random.below(kFloors) + (random.below(10) == 0 ? 1 : 0)];
    const double edge = usualEdge(random);
    layout.addCube(edge, randomPoint(random, region), region);
  }
  return layout;
}

Layout giantsLayout(std::size_t n) {
  Layout layout;
  const Region& region = addCube(layout, usualSide(double(n)));
  Random random(1);
  for (std::size_t i = 0; i < n; ++i) {
    if (i % 1000 != 0) {
      const double edge = usualEdge(random);
      layout.addCube(edge, randomPoint(random, region), region);
      continue;
    }
    Vector3f edges;
    for (int axis = 0; axis < 3; ++axis) edges[axis] = static_cast<float>(layout.side * random.uniform(0.02, 0.1));
    layout.addBox(edges, 1.f, randomPoint(random, region), region);
  }
  return layout;
}

}  // namespace bench
}  // namespace hgrid
