// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <limits>

#include "test/support/grids.h"

namespace hgrid {
namespace {

using test::foundBy;
using test::stepped;

GridScale finest(double edge) {
  GridScale scale;
  scale.finest_edge = edge;
  return scale;
}

/// Boxes on the level of `box` that touch neither it nor `other`: a level with few boxes has few cells.
void insertFillers(HGrid& grid, const Aabb& box, const Aabb& other) {
  const int level = grid.levelFor(box);
  if (level == GridScale::kLevels) return;
  const auto edge = float(grid.edge(level));
  for (int i = 0; i < 100; ++i) {
    const float x = (box.min.x() < 0 ? 1000.f + 4.f * float(i) : -1000.f - 4.f * float(i)) * edge;
    const Aabb filler = {{x, 0, 0}, {x + 0.5f * edge, 0, 0}};
    if (test::oracleOverlap(filler, box) || test::oracleOverlap(filler, other)) continue;
    grid.insert(ProxyId(grid.size() + 2), filler);
  }
}

/// The pair must be found from both sides, by box and as a pair.
void expectMeet(const Aabb& a, const Aabb& b, double edge) {
  ASSERT_TRUE(test::oracleOverlap(a, b));
  for (const bool swapped : {false, true}) {
    HGrid grid(finest(edge));
    insertFillers(grid, a, b);
    if (grid.levelFor(a) != grid.levelFor(b)) insertFillers(grid, b, a);
    grid.insert(swapped ? 1 : 0, a);
    grid.insert(swapped ? 0 : 1, b);
    EXPECT_EQ(test::pairsOf(grid), test::Pairs({{0, 1}}));
    EXPECT_EQ(foundBy(grid, a).size(), 2u);
    EXPECT_EQ(foundBy(grid, b).size(), 2u);
    grid.checkInvariants();
  }
}

TEST(HGridEdges, ABoxOnTheBordersOfCellsIsFoundFromBothSides) {
  const float edge = 0.25f;
  for (int axes = 1; axes < 8; ++axes) {
    for (const float border : {0.f, -0.f, edge, -edge, 7 * edge, -7 * edge, -1000 * edge}) {
      Aabb at, above, below;  // `at` ends on the border of a cell on one, two or three axes
      for (int k = 0; k < 3; ++k) {
        const bool on = axes >> k & 1;
        at.min[k] = on ? border - 0.1f : 0.3f, at.max[k] = on ? border : 0.4f;
        above.min[k] = on ? border : 0.3f, above.max[k] = on ? border + 0.1f : 0.4f;
        below.min[k] = on ? stepped(border, -1) : 0.3f, below.max[k] = above.max[k];
      }
      SCOPED_TRACE("axes " + std::to_string(axes) + ", border " + std::to_string(border));
      expectMeet(at, above, edge);
      expectMeet(at, below, edge);
      Aabb apart = above;
      for (int k = 0; k < 3; ++k) {
        if (axes >> k & 1) apart.min[k] = stepped(border, 1);
      }
      HGrid grid(finest(edge));
      grid.insert(0, at);
      grid.insert(1, apart);
      EXPECT_TRUE(test::pairsOf(grid).empty());
    }
  }
}

TEST(HGridEdges, BoxesThatStraddleZeroByVeryLittleAreFound) {
  const float tiny = std::numeric_limits<float>::denorm_min();
  for (const float little : {1e-3f, 1e-7f, 1e-30f, tiny}) {
    const Aabb around = {{-little, -little, -little}, {little, little, little}};
    for (const double edge : {1.0, 0x1p-30, 0x1p30}) {
      SCOPED_TRACE(std::to_string(edge));
      expectMeet(around, {{-1, -1, -1}, {-little, -little, -little}}, edge);
      expectMeet(around, {{little, little, little}, {1, 1, 1}}, edge);
      expectMeet(around, {{0, 0, 0}, {0, 0, 0}}, edge);
    }
  }
}

// Its size rounds to 1 in double too, so that it seems to fit cells of 1 m, but it reaches over three of them.
TEST(HGridEdges, ABoxWhoseSizeIsRoundedToACellReachesNoFartherThanPromised) {
  for (const float sliver : {1e-30f, 1e-20f, std::numeric_limits<float>::denorm_min()}) {
    const Aabb nasty = {{-sliver, -sliver, -sliver}, {1, 1, 1}};
    for (const double edge : {1.0, 0.25, 0.0625}) {
      SCOPED_TRACE(std::to_string(edge));
      expectMeet(nasty, {{1, 1, 1}, {1.01f, 1.01f, 1.01f}}, edge);
      expectMeet(nasty, {{-0.01f, -0.01f, -0.01f}, {-sliver, -sliver, -sliver}}, edge);
      expectMeet(nasty, {{1, 1, 1}, {2, 2, 2}}, edge);
    }
  }
}

TEST(HGridEdges, BoxesTooFarOutForFineCellsAreStillFound) {
  for (const float place : {1e6f, -1e6f, 1e9f, -1e12f, 1e20f, -3e38f, 3e38f}) {
    const Aabb a = {{place, place, place}, {place, place, place}};
    Aabb b = a;
    b.min.x() = stepped(place, -2);
    for (const double edge : {0x1p-30, 1e-3, 1.0, 0x1p30}) {
      SCOPED_TRACE(std::to_string(place) + " in cells of " + std::to_string(edge));
      expectMeet(a, b, edge);
      HGrid grid(finest(edge));
      grid.insert(0, a);
      EXPECT_TRUE(foundBy(grid, Aabb{{0, 0, 0}, {1, 1, 1}}).empty()) << "nothing wraps around to here";
      EXPECT_EQ(foundBy(grid, Sphere{a.min.cast<double>(), 0.0}).size(), 1u);
      EXPECT_EQ(test::alongOf(grid, Segment{a.min.cast<double>(), a.min.cast<double>(), 0.0}).size(), 1u);
    }
  }
}

TEST(HGridEdges, AHugeBoxAmongTinyCellsIsFoundByAll) {
  const Aabb huge = {{-5e3f, -5e3f, -5e3f}, {5e3f, 5e3f, 5e3f}}, small = {{1, 1, 1}, {1.001f, 1.001f, 1.001f}};
  expectMeet(huge, small, 1e-3);
  HGrid grid(finest(1e-3));
  EXPECT_LT(grid.levelFor(huge), GridScale::kLevels) << "10 km fit a level of a grid that begins with 1 mm";
  EXPECT_EQ(grid.levelFor({{-1e9f, 0, 0}, {1e9f, 0, 0}}), GridScale::kLevels);
}

TEST(HGridEdges, BoxesLargerThanEveryLevelPairWithEverythingTheyOverlap) {
  const float far = 3e38f;
  HGrid grid(finest(0x1p-30));  // its coarsest cells have an edge of 1 m
  grid.insert(0, {{-far, -far, -far}, {far, far, far}});
  grid.insert(1, {{0, 0, 0}, {0.5f, 0.5f, 0.5f}});
  grid.insert(2, {{-far, 2, 2}, {far, 3, 3}});
  grid.insert(3, {{1e30f, 0, 0}, {1e30f, 0, 0}});
  grid.insert(4, {{-far, 2.5f, 2.5f}, {0, 9, 9}});
  EXPECT_EQ(grid.levels()[GridScale::kLevels].boxes, 3u);
  EXPECT_EQ(test::pairsOf(grid), test::Pairs({{0, 1}, {0, 2}, {0, 3}, {0, 4}, {2, 4}}));
  EXPECT_EQ(foundBy(grid, Aabb{{0, 0, 0}, {1, 1, 1}}), std::vector<ProxyId>({0, 1}));
  EXPECT_EQ(test::alongOf(grid, Segment{{0, 0, 0}, {0, 5, 5}, 0.0}).size(), 4u);
  grid.remove(2);
  grid.update(0, {{0, 0, 0}, {0.1f, 0.1f, 0.1f}});
  EXPECT_EQ(test::pairsOf(grid), test::Pairs({{0, 1}}));
  grid.checkInvariants();
}

TEST(HGridEdges, QueriesAsLargeAsTheWorldAnswerToo) {
  const std::vector<Aabb> boxes = test::worldOf(test::Family::size_ratio, 3);
  const HGrid grid = test::gridOf(boxes, GridScale::fitting(boxes));
  const float far = std::numeric_limits<float>::max();
  EXPECT_EQ(foundBy(grid, Aabb{{-far, -far, -far}, {far, far, far}}).size(), boxes.size());
  EXPECT_EQ(foundBy(grid, Sphere{{0, 0, 0}, 1e9}).size(), boxes.size());
  EXPECT_EQ(test::alongOf(grid, Segment{{-1e9, 0, 0}, {1e9, 0, 0}, 1e6}).size(), boxes.size());
}

TEST(HGridEdges, SegmentsAmongTheLargestFloatsMissNothing) {
  const std::vector<Aabb> boxes = {{{0, 0, 0}, {2e38f, 2e38f, 2e38f}}, {{1e38f, 0, 0}, {3e38f, 1e38f, 1e38f}}};
  const HGrid grid = test::gridOf(boxes, GridScale{});
  for (const Segment& segment :
       {Segment{{3e38, 1e38, 1e38}, {0, 0.5e38, 0.2e38}, 0.0}, Segment{{2.5e38, 0, 0}, {1.5e38, 1e37, 1e37}, 0.0}}) {
    std::size_t met = 0;
    for (const Aabb& box : boxes) met += meet(segment, box).has_value();
    EXPECT_EQ(test::alongOf(grid, segment).size(), met);
  }
}

}  // namespace
}  // namespace hgrid
