// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "test/support/grids.h"

namespace hgrid {
namespace {

TEST(HGridUse, ThreadsAndInstructionSetsThatThereAreNotAreRefused) {
  HGrid grid;
  for (const int threads : {0, -1, 65}) EXPECT_THROW(grid.setThreads(threads), std::invalid_argument) << threads;
  for (const Isa isa : {Isa::portable, Isa::sse2, Isa::avx2, Isa::avx512, Isa::neon}) {
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
  EXPECT_LE(grid.edge(0), 0.4) << "the finest level must not be much larger than the smallest box";
  EXPECT_NO_THROW(HGrid(GridScale::fitting({{{0, 0, 0}, {0, 0, 0}}})));
  EXPECT_NO_THROW(HGrid(GridScale::fitting({{{-3e38f, 0, 0}, {3e38f, 0, 0}}})));
  EXPECT_NO_THROW(HGrid(GridScale::fitting({{{0, 0, 0}, {1e-44f, 0, 0}}})));
}

}  // namespace
}  // namespace hgrid
