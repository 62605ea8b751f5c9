// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Every kind of shape against every other, in random poses, held against a witness of our own. HGRID_TEST_POSES says
// how many poses in all; pairs with a mesh get half as many as the others.
#include <gtest/gtest.h>

#include <cstdio>

#include "test/narrow/narrow_phase_judge.h"

namespace hgrid {
namespace test {
namespace {

class EveryPairOfKinds : public testing::TestWithParam<KindPair> {
 protected:
  /// 21 pairs without a mesh, 7 with one.
  static int poses(const KindPair& kinds) {
    const int all = countFromEnvironment("HGRID_TEST_POSES", 100000);
    return kinds.second == ShapeKind::mesh ? all / 49 + 1 : 2 * all / 49 + 1;
  }
  void show(const Judge& judge) const { std::printf("%18s %s\n", nameOf(GetParam()).c_str(), judge.figures().c_str()); }
};

INSTANTIATE_TEST_SUITE_P(NarrowPhase, EveryPairOfKinds, testing::ValuesIn(allKindPairs()),
                         [](const auto& info) { return nameOf(info.param); });

TEST_P(EveryPairOfKinds, IsMeasuredAsTheWitnessMeasuresIt) {
  Cases cases(1, GetParam());
  Judge judge;
  for (int i = 0; i < poses(GetParam()); ++i) judge.look(cases.next());
  show(judge);
  judge.expectAllHeld();
}

// Coordinates of 1e5 m have a rounding of 1.5e-11 m: nothing that shows.
TEST_P(EveryPairOfKinds, IsMeasuredAsWellFarFromTheOrigin) {
  Cases cases(2, GetParam());
  Judge judge;
  for (int i = 0; i < poses(GetParam()) / 20; ++i) judge.look(cases.next(1e5));
  judge.expectAllHeld();
}

}  // namespace
}  // namespace test
}  // namespace hgrid
