// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "test/broadphase/broad_phase_suite.h"
#include "test/support/expectations.h"

namespace hgrid {
namespace {

using test::foundBy;

const Aabb kUnit = {{0, 0, 0}, {1, 1, 1}};

std::vector<Aabb> invalidBoxes() {
  std::vector<Aabb> boxes;
  for (int k = 0; k < 3; ++k) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 2.f}) {
      boxes.push_back(kUnit);
      boxes.back().min[k] = bad;
    }
    boxes.push_back(kUnit);
    boxes.back().max[k] = -std::numeric_limits<float>::infinity();
  }
  return boxes;
}

template <class Tested>
class BroadPhaseUse : public ::testing::Test {};
TYPED_TEST_SUITE(BroadPhaseUse, test::AllBroadPhases, test::BroadPhaseNames);

TYPED_TEST(BroadPhaseUse, FindsNothingWhileEmpty) {
  const TypeParam tested;
  EXPECT_EQ(tested.size(), 0u);
  EXPECT_TRUE(test::pairsOf(tested).empty());
  EXPECT_TRUE(foundBy(tested, kUnit).empty());
  EXPECT_TRUE(foundBy(tested, Sphere{{0, 0, 0}, 1e6}).empty());
  EXPECT_TRUE(test::alongOf(tested, Segment{{-1, 0, 0}, {1, 0, 0}, 1}).empty());
  EXPECT_NO_THROW(tested.checkInvariants());
}

TYPED_TEST(BroadPhaseUse, WrongUseThrowsAndChangesNothing) {
  TypeParam tested;
  tested.insert(2, kUnit);
  tested.insert(5, {{0.5f, 0, 0}, {9, 1, 1}});
  const auto expectUnchanged = [&] {
    EXPECT_EQ(tested.size(), 2u);
    EXPECT_EQ(test::pairsOf(tested), test::Pairs({{2, 5}}));
    EXPECT_EQ(foundBy(tested, Aabb{{8, 0, 0}, {9, 0, 0}}), std::vector<ProxyId>({5}));
    EXPECT_NO_THROW(tested.checkInvariants());
  };
  EXPECT_THROW(tested.insert(2, kUnit), std::invalid_argument);
  EXPECT_THROW(tested.insert(2, {{7, 7, 7}, {8, 8, 8}}), std::invalid_argument);
  expectUnchanged();
  for (const ProxyId unknown : {0u, 3u, 6u, 1000000u, 0xffffffffu}) {
    EXPECT_THROW(tested.update(unknown, kUnit), std::invalid_argument);
    EXPECT_THROW(tested.remove(unknown), std::invalid_argument);
  }
  expectUnchanged();
  for (const Aabb& bad : invalidBoxes()) {
    EXPECT_THROW(tested.insert(7, bad), std::invalid_argument);
    EXPECT_THROW(tested.update(2, bad), std::invalid_argument);
    EXPECT_THROW(tested.update({1, 2}, {kUnit, bad}), std::invalid_argument);
  }
  expectUnchanged();
  EXPECT_THROW(tested.update({1, 2}, {kUnit}), std::invalid_argument);
  EXPECT_THROW(tested.update({1}, {kUnit, kUnit}), std::invalid_argument);
  EXPECT_THROW(tested.update({2, 1}, {kUnit, kUnit}), std::invalid_argument);
  EXPECT_THROW(tested.update({1, 1}, {kUnit, kUnit}), std::invalid_argument);
  expectUnchanged();
}

TYPED_TEST(BroadPhaseUse, ARemovedBoxIsUnknownAndItsNumberFree) {
  TypeParam tested;
  tested.insert(4, kUnit);
  tested.remove(4);
  EXPECT_EQ(tested.size(), 0u);
  EXPECT_THROW(tested.remove(4), std::invalid_argument);
  tested.insert(4, kUnit);
  tested.clear();
  EXPECT_THROW(tested.update(4, kUnit), std::invalid_argument);
  tested.insert(4, kUnit);
  EXPECT_EQ(foundBy(tested, kUnit), std::vector<ProxyId>({4}));
  tested.update(std::vector<ProxyId>{}, std::vector<Aabb>{});
  EXPECT_EQ(tested.size(), 0u);
  tested.checkInvariants();
}

TYPED_TEST(BroadPhaseUse, ABulkMoveOfWhatIsNotStoredThrowsAndChangesNothing) {
  TypeParam tested;
  tested.update({1, 4}, {kUnit, kUnit});
  const Aabb away = {{7, 7, 7}, {8, 8, 8}};
  EXPECT_THROW(tested.move({1, 2}, {away, away}), std::invalid_argument);
  EXPECT_THROW(tested.move({4, 1}, {away, away}), std::invalid_argument);
  EXPECT_THROW(tested.move({1}, {away, away}), std::invalid_argument);
  EXPECT_THROW(tested.move({1, 4}, {away, invalidBoxes()[0]}), std::invalid_argument);
  EXPECT_EQ(test::pairsOf(tested), test::Pairs({{1, 4}}));
  tested.move({}, {});
  tested.move({4}, {away});
  EXPECT_TRUE(test::pairsOf(tested).empty());
  EXPECT_EQ(foundBy(tested, away), std::vector<ProxyId>({4}));
}

TYPED_TEST(BroadPhaseUse, FixedBoxesPairWithOthersOnly) {
  for (unsigned seed = 1; seed <= 55; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::Random random(seed);
    const std::vector<Aabb> boxes = test::worldOf(static_cast<test::Family>(seed % test::kFamilies), seed);
    const std::unique_ptr<BroadPhase> made = test::Maker<TypeParam>::withAny(boxes, random);
    BroadPhase& tested = *made;
    tested.update(test::allIds(boxes.size()), boxes);
    std::vector<ProxyId> fixed, moving;
    std::vector<bool> is_fixed(boxes.size());
    for (ProxyId id = 0; id < boxes.size(); ++id) {
      is_fixed[id] = random.chance(0.5);
      if (is_fixed[id]) fixed.push_back(id);
      if (!is_fixed[id] && random.chance(0.2)) moving.push_back(id);
    }
    tested.setFixed(fixed);
    const auto expectRight = [&](const std::vector<Aabb>& now) {
      test::Pairs expected;
      for (const auto& pair : test::allOverlaps(now)) {
        if (!is_fixed[pair.first] || !is_fixed[pair.second]) expected.push_back(pair);
      }
      ASSERT_EQ(test::pairsOf(tested), expected);
      ASSERT_NO_THROW(tested.checkInvariants());
      if (!now.empty()) {
        ASSERT_FALSE(foundBy(tested, now[0]).empty()) << "queries must find fixed boxes too";
      }
    };
    ASSERT_NO_FATAL_FAILURE(expectRight(boxes));
    std::vector<Aabb> now = boxes;
    for (int frame = 0; frame < 3; ++frame) {
      std::vector<Aabb> moved;
      for (const ProxyId id : moving) {
        now[id] = boxes[std::size_t(random.below(int(boxes.size())))];
        moved.push_back(now[id]);
      }
      tested.move(moving, moved);
      ASSERT_NO_FATAL_FAILURE(expectRight(now));
    }
    if (!fixed.empty()) {  // the caller may move a fixed box
      now[fixed[0]] = boxes[0];
      tested.move({fixed[0]}, {now[fixed[0]]});
      ASSERT_NO_FATAL_FAILURE(expectRight(now));
    }
  }
}

}  // namespace
}  // namespace hgrid
