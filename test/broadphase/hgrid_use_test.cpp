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
  EXPECT_EQ(grid.occupiedLevels(), 0u);
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
  EXPECT_EQ(grid.occupiedLevels(), 0u);
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

TEST(HGridUse, LevelsCountsAndMaskAgree) {
  for (unsigned seed = 1; seed <= 110; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::Random random(seed);
    const std::vector<Aabb> boxes = test::worldOf(static_cast<test::Family>(seed % test::kFamilies), seed);
    const HGrid grid = test::gridOf(boxes, test::scaleFor(boxes, random));
    std::vector<std::size_t> counts(GridScale::kLevels + 1, 0);
    for (const Aabb& box : boxes) {
      const int level = grid.levelFor(box);
      ++counts.at(std::size_t(level));
      if (level == GridScale::kLevels) continue;
      // The promise of the level: it fits, and hardly any finer one would do.
      const double side = (box.max.cast<double>() - box.min.cast<double>()).maxCoeff();
      ASSERT_LE(side, grid.edge(level));
    }
    std::size_t sum = 0;
    for (int level = 0; level <= GridScale::kLevels; ++level) {
      ASSERT_EQ(grid.count(level), counts[std::size_t(level)]) << "level " << level;
      sum += grid.count(level);
      if (level < GridScale::kLevels) {
        ASSERT_EQ(grid.occupiedLevels() >> level & 1u, counts[std::size_t(level)] > 0 ? 1u : 0u);
      }
    }
    ASSERT_EQ(sum, grid.size());
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
