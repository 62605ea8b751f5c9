// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/broadphase/hgrid/cell_plan.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "src/broadphase/hgrid/box_sample.h"
#include "src/broadphase/hgrid/layer_plan.h"
#include "test/support/expectations.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace {

using test::allIds;
using test::boxAround;
using test::diagonalOfBoxes;
using test::Random;
using test::randomVector;

CellPlanner plannerOf(const std::vector<Aabb>& boxes, Layout layout = Layout::one_region) {
  return {boxes, allIds(boxes.size()).data(), boxes.size(), 1.0, layout};
}

CellPlan planOf(const std::vector<Aabb>& boxes, Rows rows = Rows::any, Layout layout = Layout::one_region) {
  return plannerOf(boxes, layout).plan(rows);
}

bool hasOneRow(const CellPlan& plan) { return plan.levels == 1 && plan.grids[0].rows == 1; }

TEST(CellPlan, HasOneRowIfFewBoxesOverlapAlongOneAxis) {
  for (const std::size_t count : {100u, 1500u, 40000u}) EXPECT_TRUE(hasOneRow(planOf(diagonalOfBoxes(count)))) << count;
}

TEST(CellPlan, HasSeveralRowsIfManyBoxesOverlapAlongEachAxis) {
  Random random(1);
  std::vector<Aabb> boxes;
  for (int i = 0; i < 3000; ++i) boxes.push_back(boxAround(randomVector(random, 0, 20), {1, 1, 1}));
  EXPECT_FALSE(hasOneRow(planOf(boxes)));
}

TEST(CellPlan, HasSeveralRowsIfOneRowIsNotAllowed) {
  EXPECT_FALSE(hasOneRow(planOf(diagonalOfBoxes(1500), Rows::several)));
  EXPECT_FALSE(hasOneRow(planOf(diagonalOfBoxes(1500), Rows::several, Layout::regions)));
}

TEST(CellPlan, HasOneRowOfBoxesThatAreFarApartOnlyIfTheyAreFew) {
  Random random(3);
  std::vector<Aabb> boxes;
  for (int i = 0; i < 20000; ++i) boxes.push_back(boxAround(randomVector(random, 0, 20000), {1, 1, 1}));
  EXPECT_FALSE(hasOneRow(planOf(boxes)));  // a query would have to test most boxes
  boxes.resize(1000);
  EXPECT_TRUE(hasOneRow(planOf(boxes)));
}

TEST(CellPlan, HasSeveralRowsOfManyFlatBoxesOnASurface) {
  Random random(4);
  std::vector<Aabb> boxes;
  for (int i = 0; i < 20000; ++i) {
    boxes.push_back(boxAround({random.uniform(0, 20000), random.uniform(0, 20000), 0}, {0, 0, 0}));
  }
  EXPECT_FALSE(hasOneRow(planOf(boxes)));
}

TEST(CellPlan, EstimatesFollowersOnlyIfTheyAreWhyBoxesShareOneRow) {
  EXPECT_LT(planOf(diagonalOfBoxes(1500)).followers, 5.0);
  std::vector<Aabb> corridor;  // one row is planned because the world is narrow, although many boxes follow each box
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    corridor.push_back(boxAround({random.uniform(0, 50), random.uniform(0, 0.5), random.uniform(0, 0.5)}, {1, 1, 1}));
  }
  EXPECT_EQ(planOf(corridor).followers, std::numeric_limits<double>::infinity());
}

TEST(CellPlan, HasNoCellWhoseIndexIsNotExactAsAFloat) {
  std::vector<Aabb> boxes;
  for (int i = 0; i < 1000; ++i) boxes.push_back(boxAround({0, 0, 1e6 * i}, {1e-3, 1e-3, 1e-3}));
  std::vector<ProxyId> ids(17000000);  // as if there were so many boxes
  for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<ProxyId>(i * boxes.size() / ids.size());
  for (const Rows rows : {Rows::any, Rows::several}) {
    const CellPlan plan = CellPlanner(boxes, ids.data(), ids.size(), 1.0, Layout::one_region).plan(rows);
    ASSERT_EQ(plan.levels, 1u);
    EXPECT_GT(plan.grids[0].last[2], 1e7f);
    EXPECT_LT(plan.grids[0].last[2], 16777216.0f);
  }
}

TEST(CellPlan, DoesNotDependOnAFewBoxesFarAwayInALargeRegion) {
  Random random(2);
  std::vector<Aabb> boxes;
  for (int i = 0; i < 3000; ++i) boxes.push_back(boxAround(randomVector(random, 0, 20), {1, 1, 1}));
  const float edge = 1.0f / planOf(boxes, Rows::several, Layout::regions).grids[0].inverse[1];
  boxes.push_back(boxAround({1e5, -1e5, 1e5}, {1, 1, 1}));
  EXPECT_NEAR(1.0f / planOf(boxes, Rows::several, Layout::regions).grids[0].inverse[1], edge, 0.5 * edge);
}

