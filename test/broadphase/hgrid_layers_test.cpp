// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "test/support/expectations.h"

// The grid moves boxes between its layers (fixed, resting, moving, loose). The layer of a box depends on how many boxes
// move. The results must not depend on the layers.

namespace hgrid {
namespace {

using test::allIds;
using test::boxAround;
using test::expectRight;
using test::Random;
using test::randomVector;

Aabb someBox(Random& random, double half = 3.0) {
  const Eigen::Vector3d center = randomVector(random, -half, half);
  return boxAround(center, randomVector(random, 0.1, 1.0));
}

std::vector<Aabb> someBoxes(std::size_t count, Random& random, double half = 3.0) {
  std::vector<Aabb> boxes;
  while (boxes.size() < count) boxes.push_back(someBox(random, half));
  return boxes;
}

TEST(HGridLayers, BoxesThatComeOneByOneAreFoundFromTheFirstOn) {
  Random random(1);
  HGrid grid;
  std::vector<Aabb> boxes;
  for (int i = 0; i < 140; ++i) {  // enough boxes to fill the layer of loose boxes twice
    boxes.push_back(someBox(random));
    grid.insert(ProxyId(i), boxes.back());
    ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes));
  }
  std::vector<ProxyId> ids = allIds(boxes.size());
  while (!ids.empty()) {
    const auto gone = ids.begin() + random.below(int(ids.size()));
    grid.remove(*gone);
    ids.erase(gone);
    ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, ids));
  }
}

TEST(HGridLayers, AnyNumberMayBeginToMove) {
  constexpr std::size_t kCount = 400;
  for (const std::size_t moving : {1, 2, 15, 16, 17, 63, 64, 65, 99, 100, 101, 200, 399, 400}) {
    SCOPED_TRACE(std::to_string(moving) + " move");
    Random random(moving);
    std::vector<Aabb> boxes = someBoxes(kCount, random);
    HGrid bulk = test::gridOf(boxes, GridScale{}), single = test::gridOf(boxes, GridScale{});
    for (int frame = 0; frame < 4; ++frame) {
      std::vector<ProxyId> ids;
      std::vector<Aabb> moved;
      for (std::size_t k = 0; k < moving; ++k) {
        ids.push_back(ProxyId(k));
        boxes[k] = someBox(random);
        moved.push_back(boxes[k]);
        single.update(ProxyId(k), boxes[k]);
      }
      bulk.move(ids, moved);
      ASSERT_NO_FATAL_FAILURE(expectRight(bulk, boxes));
      ASSERT_NO_FATAL_FAILURE(expectRight(single, boxes));
    }
  }
}

/// Claim: the pairs of resting boxes that the grid keeps stay correct when boxes begin to move or are removed.
TEST(HGridLayers, KeptPairsEndWithTheRestOfTheirBoxes) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<Aabb> boxes = someBoxes(500, random);
    std::vector<ProxyId> ids = allIds(boxes.size());
    HGrid grid = test::gridOf(boxes, GridScale{});
    for (int frame = 0; frame < 30; ++frame) {
      std::vector<ProxyId> moving;
      std::vector<Aabb> moved;
      for (const ProxyId id : ids) {
        if (!random.chance(0.01)) continue;
        boxes[id] = someBox(random);
        moving.push_back(id);
        moved.push_back(boxes[id]);
      }
      grid.move(moving, moved);
      ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, ids));
      if (frame % 3 != 2) continue;
      const auto gone = ids.begin() + random.below(int(ids.size()));
      grid.remove(*gone);
      ids.erase(gone);
      ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, ids));
    }
  }
}

TEST(HGridLayers, ABoxThatWasRemovedWhileItMovedDoesNotComeBack) {
  Random random(2);
  std::vector<Aabb> boxes = someBoxes(100, random);
  std::vector<ProxyId> ids = allIds(100);
  HGrid grid = test::gridOf(boxes, GridScale{});
  for (ProxyId gone = 0; gone < 5; ++gone) {
    std::vector<Aabb> moved;
    const std::vector<ProxyId> moving(ids.begin(), ids.begin() + 10);
    for (const ProxyId id : moving) moved.push_back(boxes[id] = someBox(random));
    grid.move(moving, moved);
    grid.remove(gone);
    ids.erase(ids.begin());
    ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, ids));
    boxes[7] = someBox(random);
    grid.move({7}, {boxes[7]});  // makes the grid sort the moving boxes again
    ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, ids));
  }
}

