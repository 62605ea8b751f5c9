// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "test/support/grids.h"

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

TEST(HGridUse, AnEmptyGridFindsNothing) {
  const HGrid grid;
  EXPECT_EQ(grid.size(), 0u);
  EXPECT_TRUE(test::pairsOf(grid).empty());
  EXPECT_TRUE(foundBy(grid, kUnit).empty());
  EXPECT_TRUE(foundBy(grid, Sphere{{0, 0, 0}, 1e6}).empty());
  EXPECT_TRUE(test::alongOf(grid, Segment{{-1, 0, 0}, {1, 0, 0}, 1}).empty());
  EXPECT_NO_THROW(grid.checkInvariants());
}

TEST(HGridUse, WrongUseThrowsAndChangesNothing) {
  HGrid grid;
  grid.insert(2, kUnit);
  grid.insert(5, {{0.5f, 0, 0}, {9, 1, 1}});
  const auto expectUnchanged = [&] {
    EXPECT_EQ(grid.size(), 2u);
    EXPECT_EQ(test::pairsOf(grid), test::Pairs({{2, 5}}));
    EXPECT_EQ(foundBy(grid, Aabb{{8, 0, 0}, {9, 0, 0}}), std::vector<ProxyId>({5}));
    EXPECT_NO_THROW(grid.checkInvariants());
  };
  EXPECT_THROW(grid.insert(2, kUnit), std::invalid_argument);
  EXPECT_THROW(grid.insert(2, {{7, 7, 7}, {8, 8, 8}}), std::invalid_argument);
  expectUnchanged();
  for (const ProxyId unknown : {0u, 3u, 6u, 1000000u, 0xffffffffu}) {
    EXPECT_THROW(grid.update(unknown, kUnit), std::invalid_argument);
    EXPECT_THROW(grid.remove(unknown), std::invalid_argument);
  }
  expectUnchanged();
  for (const Aabb& bad : invalidBoxes()) {
    EXPECT_THROW(grid.insert(7, bad), std::invalid_argument);
    EXPECT_THROW(grid.update(2, bad), std::invalid_argument);
    EXPECT_THROW(grid.update({1, 2}, {kUnit, bad}), std::invalid_argument);
  }
  expectUnchanged();
  EXPECT_THROW(grid.update({1, 2}, {kUnit}), std::invalid_argument);
  EXPECT_THROW(grid.update({1}, {kUnit, kUnit}), std::invalid_argument);
  EXPECT_THROW(grid.update({2, 1}, {kUnit, kUnit}), std::invalid_argument);
  EXPECT_THROW(grid.update({1, 1}, {kUnit, kUnit}), std::invalid_argument);
  expectUnchanged();
}

TEST(HGridUse, ARemovedBoxIsUnknownAndItsNumberFree) {
  HGrid grid;
  grid.insert(4, kUnit);
  grid.remove(4);
  EXPECT_EQ(grid.size(), 0u);
  EXPECT_THROW(grid.remove(4), std::invalid_argument);
  grid.insert(4, kUnit);
  grid.clear();
  EXPECT_THROW(grid.update(4, kUnit), std::invalid_argument);
  grid.insert(4, kUnit);
  EXPECT_EQ(foundBy(grid, kUnit), std::vector<ProxyId>({4}));
  grid.update(std::vector<ProxyId>{}, std::vector<Aabb>{});
  EXPECT_EQ(grid.size(), 0u);
  grid.checkInvariants();
}

TEST(HGridUse, ABulkMoveOfWhatIsNotStoredThrowsAndChangesNothing) {
  HGrid grid;
  grid.update({1, 4}, {kUnit, kUnit});
  const Aabb away = {{7, 7, 7}, {8, 8, 8}};
  EXPECT_THROW(grid.move({1, 2}, {away, away}), std::invalid_argument);
  EXPECT_THROW(grid.move({4, 1}, {away, away}), std::invalid_argument);
  EXPECT_THROW(grid.move({1}, {away, away}), std::invalid_argument);
  EXPECT_THROW(grid.move({1, 4}, {away, invalidBoxes()[0]}), std::invalid_argument);
  EXPECT_EQ(test::pairsOf(grid), test::Pairs({{1, 4}}));
  grid.move({}, {});
  grid.move({4}, {away});
  EXPECT_TRUE(test::pairsOf(grid).empty());
  EXPECT_EQ(foundBy(grid, away), std::vector<ProxyId>({4}));
}

TEST(HGridUse, ThreadsAndInstructionSetsThatThereAreNotAreRefused) {
  HGrid grid;
  for (const int threads : {0, -1, 65}) EXPECT_THROW(grid.setThreads(threads), std::invalid_argument) << threads;
  for (const Isa isa : {Isa::portable, Isa::sse2, Isa::avx2, Isa::avx512}) {
    if (isSupported(isa)) {
      grid.setIsa(isa);
      EXPECT_EQ(grid.isa(), isa);
    } else {
      EXPECT_THROW(grid.setIsa(isa), std::invalid_argument) << name(isa);
    }
  }
  EXPECT_TRUE(isSupported(bestIsa()));
  EXPECT_TRUE(isSupported(Isa::portable));
}

