// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Measures every pair of shape kinds in random poses, and compares the answers with the project's distance oracle.
// The environment variable HGRID_TEST_POSES sets the total number of poses. Pairs with a mesh get half as many poses
// as the other pairs.
#include <gtest/gtest.h>

#include <cstdio>

#include "test/narrow/narrow_phase_judge.h"

namespace hgrid {
namespace test {
namespace {

class EveryPairOfKinds : public testing::TestWithParam<KindPair> {
 protected:
  /// Returns the number of poses for a pair of kinds. There are 21 pairs without a mesh and 7 pairs with a mesh.
  static int poses(const KindPair& kinds) {
    const int all = countFromEnvironment("HGRID_TEST_POSES", 100000);
    return kinds.second == ShapeKind::mesh ? all / 49 + 1 : 2 * all / 49 + 1;
  }
  void show(const Judge& judge) const { std::printf("%18s %s\n", nameOf(GetParam()).c_str(), judge.figures().c_str()); }
};

INSTANTIATE_TEST_SUITE_P(NarrowPhase, EveryPairOfKinds, testing::ValuesIn(allKindPairs()),
                         [](const auto& info) { return nameOf(info.param); });

TEST_P(EveryPairOfKinds, IsMeasuredAsTheOracleMeasuresIt) {
  Cases cases(1, GetParam());
  Judge judge;
  for (int i = 0; i < poses(GetParam()); ++i) judge.look(cases.next());
  show(judge);
  judge.expectAllHeld();
}

// At 1e5 m from the origin, coordinates are rounded by 1.5e-11 m. This is much less than the allowed error.
TEST_P(EveryPairOfKinds, IsMeasuredAsWellFarFromTheOrigin) {
  Cases cases(2, GetParam());
  Judge judge;
  for (int i = 0; i < poses(GetParam()) / 20; ++i) judge.look(cases.next(1e5));
  judge.expectAllHeld();
}

}  // namespace
}  // namespace test
}  // namespace hgrid