/// Returns rods along random axes.
std::vector<Aabb> rods(std::size_t count, double side = 50.0) {
  Random random(6);
  std::vector<Aabb> boxes;
  while (boxes.size() < count) {
    Eigen::Vector3d size(0.1, 0.1, 0.1);
    size[random.below(3)] = 10.0;
    boxes.push_back(boxAround(randomVector(random, 0, side), size));
  }
  return boxes;
}

TEST(CellPlan, HasOneLevelForTheRodsAlongEachAxis) {
  const CellPlan plan = planOf(rods(20000));
  ASSERT_TRUE(plan.by_shape);
  ASSERT_EQ(plan.levels, 4u);  // the last one is for rare shapes
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t level = plan.level_of_shape[std::size_t{1} << axis];
    EXPECT_NEAR(plan.largest[level][axis], 10.f, 0.1f);
    for (std::size_t other = 0; other < 3; ++other) {
      if (other == axis) continue;
      EXPECT_NEAR(plan.largest[level][other], 0.1f, 0.01f);
      EXPECT_LT(1.f / plan.grids[level].inverse[other], 2.f) << "cells are short where the rods are thin";
    }
  }
}

TEST(CellPlan, HasLevelsByShapeInTheWorldsOfOtherTests) {
  Random random(8);
  for (const auto& [count, half] : {std::pair(5000u, 18.0), std::pair(70000u, 42.0)}) {
    std::vector<Aabb> boxes;
    while (boxes.size() < count) boxes.push_back(test::thinBoxAround(randomVector(random, -half, half), random));
    EXPECT_TRUE(planOf(boxes).by_shape) << count << " boxes";
  }
}

TEST(CellPlan, HasALevelForAllRareShapes) {
  std::vector<Aabb> boxes = rods(20000);
  for (int i = 0; i < 100; ++i) boxes.push_back(boxAround({0.5 * i, 0.3 * i, 0.1 * i}, {3, 3, i % 2 == 0 ? 3 : 0.1}));
  const CellPlan plan = planOf(boxes);
  ASSERT_TRUE(plan.by_shape);
  EXPECT_EQ(plan.levels, 4u);
  EXPECT_EQ(plan.level_of_shape[7], plan.level_of_shape[3]);
  EXPECT_NEAR(plan.largest[plan.level_of_shape[7]][1], 3.f, 0.01f);
}

TEST(CellPlan, HasALevelForShapesThatNoBoxHas) {
  const CellPlan plan = planOf(rods(20000));
  for (const std::size_t shape : {3u, 5u, 6u, 7u}) EXPECT_EQ(plan.level_of_shape[shape], plan.levels - 1) << shape;
}

TEST(CellPlan, PutsABoxOnTheLevelOnWhichTheKernelsPutIt) {
  std::vector<Aabb> boxes = rods(20000);
  Aabb box;  // its first side is a little less than a quarter of the second one; in floats, it is a quarter
  box.min = {-0.175100282f, -0.0374960192f, 0.f};
  box.max = {1.15559292f, 5.28527689f, 0.01f};
  boxes.push_back(box);
  const CellPlan plan = planOf(boxes);
  ASSERT_TRUE(plan.by_shape);
  EXPECT_NEAR(plan.largest[plan.levels - 1][1], 5.32f, 0.01f) << "it is long on two axes, so its shape is rare";
}

TEST(CellPlan, HasNoLevelsByShapeIfTheLengthsOfRodsDifferMuch) {
  std::vector<Aabb> boxes = rods(20000);
  for (std::size_t i = 0; i < boxes.size(); i += 50) boxes[i].max = boxes[i].min + 5 * (boxes[i].max - boxes[i].min);
  EXPECT_FALSE(planOf(boxes).by_shape);
}

TEST(LayerPlan, IsNoLongerGoodWhenManyBoxesGetARareShape) {
  const std::vector<Aabb> boxes = rods(20000);
  LayerPlan plan;
  plan.reserve(CellPlan::kMostLevels);
  plan.planOneRegion(plannerOf(boxes).plan(Rows::any));
  std::vector<kernels::Level> levels(plan.levels());
  levels.back().begin = 19900;
  levels.back().end = 20000;
  EXPECT_TRUE(plan.fits(levels));
  levels.back().begin = 18000;
  EXPECT_FALSE(plan.fits(levels));
}

TEST(LayerPlan, StaysGoodWhileAFewBoxesTurn) {
  const std::vector<Aabb> boxes = rods(20000);
  LayerPlan plan;
  plan.reserve(CellPlan::kMostLevels);
  plan.planOneRegion(plannerOf(boxes).plan(Rows::any));
  ASSERT_EQ(plan.levels(), 4u);
  std::vector<float> sizes(16);
  const auto fits = [&] {
    float lower[3] = {0, 0, 0}, upper[3] = {50, 50, 50};
    return plan.fits(BoxCensus{lower, upper, sizes.data()});
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t level = plan.levelOfShape()[std::size_t{1} << axis];
    for (std::size_t i = 0; i < 3; ++i) sizes[4 * level + i] = i == axis ? 10.f : 0.1f;
  }
  EXPECT_TRUE(fits());
  sizes[12] = sizes[13] = 7.f;  // a box on the level of the rare shapes
  EXPECT_TRUE(fits());
  sizes[4] *= 2;
  EXPECT_FALSE(fits()) << "a level of a frequent shape has longer boxes";
}

