// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>
#include <cmath>

#include "bench/workload/layouts.h"

namespace hgrid {
namespace bench {

using Eigen::Vector3f;

Layout rodsLayout(std::size_t n) {
  // Two rods overlap if on each axis their centers are at most half the sum of their edges apart. On average, the
  // centers that overlap a given rod fill 17.5 m^3: 1.25 m^3 for parallel rods, 25.6 m^3 for others.
  Layout layout;
  layout.side = std::cbrt(0.5 * 17.5 * double(n));
  const Region& region = layout.addRegion(Vector3f::Zero(), Vector3f::Constant(static_cast<float>(layout.side)));
  Random random(1);
  for (std::size_t i = 0; i < n; ++i) {
    Vector3f edges;
    for (int axis = 0; axis < 3; ++axis) edges[axis] = static_cast<float>(random.uniform(0.05, 0.20));
    const auto along = static_cast<int>(random.below(3));
    edges[along] = static_cast<float>(random.uniform(5.0, 15.0));
    layout.addBox(edges, 1.f, randomPoint(random, region), region);
  }
  return layout;
}

Layout oneCellLayout(std::size_t n) {
  // One cube contains plates of 1 m x 1 m. A second cube beside it contains needles of 1 m along a random axis. The
  // thickness is chosen for about four overlaps per box. It is at most 0.05 m; if this limit applies, there are fewer.
  constexpr double kSide = 4.0, kOverlaps = 4.0;
  const double volume = std::pow(kSide, 3), half = 0.5 * double(n);
  const double plate = std::min(0.05, kOverlaps * volume / (4.0 * half));
  const double needle = std::min(0.05, kOverlaps * volume * 1.5 / half);
  Layout layout;
  layout.side = 2.0 * kSide + 1.5;
  const auto side = static_cast<float>(kSide), beside = static_cast<float>(kSide + 1.5);
  const Region& plates = layout.addRegion(Vector3f::Zero(), Vector3f::Constant(side));
  const Region& needles = layout.addRegion({beside, 0.f, 0.f}, {beside + side, side, side});
  Random random(1);
  for (std::size_t i = 0; i < n; ++i) {
    if (random.below(2) == 0) {
      const Vector3f edges(1.f, 1.f, static_cast<float>(plate * random.uniform(0.5, 1.5)));
      layout.addBox(edges, 0.1f, randomPoint(random, plates), plates);
    } else {
      Vector3f edges = Vector3f::Constant(static_cast<float>(needle * random.uniform(0.5, 1.5)));
      edges[static_cast<int>(random.below(3))] = 1.f;
      layout.addBox(edges, 0.1f, randomPoint(random, needles), needles);
    }
  }
  return layout;
}

}  // namespace bench
}  // namespace hgrid
