// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests changes of single boxes of an HGrid, which keeps these boxes in a hash table.
#include <gtest/gtest.h>

#include <numeric>

#include "hgrid_proximity/broadphase/hgrid.h"
#include "test/support/brute_force.h"
#include "test/support/random.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace test {
namespace {

/// Expects that a grid answers all kinds of questions like a grid that got the same boxes in one call, in the same
/// order and bit for bit.
void expectAnswersOfANewGrid(const HGrid& grid, const std::vector<Aabb>& boxes, Random& random) {
  std::vector<ProxyId> ids(boxes.size());
  std::iota(ids.begin(), ids.end(), 0);
  HGrid fresh;
  fresh.update(ids, boxes);
  for (int i = 0; i < 20; ++i) {
    const Aabb& near = boxes[std::size_t(random.below(int(boxes.size())))];
    std::vector<ProxyId> found, expected;
    grid.overlapping(near, found);
    fresh.overlapping(near, expected);
    ASSERT_EQ(found, expected);
    const Sphere sphere{near.min.cast<double>(), random.uniform(0, 3)};
    grid.overlapping(sphere, found);
    fresh.overlapping(sphere, expected);
    ASSERT_EQ(found, expected);
    Segment segment;
    segment.from = near.min.cast<double>(), segment.to = segment.from + randomVector(random, -20, 20);
    segment.radius = random.uniform(0, 0.5);
    std::vector<SegmentHit> met, expected_met;
    grid.along(segment, met);
    fresh.along(segment, expected_met);
    ASSERT_EQ(met.size(), expected_met.size());
    for (std::size_t k = 0; k < met.size(); ++k)
      ASSERT_TRUE(met[k].id == expected_met[k].id && met[k].along == expected_met[k].along);
    std::vector<NearHit> nearest, expected_nearest;
    grid.nearest(sphere.center, 5, 100.0, nearest);
    fresh.nearest(sphere.center, 5, 100.0, expected_nearest);
    ASSERT_EQ(nearest.size(), expected_nearest.size());
    for (std::size_t k = 0; k < nearest.size(); ++k)
      ASSERT_TRUE(nearest[k].id == expected_nearest[k].id && nearest[k].distance == expected_nearest[k].distance);
  }
}

std::vector<ProxyPair> sortedPairsOf(const BroadPhase& grid) {
  std::vector<ProxyPair> pairs;
  grid.overlappingPairs(pairs);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

class HGridSingles : public ::testing::Test {
 protected:
  /// Stores `count` boxes with one call.
  void store(std::size_t count) {
    boxes_.resize(count);
    for (Aabb& box : boxes_) box = anyBox();
    std::vector<ProxyId> ids(count);
    std::iota(ids.begin(), ids.end(), 0);
    grid_.update(ids, boxes_);
  }
  Aabb anyBox() {
    return boxAround(randomVector(random_, -10, 10), randomVector(random_, 0, 1) * random_.logUniform(0.01, 5));
  }
  void move(ProxyId id, const Aabb& box) { grid_.update(id, boxes_[id] = box); }
  void expectRightPairs() {
    BruteForce oracle;
    for (ProxyId id = 0; id < boxes_.size(); ++id) oracle.insert(id, boxes_[id]);
    ASSERT_EQ(sortedPairsOf(grid_), sortedPairsOf(oracle));
  }

  Random random_{7};
  HGrid grid_;
  std::vector<Aabb> boxes_;
};

/// Claim: however many boxes moved alone, and whether a search for pairs, prepared queries or a bulk move came between,
/// the grid answers as if it had got all boxes in one call.
TEST_F(HGridSingles, AnswerLikeAGridThatGotAllBoxesAtOnce) {
  store(400);
  for (int round = 0; round < 60; ++round) {
    for (int i = random_.below(150); i >= 0; --i) move(ProxyId(random_.below(400)), anyBox());
    ASSERT_NO_THROW(grid_.checkInvariants());
    if (random_.chance(0.3)) {
      ASSERT_NO_FATAL_FAILURE(expectRightPairs());
    }
    if (random_.chance(0.2)) {
      std::vector<ProxyId> ids;
      std::vector<Aabb> moved;
      for (ProxyId id = ProxyId(random_.below(20)); id < 400; id += 40) {
        ids.push_back(id);
        moved.push_back(boxes_[id] = anyBox());
      }
      grid_.move(ids, moved);
    }
    ASSERT_NO_FATAL_FAILURE(expectAnswersOfANewGrid(grid_, boxes_, random_));
    ASSERT_NO_THROW(grid_.checkInvariants());
  }
  ASSERT_NO_FATAL_FAILURE(expectRightPairs());
}

/// Claim: a world that was made of single boxes only, without a search for pairs, is searched like any other.
TEST_F(HGridSingles, MayBeAllBoxes) {
  for (ProxyId id = 0; id < 3000; ++id) {
    boxes_.push_back(anyBox());
    grid_.insert(id, boxes_.back());
  }
  ASSERT_NO_THROW(grid_.checkInvariants());
  ASSERT_NO_FATAL_FAILURE(expectAnswersOfANewGrid(grid_, boxes_, random_));
  ASSERT_NO_FATAL_FAILURE(expectRightPairs());
  grid_.clear();
  EXPECT_EQ(grid_.size(), 0u);
  ASSERT_NO_THROW(grid_.checkInvariants());
}

/// Claim: boxes whose coordinates put them all into one cell of the table are found like others.
TEST_F(HGridSingles, InOneCellAreFoundLikeOthers) {
  store(50);
  for (ProxyId id = 50; id < 500; ++id) {
    boxes_.push_back(boxAround(Eigen::Vector3d(0.1, 0.1, 0.1) + randomVector(random_, 0, 0.01), {0.5, 0.5, 0.5}));
    grid_.insert(id, boxes_.back());
    if (id % 50 == 0) {
      ASSERT_NO_FATAL_FAILURE(expectAnswersOfANewGrid(grid_, boxes_, random_));
    }
  }
  ASSERT_NO_THROW(grid_.checkInvariants());
  ASSERT_NO_FATAL_FAILURE(expectRightPairs());
}

/// Claim: in worlds of all families, boxes that come, move and go one at a time are found after each change, as a scan
/// of all boxes finds them. HGRID_TEST_SINGLES sets the number of changes.
TEST(HGridSingleChanges, AreAnsweredLikeByAScan) {
  constexpr int kInOneWorld = 1000;
  const int worlds = countFromEnvironment("HGRID_TEST_SINGLES", 1000000) / kInOneWorld;
  std::size_t hits = 0;
  for (int world = 0; world < worlds; ++world) {
    SCOPED_TRACE("world " + std::to_string(world));
    const auto family = static_cast<Family>(world % kFamilies);
    std::vector<Aabb> places;
    for (unsigned seed = 2 * unsigned(world); places.size() < 20; ++seed) {
      const std::vector<Aabb> more = worldOf(family, seed);
      places.insert(places.end(), more.begin(), more.end());
    }
    Random random{unsigned(world)};
    HGrid grid;
    std::vector<Aabb> boxes(places.size());
    std::vector<bool> stored(places.size());
    std::vector<ProxyId> found, expected;
    for (int change = 0; change < kInOneWorld; ++change) {
      const auto id = ProxyId(random.below(int(boxes.size())));
      const Aabb place = places[std::size_t(random.below(int(places.size())))];
      if (!stored[id]) {
        grid.insert(id, place);
        stored[id] = true;
      } else if (random.chance(0.2)) {
        grid.remove(id);
        stored[id] = false;
      } else {
        grid.update(id, place);
      }
      boxes[id] = place;
      const Aabb& query = random.chance(0.5) ? place : places[std::size_t(random.below(int(places.size())))];
      expected.clear();
      for (ProxyId other = 0; other < boxes.size(); ++other) {
        if (stored[other] && oracleOverlap(query, boxes[other])) expected.push_back(other);
      }
      grid.overlapping(query, found);
      ASSERT_EQ(found, expected) << "change " << change;
      hits += found.size();
      if (random.chance(0.005)) sortedPairsOf(grid);  // from here on, boxes are sorted that were hashed before
    }
    ASSERT_NO_THROW(grid.checkInvariants());
    BruteForce oracle;
    for (ProxyId id = 0; id < boxes.size(); ++id) {
      if (stored[id]) oracle.insert(id, boxes[id]);
    }
    ASSERT_EQ(sortedPairsOf(grid), sortedPairsOf(oracle));
  }
  EXPECT_GT(hits, std::size_t(worlds) * kInOneWorld) << "too few hits for a meaningful comparison";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
