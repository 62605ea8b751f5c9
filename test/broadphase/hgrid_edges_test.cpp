// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <limits>

#include "test/support/brute_force.h"
#include "test/support/expectations.h"
#include "test/support/grids.h"

namespace hgrid {
namespace {

using test::allIds;
using test::foundBy;

GridScale finest(double edge) {
  GridScale scale;
  scale.finest_edge = edge;
  return scale;
}

TEST(HGridEdges, OnlyBoxesBeyondTheCoarsestLevelShareTheLastOne) {
  const Aabb huge = {{-5e3f, -5e3f, -5e3f}, {5e3f, 5e3f, 5e3f}};
  const HGrid grid(finest(1e-3));
  EXPECT_LT(grid.levelFor(huge), GridScale::kLevels)
      << "a grid with a finest level of 1 mm must have a level for 10 km";
  EXPECT_EQ(grid.levelFor({{-1e9f, 0, 0}, {1e9f, 0, 0}}), GridScale::kLevels);
}

TEST(HGridEdges, BoxesLargerThanEveryLevelPairWithEverythingTheyOverlap) {
  const float far = 3e38f;
  HGrid grid(finest(0x1p-30));  // the boxes of its coarsest level are at most 1 m long
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

/// Claim: a box of 10 km among boxes of 1 mm is stored once. It does not take memory for the cells that it covers.
TEST(HGridEdges, AHugeBoxTakesTheMemoryOfOneBox) {
  const Aabb huge = {{-5e3f, -5e3f, -5e3f}, {5e3f, 5e3f, 5e3f}}, tiny = {{1, 1, 1}, {1.001f, 1.001f, 1.001f}};
  std::size_t bytes[2] = {};
  for (const bool is_huge : {false, true}) {
    HGrid grid(finest(1e-3));
    for (ProxyId i = 0; i < 1000; ++i) {
      const float x = 0.002f * float(i);
      grid.insert(i, {{x, 0, 0}, {x + 0.001f, 0.001f, 0.001f}});
    }
    grid.insert(1000, is_huge ? huge : tiny);
    std::size_t stored = 0;
    for (const BroadPhaseLevel& level : grid.levels()) stored += level.boxes;
    EXPECT_EQ(stored, 1001u);
    bytes[is_huge ? 1 : 0] = grid.bytes();
  }
  EXPECT_LE(bytes[1], bytes[0] + 4096);
}

/// Claim: the nearest boxes are right if many boxes are equally far away, also if their distances are infinite, because
/// their squares exceed the range of double.
TEST(HGridEdges, NearestBoxesOfPointsFarAway) {
  for (const bool equal : {false, true}) {
    test::Random random(1);
    std::vector<Aabb> boxes;
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector3d place = equal ? Eigen::Vector3d(1, 2, 3) : test::randomVector(random, -5, 5);
      boxes.push_back(test::boxAround(place, {1, 1, 1}));
    }
    HGrid grid;
    test::BruteForce brute_force;
    grid.update(allIds(boxes.size()), boxes);
    brute_force.update(allIds(boxes.size()), boxes);
    for (const double x : {1.0, 20.0, 1e4, 1e17, 1e38, 1e160, 1e300}) {
      for (const std::size_t count : {1u, 2u, 8u, 100u, 299u, 500u}) {
        SCOPED_TRACE("x " + std::to_string(x) + ", boxes: " + std::to_string(count));
        std::vector<NearHit> found, expected;
        grid.nearest({x, 2, 3}, count, std::numeric_limits<double>::infinity(), found);
        brute_force.nearest({x, 2, 3}, count, std::numeric_limits<double>::infinity(), expected);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t k = 0; k < found.size(); ++k) {
          ASSERT_EQ(found[k].id, expected[k].id);
          ASSERT_EQ(found[k].distance, expected[k].distance);
        }
      }
    }
  }
}

}  // namespace
}  // namespace hgrid
