// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <limits>

#include "test/broadphase/broad_phase_suite.h"
#include "test/support/expectations.h"

namespace hgrid {
namespace {

using test::foundBy;
using test::stepped;

/// Inserts boxes of the size of `box` that touch neither `box` nor `other`. Without them, their level would have few
/// boxes, and HGrid would give it few cells.
void insertFillers(BroadPhase& tested, const Aabb& box, const Aabb& other, double edge) {
  const float side = std::max((box.max - box.min).maxCoeff(), float(edge));
  for (int i = 0; i < 100; ++i) {
    const float x = (box.min.x() < 0 ? 1000.f + 4.f * float(i) : -1000.f - 4.f * float(i)) * side;
    const Aabb filler = {{x, 0, 0}, {x + side, 0, 0}};
    if (!isValid(filler) || test::oracleOverlap(filler, box) || test::oracleOverlap(filler, other)) continue;
    tested.insert(ProxyId(tested.size() + 2), filler);
  }
}

/// Checks that two overlapping boxes are found as a pair, and that a query with each of them finds the other one.
template <class Tested>
void expectMeet(const Aabb& a, const Aabb& b, double edge) {
  ASSERT_TRUE(test::oracleOverlap(a, b));
  for (const bool swapped : {false, true}) {
    const std::unique_ptr<BroadPhase> tested = test::Maker<Tested>::withCells(edge);
    insertFillers(*tested, a, b, edge);
    insertFillers(*tested, b, a, edge);
    tested->insert(swapped ? 1 : 0, a);
    tested->insert(swapped ? 0 : 1, b);
    test::Pairs pairs = test::pairsOf(*tested);
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(), [](const auto& pair) { return pair.first > 1; }),
                pairs.end());
    EXPECT_EQ(pairs, test::Pairs({{0, 1}}));
    EXPECT_EQ(foundBy(*tested, a).size(), 2u);
    EXPECT_EQ(foundBy(*tested, b).size(), 2u);
    tested->checkInvariants();
  }
}

template <class Tested>
class BroadPhaseEdges : public ::testing::Test {};
TYPED_TEST_SUITE(BroadPhaseEdges, test::AllBroadPhases, test::BroadPhaseNames);

TYPED_TEST(BroadPhaseEdges, ABoxOnTheBordersOfCellsIsFoundFromBothSides) {
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
      expectMeet<TypeParam>(at, above, edge);
      expectMeet<TypeParam>(at, below, edge);
      Aabb apart = above;
      for (int k = 0; k < 3; ++k) {
        if (axes >> k & 1) apart.min[k] = stepped(border, 1);
      }
      const auto made = test::Maker<TypeParam>::withCells(edge);
      BroadPhase& tested = *made;
      tested.insert(0, at);
      tested.insert(1, apart);
      EXPECT_TRUE(test::pairsOf(tested).empty());
    }
  }
}

TYPED_TEST(BroadPhaseEdges, BoxesThatStraddleZeroByVeryLittleAreFound) {
  const float tiny = std::numeric_limits<float>::denorm_min();
  for (const float little : {1e-3f, 1e-7f, 1e-30f, tiny}) {
    const Aabb around = {{-little, -little, -little}, {little, little, little}};
    for (const double edge : test::Maker<TypeParam>::cells({1.0, 0x1p-30, 0x1p30})) {
      SCOPED_TRACE(std::to_string(edge));
      expectMeet<TypeParam>(around, {{-1, -1, -1}, {-little, -little, -little}}, edge);
      expectMeet<TypeParam>(around, {{little, little, little}, {1, 1, 1}}, edge);
      expectMeet<TypeParam>(around, {{0, 0, 0}, {0, 0, 0}}, edge);
    }
  }
}

