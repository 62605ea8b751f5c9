// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <algorithm>

#include "test/support/brute_force.h"
#include "test/support/expectations.h"
#include "test/support/uneven_world.h"

// Worlds in which other boxes move each time. The grid then takes most pairs from the search before, and a box that
// moved only a little returns to its place among the resting boxes.

namespace hgrid {
namespace {

using test::allIds;
using test::boxAround;
using test::expectRight;
using test::Random;
using test::randomVector;

Aabb heapBox(Random& random) { return boxAround(randomVector(random, -8, 8), randomVector(random, 0.1, 1.0)); }

std::vector<Aabb> heapOf(std::size_t count, Random& random) {
  std::vector<Aabb> boxes;
  while (boxes.size() < count) boxes.push_back(heapBox(random));
  return boxes;
}

/// Claim: if other boxes move each time, the pairs of the boxes between moves stay correct. The grid then takes most
/// pairs from the search before. Between the moves, single boxes come, go and move, whatever their layer is.
TEST(HGridTurns, BoxesMayMoveFar) {
  for (const std::size_t movers :
       {20, 110, 200}) {  // few, more than the loose boxes may be, and too many to take turns
    SCOPED_TRACE(std::to_string(movers) + " move");
    Random random(movers);
    std::vector<Aabb> boxes = heapOf(2000, random);
    std::vector<ProxyId> ids = allIds(boxes.size()), last;
    HGrid grid = test::gridOf(boxes, GridScale{});
    for (int frame = 0; frame < 80; ++frame) {
      SCOPED_TRACE("frame " + std::to_string(frame));
      std::vector<ProxyId> moving;
      std::vector<Aabb> moved;
      for (const ProxyId id : ids) {
        if (frame % 20 == 19 ? !std::binary_search(last.begin(), last.end(), id)  // the same boxes move again
                             : !random.chance(double(movers) / double(ids.size()))) {
          continue;
        }
        boxes[id] = heapBox(random);
        moving.push_back(id);
        moved.push_back(boxes[id]);
      }
      grid.move(moving, moved);
      last = moving;
      if (frame % 4 == 0) {
        ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, ids));
      }
      for (const std::vector<ProxyId>& some : {moving, ids}) {
        const ProxyId id = some[std::size_t(random.below(int(some.size())))];
        if (random.chance(0.5)) {
          boxes[id] = heapBox(random);
          grid.update(id, boxes[id]);
        } else if (std::binary_search(ids.begin(), ids.end(), id)) {
          grid.remove(id);
          ids.erase(std::lower_bound(ids.begin(), ids.end(), id));
          if (random.chance(0.5)) {
            grid.insert(id, boxes[id]);
            ids.insert(std::lower_bound(ids.begin(), ids.end(), id), id);
          }
        }
        if (!std::binary_search(ids.begin(), ids.end(), id)) break;  // `moving` may have the id, too
        if (random.chance(0.3)) {
          ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, ids));
        }
      }
      std::vector<ProxyPair> pairs;
      grid.overlappingPairs(pairs);
    }
    ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, ids));
  }
}

/// Returns the box after a move that is mostly small. Sometimes the box also becomes longer.
Aabb movedBox(const Aabb& box, Random& random) {
  const Eigen::Vector3d size = (box.max - box.min).cast<double>();
  const double way = random.chance(0.1) ? 30.0 : random.logUniform(1e-3, 1.0);
  const Eigen::Vector3d center =
      0.5 * (box.min + box.max).cast<double>() + way * size.cwiseProduct(randomVector(random, -1, 1));
  return boxAround(center, random.chance(0.1) ? Eigen::Vector3d(3.0 * size) : size);
}

/// Claim: the pairs and the answers to queries stay correct in worlds of one region, of several regions, and of one row
/// of cells, whether a box leaves its cell or not, grows, leaves the bounds of its level, or becomes fixed.
TEST(HGridTurns, BoxesMayMoveALittleInAnyWorld) {
  constexpr std::size_t kCount = 2000, kMovers = 50;
  for (int kind = 0; kind <= 5; ++kind) {
    SCOPED_TRACE("kind " + std::to_string(kind));
    Random random(unsigned(kind) + 1u);
    std::vector<Aabb> boxes = kind < 5 ? test::unevenWorld(kind, kCount, random) : heapOf(kCount, random);
    HGrid grid(GridScale::fitting(boxes));
    test::BruteForce brute_force;
    const std::vector<ProxyId> all = allIds(kCount);
    grid.update(all, boxes);
    brute_force.update(all, boxes);
    std::vector<bool> is_fixed(kCount);
    std::vector<ProxyId> before;
    for (int frame = 0; frame < 40; ++frame) {
      SCOPED_TRACE("frame " + std::to_string(frame));
      if (frame == 20) {  // a box that is not in the resting layer becomes fixed
        for (const ProxyId id : before) is_fixed[id] = true;
        grid.setFixed(before);
      }
      std::vector<ProxyId> ids;
      std::vector<Aabb> moved;
      for (const ProxyId id : all) {
        if (is_fixed[id] || !random.chance(double(kMovers) / double(kCount))) continue;
        ids.push_back(id);
        moved.push_back(boxes[id] = movedBox(boxes[id], random));
      }
      grid.move(ids, moved);
      brute_force.move(ids, moved);
      if (frame % 4 == 3) {
        ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, all, is_fixed));
      } else {
        test::pairsOf(grid);  // the grid keeps the pairs of a search only if there was one
      }
      for (const ProxyId id : before) {
        ASSERT_EQ(test::foundBy(grid, boxes[id]), test::foundBy(brute_force, boxes[id])) << "box " << id;
      }
      before = ids;
    }
  }
}

/// Claim: a new box does not take the place of a resting box that moves, even if it is where that box was.
TEST(HGridTurns, ANewBoxTakesNoPlaceOfAnother) {
  constexpr ProxyId kCount = 100, kNew = kCount;
  for (ProxyId mover = 0; mover < kCount; ++mover) {
    SCOPED_TRACE("mover " + std::to_string(mover));
    Random random(mover);
    std::vector<Aabb> boxes = heapOf(kCount, random);
    HGrid grid = test::gridOf(boxes, GridScale{});
    const Aabb place = boxes[mover];
    for (ProxyId turn = 0; turn < 6; ++turn) {
      std::vector<ProxyId> ids{(mover + 7 * turn + 1) % kCount, (mover + 7 * turn + 2) % kCount};
      if (turn >= 3) ids.push_back(mover);
      std::sort(ids.begin(), ids.end());
      std::vector<Aabb> moved;
      for (const ProxyId id : ids) moved.push_back(boxes[id] = id == mover ? place : heapBox(random));
      grid.move(ids, moved);
      if (turn == 3) {
        boxes.push_back(place);
        grid.insert(kNew, place);
      }
      ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes));
    }
  }
}

}  // namespace
}  // namespace hgrid
