// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/broadphase/hgrid/region_tree.h"

#include <gtest/gtest.h>

#include <numeric>

#include "test/support/random.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace {

using test::boxAround;
using test::Random;
using test::randomVector;

RegionTree treeOf(const std::vector<Aabb>& boxes) {
  std::vector<ProxyId> ids(boxes.size());
  std::iota(ids.begin(), ids.end(), 0u);
  return RegionTree::dividing(boxes, ids.data(), ids.size());
}

std::vector<Aabb> heap(Random& random, std::size_t count, const Eigen::Vector3d& place) {
  const double half = 0.8 * std::cbrt(double(count));
  std::vector<Aabb> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    boxes.push_back(boxAround(place + randomVector(random, -half, half), Eigen::Vector3d::Ones()));
  }
  return boxes;
}

std::vector<Aabb> heaps(Random& random, int count, std::size_t boxes_each) {
  std::vector<Aabb> boxes;
  for (int i = 0; i < count; ++i) {
    const std::vector<Aabb> one = heap(random, boxes_each, randomVector(random, -5000, 5000));
    boxes.insert(boxes.end(), one.begin(), one.end());
  }
  return boxes;
}

TEST(RegionTree, OfEvenlySpreadBoxesIsOneRegion) {
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u}) {
    Random random(seed);
    EXPECT_EQ(treeOf(heap(random, 5000, {1, 2, 3})).size(), 1u) << seed;
  }
}

TEST(RegionTree, OfFewBoxesIsOneRegion) {
  Random random(1);
  EXPECT_EQ(treeOf({}).size(), 1u);
  EXPECT_EQ(treeOf(heaps(random, 2, 3)).size(), 1u);
  EXPECT_EQ(treeOf(heaps(random, 2, 39)).size(), 1u);
  EXPECT_EQ(treeOf(heaps(random, 2, 41)).size(), 2u);
}

TEST(RegionTree, FindsHeapsWhoseBoxesAlternateInTheListOfIds) {
  for (const std::size_t places : {2u, 3u, 4u, 8u, 11u}) {
    SCOPED_TRACE(places);
    Random random(1);
    std::vector<Aabb> boxes;
    for (std::size_t i = 0; i < 40000; ++i) {
      const Eigen::Vector3d place(1000.0 * double(i % places), 0, 0);
      boxes.push_back(boxAround(place + randomVector(random, -10, 10), {1, 1, 1}));
    }
    EXPECT_GE(treeOf(boxes).size(), places);
  }
}

TEST(RegionTree, GivesEachHeapARegionOfItsOwn) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const std::vector<Aabb> boxes = heaps(random, 10, 200);
    const RegionTree tree = treeOf(boxes);
    EXPECT_EQ(tree.size(), 10u);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      ASSERT_EQ(tree.regionOf(boxes[i].min.data()), tree.regionOf(boxes[i / 200 * 200].min.data())) << "box " << i;
    }
  }
}

/// The first splits of such a world gain almost nothing, because the heaps are everywhere.
TEST(RegionTree, FindsManySmallHeapsThatAreSpreadEvenly) {
  Random random(1);
  std::vector<Aabb> boxes = heaps(random, 300, 100);
  EXPECT_GE(treeOf(boxes).size(), 270u);
}

/// Small samples or few places for splits leave several of these heaps in one region.
TEST(RegionTree, FindsHeapsOfDifferentSizes) {
  std::size_t regions = 0;
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u}) {
    Random random(seed);
    std::vector<Aabb> boxes;
    for (int i = 0; i < 40; ++i) {
      const double size = random.logUniform(0.01, 10);
      const Eigen::Vector3d place = randomVector(random, -200, 200);
      for (int k = 0; k < 75; ++k) {
        boxes.push_back(boxAround(place + 5 * size * randomVector(random, -1, 1), Eigen::Vector3d::Constant(size)));
      }
    }
    regions += treeOf(boxes).size();
  }
  EXPECT_GE(regions, 5u * 42);
}

/// Claim: a box far away does not share a region with a heap, also if it is the only one on its side. (This holds if
/// all boxes are samples, so for less than 4,096 boxes.)
TEST(RegionTree, SeparatesSingleBoxesFarAwayFromAHeap) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    Random random(seed);
    std::vector<Aabb> boxes = heap(random, 300, {0, 0, 0});
    for (const int side : {-1, 1}) {
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d place = side * random.uniform(1e3, 1e5) * Eigen::Vector3d::Unit(axis);
        boxes.push_back(boxAround(place, Eigen::Vector3d::Ones()));
      }
    }
    const RegionTree tree = treeOf(boxes);
    const std::uint32_t region = tree.regionOf(boxes[0].min.data());
    for (std::size_t i = 1; i < boxes.size(); ++i) {
      EXPECT_EQ(tree.regionOf(boxes[i].min.data()) == region, i < 300) << "box " << i << ", seed " << seed;
    }
  }
}

/// Claim: a coordinate that is not representable as a difference of floats does no harm.
TEST(RegionTree, OfBoxesAtTheEndsOfTheRangeOfFloat) {
  Random random(1);
  for (const float end : {3e38f, 1e-44f}) {
    std::vector<Aabb> boxes;
    for (int i = 0; i < 1000; ++i) {
      Aabb box;
      for (int axis = 0; axis < 3; ++axis) box.min[axis] = random.chance(0.5) ? end : -end;
      if (i % 3 == 0) box.min = randomVector(random, -1, 1).cast<float>() * end;
      box.max = box.min;
      boxes.push_back(box);
    }
    const RegionTree tree = treeOf(boxes);
    for (const Aabb& box : boxes) EXPECT_LT(tree.regionOf(box.min.data()), tree.size());
  }
}

TEST(RegionTree, PutsEveryCornerInTheOneRegionThatContainsIt) {
  Random random(7);
  const std::vector<Aabb> boxes = heaps(random, 20, 100);
  const RegionTree tree = treeOf(boxes);
  ASSERT_GT(tree.size(), 10u);
  for (int i = 0; i < 5000; ++i) {
    Eigen::Vector3f corner = randomVector(random, -6000, 6000).cast<float>();
    if (i % 2 != 0) corner = boxes[std::size_t(random.below(int(boxes.size())))].min;
    if (i % 5 == 0) corner[i % 3] = tree.region(std::size_t(random.below(int(tree.size())))).low[i % 3];
    std::size_t containing = 0;
    for (std::size_t number = 0; number < tree.size(); ++number) {
      const kernels::Region& region = tree.region(number);
      bool in = true;
      for (int axis = 0; axis < 3; ++axis)
        in = in && corner[axis] >= region.low[axis] && corner[axis] < region.high[axis];
      if (!in) continue;
      ++containing;
      EXPECT_EQ(tree.regionOf(corner.data()), number);
    }
    if (std::isfinite(corner.sum())) {
      EXPECT_EQ(containing, 1u);
    }
  }
}

TEST(RegionTree, IsOneRegionAgainAfterJoining) {
  Random random(9);
  RegionTree tree = treeOf(heaps(random, 5, 200));
  ASSERT_GT(tree.size(), 1u);
  tree.join();
  EXPECT_EQ(tree.size(), 1u);
  const float anywhere[3] = {-1e30f, 0.0f, 1e30f};
  EXPECT_EQ(tree.regionOf(anywhere), 0u);
}

}  // namespace
}  // namespace hgrid
