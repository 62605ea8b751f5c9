// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/broadphase/hgrid/box_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/broadphase/hgrid/box_sample.h"
#include "src/broadphase/hgrid/layer_plan.h"
#include "test/support/expectations.h"
#include "test/support/random.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace {

using test::allIds;
using test::boxAround;
using test::Random;
using test::randomVector;

/// Returns the size class of a side, found by going through all of them.
std::size_t sizeClass(double side, double finest_edge) {
  std::size_t number = 0;
  for (double edge = finest_edge; number < GridScale::kLevels && side > edge; edge *= GridScale::kRatio) ++number;
  return number;
}

TEST(BoxStatistics, CountBoxesInTheSmallestClassThatIsLargeEnough) {
  Random random(1);
  for (const double finest_edge : {0x1p-30, 0.0625, 1.0, 0x1p30}) {
    std::vector<float> sides = {0.0f, std::numeric_limits<float>::denorm_min(), 1e-38f, 1e30f, 3e38f};
    for (int i = 0; i < 40; ++i) {  // exactly an edge, and the floats beside it
      const auto edge = static_cast<float>(std::ldexp(finest_edge, i - 3));
      for (const float side : {std::nextafter(edge, 0.0f), edge, std::nextafter(edge, 1e38f)}) sides.push_back(side);
    }
    for (int i = 0; i < 300; ++i) sides.push_back(static_cast<float>(random.logUniform(1e-12, 1e12)));
    for (const float side : sides) {
      const std::vector<Aabb> boxes = {{{0, 0, 0}, {0.5f * side, side, 0}}};
      const ProxyId id = 0;
      const BoxStatistics statistics = statisticsOf(boxes, &id, 1, finest_edge, Shapes::ignored);
      EXPECT_EQ(statistics.sizes[sizeClass(side, finest_edge)].boxes, 1.0) << side << ", finest edge " << finest_edge;
    }
  }
}

TEST(BoxStatistics, AreSumsAndBoundsOfTheGivenBoxesOnly) {
  const std::vector<Aabb> boxes = {{{0, 0, 0}, {9, 9, 9}}, {{1, 2, 3}, {2, 4, 6}}, {{-1, 5, 0}, {1, 6, 1}}};
  const ProxyId ids[] = {2, 1};
  const BoxStatistics statistics = statisticsOf(boxes, ids, 2, 1.0, Shapes::counted);
  const Census all = statistics.all();
  EXPECT_EQ(statistics.boxes, 2u);
  EXPECT_EQ(all.boxes, 2.0);
  EXPECT_EQ(all.total, (Census::Vector{3, 3, 4}));
  EXPECT_EQ(all.largest, (Census::Vector{2, 2, 3}));
  EXPECT_EQ(statistics.lower, (Census::Vector{-1, 2, 0}));
  EXPECT_EQ(statistics.upper, (Census::Vector{1, 5, 3}));
  EXPECT_EQ(statistics.shapes[7].boxes, 2.0) << "both boxes are long on all axes";
  EXPECT_EQ(statisticsOf(boxes, ids, 2, 1.0, Shapes::ignored).shapes[7].boxes, 0.0);
}

TEST(BoxSample, LeavesOutOneOfAHundredBoxesAtEachEnd) {
  Random random(2);
  for (const std::size_t count : {1u, 99u, 100u, 127u, 128u}) {  // all of them are sampled
    std::vector<Aabb> boxes;
    std::vector<float> corners;
    for (std::size_t i = 0; i < count; ++i) {
      boxes.push_back(boxAround(randomVector(random, -9, 9), {1, 1, 1}));
      corners.push_back(boxes.back().min.y());
    }
    std::sort(corners.begin(), corners.end());
    const BoxSample sample(boxes, allIds(count).data(), count);
    EXPECT_EQ(sample.low(1), corners[count / 100]) << count;
    EXPECT_EQ(sample.high(1), corners[count - 1 - count / 100]) << count;
  }
}

TEST(BoxSample, OfManyBoxesLeavesOutTwo) {
  std::vector<Aabb> boxes(4096, Aabb{{0, 0, 0}, {1, 1, 1}});
  for (int i = 0; i < 4096; ++i) boxes[static_cast<std::size_t>(i)].min.x() = static_cast<float>(i) / 16.0f;
  const BoxSample sample(boxes, allIds(boxes.size()).data(), boxes.size());  // one box of each 16
  EXPECT_GE(sample.low(0), 2.0);
  EXPECT_LT(sample.low(0), 3.0);
  EXPECT_GE(sample.high(0), 253.0);
  EXPECT_LT(sample.high(0), 254.0);
}

TEST(LayerPlan, SortsTheIdsOfAllRegionsAndKeepsTheOrderInEach) {
  Random random(3);
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < 20; ++i) places.push_back(randomVector(random, -5000, 5000));
  std::vector<Aabb> boxes;
  for (int i = 0; i < 3000; ++i) {
    boxes.push_back(
        boxAround(places[static_cast<std::size_t>(random.below(20))] + randomVector(random, -8, 8), {1, 1, 1}));
  }
  std::vector<ProxyId> ids = allIds(boxes.size());
  std::vector<std::uint32_t> scratch(ids.size());
  LayerPlan plan;
  ASSERT_TRUE(plan.planRegions(boxes, ids.data(), scratch.data(), ids.size(), 1.0));
  ASSERT_GE(plan.tree().size(), 20u);
  const auto regionOf = [&](ProxyId id) { return plan.tree().regionOf(boxes[id].min.data()); };
  std::vector<ProxyId> expected = allIds(boxes.size());
  std::stable_sort(expected.begin(), expected.end(), [&](ProxyId a, ProxyId b) { return regionOf(a) < regionOf(b); });
  EXPECT_EQ(ids, expected);
}

}  // namespace
}  // namespace hgrid
