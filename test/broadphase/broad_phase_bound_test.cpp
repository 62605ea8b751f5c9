// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include "test/broadphase/bound_tasks.h"
#include "test/broadphase/broad_phase_suite.h"

namespace hgrid {
namespace {

using test::allIds;
using test::boundedPairsOf;
using test::Divisible;
using test::Found;
using test::Random;
using test::Task;

/// Whether to run fewer cases. HGRID_TEST_WORLDS asks for this with a sanitizer, which makes everything slow.
const bool kTakesItsTime = test::worldsToTest() < 10000;

template <class Tested>
class BroadPhaseBound : public ::testing::Test {};
TYPED_TEST_SUITE(BroadPhaseBound, test::AllBroadPhases, test::BroadPhaseNames);

/// Claim: a search with a bound finds the pairs that the comment of PairBound promises. This holds for any boxes,
/// bounds, settings and earlier calls.
TYPED_TEST(BroadPhaseBound, FindsWhatTheRuleSays) {
  int cut = 0, whole = 0;
  const unsigned seeds = kTakesItsTime ? 60 : 220;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Task task = randomTask(seed, random);
    const Found expected = ruleOf(task);
    (expected.all ? whole : cut) += 1;
    Divisible divisible;
    divisible.divisor = task.divisor;
    for (int round = 0; round < 5; ++round) {
      const std::unique_ptr<BroadPhase> made = test::Maker<TypeParam>::withAny(task.boxes, random);
      BroadPhase& tested = *made;
      setUp(tested, task, divisible);
      bringTo(tested, task, random);
      const Found found = boundedPairsOf(tested);
      ASSERT_EQ(found.all, expected.all) << "round " << round;
      ASSERT_TRUE(found == expected) << "round " << round << ", " << found.pairs.size() << " pairs instead of "
                                     << expected.pairs.size();
      ASSERT_TRUE(boundedPairsOf(tested) == expected) << "a second search has a different result";
    }
  }
  EXPECT_GT(cut, 15);
  EXPECT_GT(whole, 15);
}

TYPED_TEST(BroadPhaseBound, ExactlyAsManyPairsAsTheBoundAreAllPairs) {
  const std::vector<Aabb> boxes(40, test::boxAround(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()));
  TypeParam tested;
  tested.update(allIds(boxes.size()), boxes);
  constexpr std::size_t kPairs = 40 * 39 / 2;
  for (const bool by_overlaps : {false, true}) {
    for (const std::size_t bound : {std::size_t{0}, std::size_t{1}, kPairs - 1, kPairs, kPairs + 1}) {
      SCOPED_TRACE(bound);
      tested.setPairBound(by_overlaps ? PairBound{PairBound::kNone, bound} : PairBound{bound, PairBound::kNone});
      const Found found = boundedPairsOf(tested);
      EXPECT_EQ(found.pairs.size(), std::min(bound, kPairs));
      EXPECT_EQ(found.all, bound >= kPairs);
    }
  }
}

TYPED_TEST(BroadPhaseBound, DoesNotApplyToTheSearchForAllPairs) {
  const std::vector<Aabb> boxes(40, test::boxAround(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()));
  TypeParam tested;
  tested.update(allIds(boxes.size()), boxes);
  tested.setPairBound({3, 3});
  EXPECT_EQ(test::pairsOf(tested).size(), 40u * 39u / 2u);
}

/// Claim: pairs of two fixed boxes are not counted by the bound.
TYPED_TEST(BroadPhaseBound, FixedPilesAreNotCut) {
  const std::size_t count = kTakesItsTime ? 2000 : 20000;  // some broad phases compare all of them with each other
  const std::vector<Aabb> boxes(count, test::boxAround(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()));
  std::vector<ProxyId> fixed = allIds(boxes.size());
  fixed.pop_back();
  TypeParam tested;
  tested.setFixed(fixed);
  tested.setPairBound({count, count});
  tested.update(allIds(boxes.size()), boxes);
  const Found found = boundedPairsOf(tested);
  EXPECT_TRUE(found.all);
  EXPECT_EQ(found.pairs.size(), count - 1);
}

/// Claim: when the pile of boxes is gone, the search finds all pairs again. It counts only boxes that overlap now.
TYPED_TEST(BroadPhaseBound, EndsWithThePile) {
  std::vector<Aabb> boxes, pile;
  for (int i = 0; i < 1000; ++i) {
    boxes.push_back(test::boxAround(Eigen::Vector3d(2.0 * i, 0, 0), Eigen::Vector3d::Constant(0.6)));
    pile.push_back(i % 10 == 0 ? test::boxAround(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(0.6))
                               : boxes.back());
  }
  TypeParam tested;
  tested.setPairBound({100, 1000});
  for (int tick = 0; tick < 6; ++tick) {
    const bool piled = tick % 2 == 0;
    tested.update(allIds(boxes.size()), piled ? pile : boxes);
    EXPECT_EQ(boundedPairsOf(tested).all, !piled) << "tick " << tick;
  }
}

}  // namespace
}  // namespace hgrid