// The size of this box is rounded to 1 m, even in double precision. Therefore the box seems to fit into a cell of 1 m,
// but it extends over three such cells.
TYPED_TEST(BroadPhaseEdges, ABoxWhoseSizeIsRoundedToACellReachesNoFartherThanPromised) {
  for (const float sliver : {1e-30f, 1e-20f, std::numeric_limits<float>::denorm_min()}) {
    const Aabb nasty = {{-sliver, -sliver, -sliver}, {1, 1, 1}};
    for (const double edge : test::Maker<TypeParam>::cells({1.0, 0.25, 0.0625})) {
      SCOPED_TRACE(std::to_string(edge));
      expectMeet<TypeParam>(nasty, {{1, 1, 1}, {1.01f, 1.01f, 1.01f}}, edge);
      expectMeet<TypeParam>(nasty, {{-0.01f, -0.01f, -0.01f}, {-sliver, -sliver, -sliver}}, edge);
      expectMeet<TypeParam>(nasty, {{1, 1, 1}, {2, 2, 2}}, edge);
    }
  }
}

TYPED_TEST(BroadPhaseEdges, BoxesTooFarOutForFineCellsAreStillFound) {
  for (const float place : {1e6f, -1e6f, 1e9f, -1e12f, 1e20f, -3e38f, 3e38f}) {
    const Aabb a = {{place, place, place}, {place, place, place}};
    Aabb b = a;
    b.min.x() = stepped(place, -2);
    for (const double edge : test::Maker<TypeParam>::cells({0x1p-30, 1e-3, 1.0, 0x1p30})) {
      SCOPED_TRACE(std::to_string(place) + " in cells of " + std::to_string(edge));
      expectMeet<TypeParam>(a, b, edge);
      const auto made = test::Maker<TypeParam>::withCells(edge);
      BroadPhase& tested = *made;
      tested.insert(0, a);
      EXPECT_TRUE(foundBy(tested, Aabb{{0, 0, 0}, {1, 1, 1}}).empty()) << "a far box must not appear near the origin";
      EXPECT_EQ(foundBy(tested, Sphere{a.min.cast<double>(), 0.0}).size(), 1u);
      EXPECT_EQ(test::alongOf(tested, Segment{a.min.cast<double>(), a.min.cast<double>(), 0.0}).size(), 1u);
    }
  }
}

TYPED_TEST(BroadPhaseEdges, AHugeBoxAmongTinyCellsIsFound) {
  const Aabb huge = {{-5e3f, -5e3f, -5e3f}, {5e3f, 5e3f, 5e3f}}, small = {{1, 1, 1}, {1.001f, 1.001f, 1.001f}};
  expectMeet<TypeParam>(huge, small, 1e-3);
}

TYPED_TEST(BroadPhaseEdges, QueriesAsLargeAsTheWorldAnswerToo) {
  const std::vector<Aabb> boxes = test::worldOf(test::Family::size_ratio, 3);
  TypeParam tested;
  tested.update(test::allIds(boxes.size()), boxes);
  const float far = std::numeric_limits<float>::max();
  EXPECT_EQ(foundBy(tested, Aabb{{-far, -far, -far}, {far, far, far}}).size(), boxes.size());
  EXPECT_EQ(foundBy(tested, Sphere{{0, 0, 0}, 1e9}).size(), boxes.size());
  EXPECT_EQ(test::alongOf(tested, Segment{{-1e9, 0, 0}, {1e9, 0, 0}, 1e6}).size(), boxes.size());
}

TYPED_TEST(BroadPhaseEdges, SegmentsAmongTheLargestFloatsMissNothing) {
  const std::vector<Aabb> boxes = {{{0, 0, 0}, {2e38f, 2e38f, 2e38f}}, {{1e38f, 0, 0}, {3e38f, 1e38f, 1e38f}}};
  TypeParam tested;
  tested.update(test::allIds(boxes.size()), boxes);
  for (const Segment& segment :
       {Segment{{3e38, 1e38, 1e38}, {0, 0.5e38, 0.2e38}, 0.0}, Segment{{2.5e38, 0, 0}, {1.5e38, 1e37, 1e37}, 0.0}}) {
    std::size_t met = 0;
    for (const Aabb& box : boxes) met += meet(segment, box).has_value();
    EXPECT_EQ(test::alongOf(tested, segment).size(), met);
  }
}

}  // namespace
}  // namespace hgrid
