// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <cmath>
#include <functional>

#include "bench/workload/layouts.h"

namespace hgrid {
namespace bench {
namespace {

using Eigen::Vector3f;

/// Adds robots with n boxes in total. @param hall  function that returns the region in which the base of robot i may
/// move
void addRobots(Layout& layout, std::size_t n, const std::function<const Region&(std::size_t)>& hall) {
  const Region& sway = layout.addRegion(Vector3f::Constant(-0.05f), Vector3f::Constant(0.05f));
  Random random(1);
  Vector3f rest = Vector3f::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    if (i % Layout::kLinks == 0) {
      const Region& region = hall(i / Layout::kLinks);
      layout.bases.emplace_back(n + i, randomPoint(random, region), 0.15f, region);
      rest.setZero();
    } else {
      Vector3f direction;
      for (int axis = 0; axis < 3; ++axis) direction[axis] = static_cast<float>(random.uniform(-1.0, 1.0));
      direction.z() += 0.5f;  // chains grow upward more often than downward
      rest += static_cast<float>(random.uniform(0.10, 0.14)) * direction.normalized();
    }
    layout.rests.push_back(rest);
    Vector3f half;
    for (int axis = 0; axis < 3; ++axis) half[axis] = static_cast<float>(random.uniform(0.05, 0.10));
    layout.addBox(2.f * half, 0.15f, Vector3f::Zero(), sway);
  }
}

}  // namespace

Layout robotsLayout(std::size_t n) {
  Layout layout;
  layout.side = 1.5 * std::sqrt(double(n) / double(Layout::kLinks));
  const auto side = static_cast<float>(layout.side);
  const Region& square = layout.addRegion(Vector3f::Zero(), {side, side, 0.f});
  addRobots(layout, n, [&](std::size_t) -> const Region& { return square; });
  return layout;
}

Layout fleetLayout(std::size_t n) {
  constexpr std::size_t kRobots = 50, kFloors = 16;              // robots per hall; number of floors
  constexpr float kLength = 40.f, kWidth = 25.f, kStorey = 4.f;  // [m]
  Layout layout;
  layout.side = 5000.0;
  const std::size_t halls = n / (kRobots * Layout::kLinks) + 1;
  Random random(4);
  for (std::size_t i = 0; i < halls; ++i) {
    const auto x = static_cast<float>(random.uniform(0.0, layout.side - double(kLength)));
    const auto y = static_cast<float>(random.uniform(0.0, layout.side - double(kWidth)));
    const float z = kStorey * static_cast<float>(random.below(kFloors));
    layout.addRegion({x, y, z}, {x + kLength, y + kWidth, z});
  }
  addRobots(layout, n, [&](std::size_t robot) -> const Region& { return layout.regions[robot / kRobots]; });
  return layout;
}

}  // namespace bench
}  // namespace hgrid
