// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests how a distance limit and padding change an answer, for every pair of shape kinds.
#include <gtest/gtest.h>

#include "test/narrow/narrow_phase_judge.h"

namespace hgrid {
namespace test {
namespace {

class EveryPair : public testing::TestWithParam<KindPair> {
 protected:
  static int poses() { return countFromEnvironment("HGRID_TEST_POSES", 100000) / 400; }
};

INSTANTIATE_TEST_SUITE_P(NarrowPhase, EveryPair, testing::ValuesIn(allKindPairs()),
                         [](const auto& info) { return nameOf(info.param); });

TEST_P(EveryPair, LimitOnlyTurnsFartherAnswersIntoInfiniteOnes) {
  Cases cases(3, GetParam());
  Claim kept("an answer within the limit equals the answer without a limit", 0.0);
  Claim infinite("an answer beyond the limit is apart and infinitely far", 0.0);
  for (int i = 0; i < poses(); ++i) {
    const Case placed = cases.next();
    const Trial trial(placed);
    const Proximity whole = trial.measure();
    for (const double factor : {0.0, 0.5, 0.999, 1.0, 1.001, 2.0}) {
      const double up_to = factor * (whole.distance > 0.0 ? whole.distance : 0.1);
      const Proximity limited = trial.measure(up_to);
      if (whole.distance <= up_to) {
        kept.hold(isSame(limited, whole), placed);
      } else {
        infinite.hold(limited.status == Measure::apart && std::isinf(limited.distance), placed);
      }
      kept.hold(isSameInOtherOrder(placed, limited, trial.measureSwapped(up_to)), placed);
    }
  }
  kept.expectHeld();
  infinite.expectHeld();
}

TEST_P(EveryPair, PaddingTakesAsMuchFromTheDistance) {
  Cases cases(4, GetParam());
  Claim shorter("the distance is shorter by the sum of the paddings", 1e-9);
  Claim contact("a distance of at most the sum of the paddings is contact", 0.0);
  for (int i = 0; i < poses(); ++i) {
    Case placed = cases.next();
    placed.first_padding = placed.second_padding = 0.0;
    const Proximity bare = Trial(placed).measure();
    placed.first_padding = cases.random().logUniform(1e-4, 0.5);
    placed.second_padding = cases.random().chance(0.3) ? 0.0 : cases.random().logUniform(1e-4, 0.5);
    const Proximity padded = Trial(placed).measure();
    const double rest = bare.distance - placed.first_padding - placed.second_padding;
    if (isContact(bare.status) || rest < -1e-9) {
      contact.hold(isContact(padded.status), placed);
    } else if (rest > 1e-9) {
      shorter.hold(std::abs(padded.distance - rest), placed);
    }
  }
  contact.expectHeld();
  shorter.expectHeld();
}

}  // namespace
}  // namespace test
}  // namespace hgrid