TEST(HGridLayers, ARemovedBoxIsNotFoundEvenByAnInfiniteQuery) {
  Random random(3);
  const std::vector<Aabb> boxes = someBoxes(20, random);
  const float far = std::numeric_limits<float>::infinity();
  for (const Isa isa : test::supportedIsas()) {
    SCOPED_TRACE(name(isa));
    HGrid grid = test::gridOf(boxes, GridScale{});
    grid.setIsa(isa);
    grid.remove(3);
    std::vector<ProxyId> expected = allIds(20);
    expected.erase(expected.begin() + 3);
    EXPECT_EQ(test::foundBy(grid, Aabb{{-far, -far, -far}, {far, far, far}}), expected);
    EXPECT_EQ(test::foundBy(grid, Sphere{{0, 0, 0}, 1e39}), expected);
    EXPECT_EQ(test::foundBy(grid, Sphere{{0, 0, 0}, far}), expected);
  }
}

TEST(HGridLayers, WhatIsFixedMayBeSaidBeforeItComes) {
  Random random(3);
  const std::vector<Aabb> boxes = someBoxes(300, random);
  std::vector<ProxyId> fixed;
  std::vector<bool> is_fixed(5000);
  for (ProxyId id = 0; id < 5000; id += 2) fixed.push_back(id), is_fixed[id] = true;
  HGrid grid;
  grid.setFixed(fixed);
  grid.setFixed(fixed);
  ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, {}));
  grid.update(allIds(300), boxes);
  ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, allIds(300), is_fixed));
  grid.setFixed({});
  ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes));
  grid.setFixed(fixed);
  ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, allIds(300), is_fixed));
}

TEST(HGridLayers, FixedBoxesThatComeOrMoveOneByOneMakeNoPairsEither) {
  Random random(4);
  std::vector<Aabb> boxes = someBoxes(200, random);
  std::vector<ProxyId> fixed, ids;
  std::vector<bool> is_fixed(200);
  for (ProxyId id = 0; id < 200; id += 2) fixed.push_back(id), is_fixed[id] = true;
  HGrid grid;
  grid.setFixed(fixed);
  for (ProxyId id = 0; id < 200; ++id) {
    grid.insert(id, boxes[id]);
    ids.push_back(id);
    ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, ids, is_fixed));
  }
  for (int i = 0; i < 200; ++i) {
    const auto id = ProxyId(random.below(200));
    boxes[id] = someBox(random);
    grid.update(id, boxes[id]);
    ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, ids, is_fixed));
    if (i % 10 != 0) continue;
    boxes[7] = someBox(random);
    grid.move({7}, {boxes[7]});
    ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, ids, is_fixed));
  }
}

bool sameRemainder(const void*, ProxyId first, ProxyId second) { return first % 3 == second % 3; }
bool otherRemainder(const void*, ProxyId first, ProxyId second) { return first % 3 != second % 3; }

/// Claim: the filter applies to the pairs of all layers. This holds for one thread and for several threads.
TEST(HGridLayers, AFilterHoldsInAllLayersAndThreads) {
  for (const std::size_t count : {400, 40000}) {
    SCOPED_TRACE(std::to_string(count) + " boxes");
    Random random(4);
    const double half = 0.5 * std::cbrt(double(count));
    std::vector<Aabb> boxes = someBoxes(count, random, half);
    std::vector<ProxyId> fixed, moving;
    std::vector<bool> is_fixed(count);
    for (ProxyId id = 0; id < count; ++id) {
      is_fixed[id] = random.chance(0.3);
      if (is_fixed[id]) fixed.push_back(id);
      if (!is_fixed[id] && random.chance(0.1)) moving.push_back(id);
    }
    HGrid grid;
    grid.setThreads(3);
    grid.setFixed(fixed);
    grid.setOverlapFilter(OverlapFilter::of<sameRemainder>(nullptr));
    grid.update(allIds(count), boxes);
    const auto expectFiltered = [&](auto&& reported) {
      test::Pairs expected;
      for (const auto& pair : test::sweptOverlaps(boxes)) {
        if (is_fixed[pair.first] && is_fixed[pair.second]) continue;
        if (reported(nullptr, pair.first, pair.second)) expected.push_back(pair);
      }
      ASSERT_GT(expected.size(), count / 10);
      ASSERT_TRUE(test::pairsOf(grid) == expected);
    };
    ASSERT_NO_FATAL_FAILURE(expectFiltered(sameRemainder));
    std::vector<Aabb> moved;
    for (const ProxyId id : moving) moved.push_back(boxes[id] = someBox(random, half));
    grid.move(moving, moved);
    for (ProxyId id = 0; id < 60; ++id) {
      if (is_fixed[id]) continue;
      boxes[id] = someBox(random, half);
      grid.update(id, boxes[id]);
    }
    ASSERT_NO_FATAL_FAILURE(expectFiltered(sameRemainder));
    grid.setOverlapFilter(OverlapFilter::of<otherRemainder>(nullptr));
    ASSERT_NO_FATAL_FAILURE(expectFiltered(otherRemainder));
    grid.setOverlapFilter({});
    ASSERT_NO_FATAL_FAILURE(expectFiltered([](const void*, ProxyId, ProxyId) { return true; }));
  }
}

}  // namespace
}  // namespace hgrid