TEST(HGridUse, FixedBoxesPairWithOthersOnly) {
  for (unsigned seed = 1; seed <= 55; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::Random random(seed);
    const std::vector<Aabb> boxes = test::worldOf(static_cast<test::Family>(seed % test::kFamilies), seed);
    HGrid grid = test::gridOf(boxes, test::scaleFor(boxes, random));
    std::vector<ProxyId> fixed, moving;
    std::vector<bool> is_fixed(boxes.size());
    for (ProxyId id = 0; id < boxes.size(); ++id) {
      is_fixed[id] = random.chance(0.5);
      if (is_fixed[id]) fixed.push_back(id);
      if (!is_fixed[id] && random.chance(0.2)) moving.push_back(id);
    }
    grid.setFixed(fixed);
    const auto expectRight = [&](const std::vector<Aabb>& now) {
      test::Pairs expected;
      for (const auto& pair : test::allOverlaps(now)) {
        if (!is_fixed[pair.first] || !is_fixed[pair.second]) expected.push_back(pair);
      }
      ASSERT_EQ(test::pairsOf(grid), expected);
      ASSERT_NO_THROW(grid.checkInvariants());
      if (!now.empty()) {
        ASSERT_FALSE(foundBy(grid, now[0]).empty()) << "queries find fixed boxes too";
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
      grid.move(moving, moved);
      ASSERT_NO_FATAL_FAILURE(expectRight(now));
    }
    if (!fixed.empty()) {  // a fixed box may be put elsewhere
      now[fixed[0]] = boxes[0];
      grid.move({fixed[0]}, {now[fixed[0]]});
      ASSERT_NO_FATAL_FAILURE(expectRight(now));
    }
  }
}

TEST(HGridUse, EdgesOutsideThePromisedRangeAreRefused) {
  for (const double bad : {0.0, -1.0, 0x1p-31, 0x1p31, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()}) {
    GridScale scale;
    scale.finest_edge = bad;
    EXPECT_THROW(HGrid{scale}, std::invalid_argument) << bad;
  }
}

TEST(HGridUse, EdgesAreRoundedDownToAPowerOfTwoAndGrowByTheRatio) {
  const std::pair<double, double> cases[] = {{1.0, 1.0},    {1.99, 1.0},        {std::nextafter(2.0, 0.0), 1.0},
                                             {8.0, 8.0},    {0.1, 0.0625},      {std::nextafter(8.0, 0.0), 4.0},
                                             {100.0, 64.0}, {0x1p-30, 0x1p-30}, {0x1p30, 0x1p30}};
  for (const auto& one : cases) {
    GridScale scale;
    scale.finest_edge = one.first;
    const HGrid grid(scale);
    EXPECT_EQ(grid.edge(0), one.second) << one.first;
    for (int level = 1; level < GridScale::kLevels; ++level) {
      EXPECT_EQ(grid.edge(level), grid.edge(level - 1) * GridScale::kRatio);
    }
  }
}

TEST(HGridUse, LevelsHoldBoxesOfTheirSize) {
  for (unsigned seed = 1; seed <= 110; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::Random random(seed);
    const std::vector<Aabb> boxes = test::worldOf(static_cast<test::Family>(seed % test::kFamilies), seed);
    const HGrid grid = test::gridOf(boxes, test::scaleFor(boxes, random));
    std::vector<std::size_t> counts(GridScale::kLevels + 1, 0);
    for (ProxyId id = 0; id < boxes.size(); ++id) {
      const int level = grid.levelFor(boxes[id]);
      ASSERT_EQ(grid.levelOf(id), level);
      ++counts.at(std::size_t(level));
      const float side = (boxes[id].max - boxes[id].min).maxCoeff();
      if (level < GridScale::kLevels) {
        ASSERT_LE(side, grid.edge(level));
      }
      if (level > 0) {
        ASSERT_GT(side, grid.edge(level - 1));
      }
    }
    ASSERT_EQ(test::levelCounts(grid), counts);
    ASSERT_EQ(grid.levelOf(ProxyId(boxes.size())), -1);
  }
}

TEST(HGridUse, AFittingScaleSuitsTheSmallestBox) {
  EXPECT_EQ(HGrid(GridScale::fitting({})).edge(0), 1.0);
  std::vector<Aabb> boxes = {{{0, 0, 0}, {4, 4, 4}}, {{0, 0, 0}, {0.1f, 0.05f, 0.02f}}};
  const HGrid grid(GridScale::fitting(boxes));
  EXPECT_EQ(grid.levelFor(boxes[1]), 0);
  EXPECT_LE(grid.edge(0), 0.4) << "not much larger than the smallest box";
  EXPECT_NO_THROW(HGrid(GridScale::fitting({{{0, 0, 0}, {0, 0, 0}}})));
  EXPECT_NO_THROW(HGrid(GridScale::fitting({{{-3e38f, 0, 0}, {3e38f, 0, 0}}})));
  EXPECT_NO_THROW(HGrid(GridScale::fitting({{{0, 0, 0}, {1e-44f, 0, 0}}})));
}

}  // namespace
}  // namespace hgrid