TEST(CellPlan, HasNoLevelsByShapeIfTheyDoNotHelp) {
  EXPECT_FALSE(planOf(rods(4095, 30)).by_shape) << "few boxes";
  EXPECT_TRUE(planOf(rods(4096, 30)).by_shape);
  EXPECT_FALSE(planOf(rods(20000), Rows::several, Layout::regions).by_shape);
  std::vector<Aabb> boxes = rods(20000);
  Random random(7);
  while (boxes.size() < 80000) boxes.push_back(boxAround(randomVector(random, 0, 50), {0.3, 0.3, 0.3}));
  EXPECT_FALSE(planOf(boxes).by_shape) << "most boxes are cubes";
}

TEST(BoxSample, EstimatesHowManyBoxesFollowABox) {
  for (const std::size_t count : {2u, 99u, 256u, 257u, 511u, 20000u}) {
    SCOPED_TRACE(count);
    const std::vector<Aabb> boxes = diagonalOfBoxes(count);
    const std::vector<ProxyId> ids = allIds(count);
    const BoxSample sample(boxes, ids.data(), count);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(sample.followers(axis, 0.0), 0.0);
      // Each box is followed by 1000 boxes within 400 m, except the last ones.
      const double all = double(count) - 1.0, most = std::min(1000.0, all);
      const double expected = most - 0.5 * most * (most + 1.0) / double(count);
      EXPECT_NEAR(sample.followers(axis, 400.1), expected, 0.1 * expected + 1.0);
    }
  }
}

/// Claim: the quick lower bound is hardly ever above the estimate, and it is not useless.
TEST(BoxSample, EstimatesQuicklyHowManyBoxesFollowABoxAtLeast) {
  const std::size_t count = 3000;
  const std::vector<ProxyId> ids = allIds(count);
  double bounds = 0.0, estimates = 0.0;
  int above = 0, cases = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    Random random(seed);
    std::vector<Aabb> boxes;
    while (boxes.size() < count) boxes.push_back(boxAround(randomVector(random, 0, 100), {1, 1, 1}));
    const BoxSample sample(boxes, ids.data(), count);
    for (const double length : {1.0, 3.0, 10.0, 30.0}) {
      const double least = sample.leastFollowers(0, length), estimate = sample.followers(0, length);
      bounds += least;
      estimates += estimate;
      above += least > estimate;
      ++cases;
    }
  }
  EXPECT_LT(above, 0.02 * cases);
  EXPECT_GT(bounds, 0.5 * estimates);
  EXPECT_EQ(BoxSample(diagonalOfBoxes(40), ids.data(), 40).leastFollowers(0, 1e6), 0.0) << "too few for a sample";
}

TEST(BoxSample, IsTakenFromTheWholeList) {
  const std::size_t count = 500;  // less than two boxes per sampled box
  const std::vector<Aabb> boxes = diagonalOfBoxes(count);
  const std::vector<ProxyId> ids = allIds(count);
  const BoxSample sample(boxes, ids.data(), count);
  EXPECT_NEAR(sample.low(0), boxes.front().min[0], 4.0);
  EXPECT_NEAR(sample.high(0), boxes.back().min[0], 4.0);
}

TEST(BoxSample, HasBoxesOfAllHeapsWhoseBoxesAlternateInTheListOfIds) {
  for (const int count : {1024, 16384, 30000, 32768}) {
    for (int heaps = 2; heaps <= 24; ++heaps) {
      SCOPED_TRACE(std::to_string(count) + " boxes, " + std::to_string(heaps) + " heaps");
      std::vector<Aabb> boxes;
      for (int i = 0; i < count; ++i) boxes.push_back(boxAround({100.0 * (i % heaps), 0, 0}, {1, 1, 1}));
      const BoxSample sample(boxes, allIds(boxes.size()).data(), boxes.size());
      EXPECT_NEAR(sample.low(0), -0.5, 1e-3);
      EXPECT_NEAR(sample.high(0), 100.0 * (heaps - 1) - 0.5, 1e-3);
    }
  }
}

TEST(BoxSample, OfFewBoxesGivesTheirBounds) {
  const std::vector<Aabb> boxes = diagonalOfBoxes(99);
  const std::vector<ProxyId> ids = allIds(99);
  const BoxSample sample(boxes, ids.data(), 99);
  EXPECT_EQ(float(sample.low(1)), boxes.front().min[1]);
  EXPECT_EQ(float(sample.high(1)), boxes.back().min[1]);
}

}  // namespace
}  // namespace hgrid
