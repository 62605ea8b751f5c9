// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "test/support/worlds.h"

namespace hgrid {
namespace test {

/// Returns a world whose boxes are spread so unevenly that the grid divides space into regions. For kind 0, it
/// uses one row of cells instead. @param kind  0 .. 4
inline std::vector<Aabb> unevenWorld(int kind, std::size_t count, Random& random) {
  std::vector<Aabb> boxes;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d size = randomVector(random, 0.3, 1.2), direction = randomVector(random, -1, 1).normalized();
    switch (kind) {
      case 0:  // a row of boxes along the diagonal
        place = 0.3 * double(i) * Eigen::Vector3d::Ones();
        break;
      case 1:  // a random path with steps of all lengths
        place += 0.5 * random.logUniform(1.0, 1000.0) * (random.chance(0.05) ? 1.0 : 0.01) * direction;
        break;
      case 2:  // boxes are denser near the center
        place = random.logUniform(1e-2, 1e4) * direction;
        size *= 0.02 * place.norm() + 1e-3;
        break;
      case 3:  // heaps of boxes, single boxes far away, and huge boxes that extend over several heaps
        place = i % 50 == 0 ? randomVector(random, -1e5, 1e5) : 1e3 * double(i % 7) * Eigen::Vector3d(1, -1, 2);
        place += randomVector(random, -6, 6);
        if (i % 100 == 7) size *= 3e3;
        break;
      default:  // the walls of a building with many floors
        place = {random.uniform(0, 500), double(i % 3) * 100, double(i % 40) * 40};
        break;
    }
    boxes.push_back(boxAround(place, size));
  }
  return boxes;
}

}  // namespace test
}  // namespace hgrid
