// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/exactness/exactness_pairs.h"

#include "test/narrow/aimed_cases.h"

namespace hgrid {
namespace bench {

std::vector<test::Case> ExactnessWorld::pairs(std::size_t count) const {
  test::AimedShapes shapes;
  shapes.padded = false;  // not every library can grow shapes
  shapes.thinnest_side = thin ? 1e-4 : 0.1;
  shapes.flattest_hull = thin ? 1e-4 : 0.1;
  test::AimedCases cases(11, size, shapes);
  std::vector<test::Case> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    pairs.push_back(cases.next());
    if (i % 2 == 0) continue;
    test::Case& placed = pairs.back();
    placed.world_from_first.linear() = test::randomPose(cases.random(), 1.0).linear();
    placed.world_from_second = test::randomPose(cases.random(), size);
  }
  return pairs;
}

std::vector<ExactnessWorld> exactnessWorlds() {
  std::vector<ExactnessWorld> worlds;
  for (const bool thin : {false, true}) {
    for (const double size : {0.01, 1.0, 10.0, 100.0, 1000.0}) worlds.push_back({thin, size});
  }
  return worlds;
}

}  // namespace bench
}  // namespace hgrid
