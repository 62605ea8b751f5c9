// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <thread>

#include "test/support/grids.h"

namespace hgrid {
namespace {

using test::Family;
using test::Random;

/// The answers of a grid to a fixed set of queries.
struct Answers {
  test::Pairs pairs;
  std::vector<std::vector<ProxyId>> found;
  std::vector<std::vector<SegmentHit>> along;
  bool operator==(const Answers& other) const {
    return pairs == other.pairs && found == other.found && along == other.along;
  }
};

Answers answersOf(const HGrid& grid, const std::vector<Aabb>& boxes) {
  Answers answers;
  answers.pairs = test::pairsOf(grid);
  for (std::size_t i = 0; i < boxes.size(); i += 7) {
    const Eigen::Vector3d a = boxes[i].min.cast<double>(), b = boxes[boxes.size() - 1 - i].max.cast<double>();
    answers.found.push_back(test::foundBy(grid, boxes[i]));
    answers.found.push_back(test::foundBy(grid, Sphere{a, 0.5}));
    answers.along.push_back(test::alongOf(grid, Segment{a, b, 0.01}));
  }
  return answers;
}

std::vector<Aabb> someWorld(unsigned seed) { return test::worldOf(static_cast<Family>(seed % test::kFamilies), seed); }

TEST(HGridInvariance, TheWayToAWorldDoesNotShow) {
  for (unsigned seed = 1; seed <= 220; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const std::vector<Aabb> boxes = someWorld(seed);
    const GridScale scale = test::scaleFor(boxes, random);
    const Answers expected = answersOf(test::gridOf(boxes, scale), boxes);
    for (int round = 0; round < 5; ++round)
      ASSERT_TRUE(answersOf(test::gridBroughtTo(boxes, scale, random), boxes) == expected);
  }
}

Aabb boxOfAnySize(Random& random) {
  const double size = random.chance(0.01) ? random.uniform(1, 20) : random.logUniform(0.05, 1);
  return test::boxAround(test::randomVector(random, -25, 25), size * test::randomVector(random, 0.1, 1.0));
}

Aabb thinBox(Random& random) { return test::thinBoxAround(test::randomVector(random, -42, 42), random); }

/// Moves boxes to other places, and checks that the pairs and their order are the same with all instruction sets and
/// all numbers of threads.
/// @param somewhere  returns a box at a random place
void expectSamePairs(Aabb (*somewhere)(Random&)) {
  std::vector<Aabb> boxes;
  std::vector<ProxyId> ids;
  Random random(3);
  for (ProxyId id = 0; id < 70000; ++id) {
    ids.push_back(id);
    boxes.push_back(somewhere(random));
  }
  std::vector<std::vector<Aabb>> frames = {boxes};
  for (const double share : {1.0, 0.1, 0.1, 0.6}) {
    for (Aabb& box : boxes) {
      if (random.chance(share)) box = somewhere(random);
    }
    frames.push_back(boxes);
  }
  std::vector<std::vector<ProxyPair>> expected;
  std::vector<Isa> isas = test::supportedIsas();
  std::vector<int> thread_counts = {1, 2, 3, 5};
  if (test::countFromEnvironment("HGRID_TEST_WORLDS", 10000) < 10000) {  // a sanitizer makes the test slow
    isas = {bestIsa()};
    thread_counts = {1, 3};
  }
  for (const Isa isa : isas) {
    for (const int threads : thread_counts) {
      SCOPED_TRACE(std::string(name(isa)) + ", threads " + std::to_string(threads));
      HGrid grid;
      grid.setIsa(isa);
      grid.setThreads(threads);
      for (std::size_t frame = 0; frame < frames.size(); ++frame) {
        std::vector<ProxyPair> pairs;
        grid.update(ids, frames[frame]);
        grid.overlappingPairs(pairs);
        if (expected.size() == frame) expected.push_back(pairs);
        ASSERT_GT(pairs.size(), 10000u);
        ASSERT_TRUE(pairs == expected[frame]) << "frame " << frame;
      }
      grid.checkInvariants();
    }
  }
}

TEST(HGridInvariance, InstructionSetsAndThreadsDoNotShow) { expectSamePairs(boxOfAnySize); }

TEST(HGridInvariance, InstructionSetsAndThreadsDoNotShowInALayerWithLevelsByShape) { expectSamePairs(thinBox); }

TEST(HGridInvariance, TheSizeOfTheCellsDoesNotShow) {
  for (unsigned seed = 1; seed <= 110; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::vector<Aabb> boxes = someWorld(seed);
    const Answers expected = answersOf(test::gridOf(boxes, GridScale::fitting(boxes)), boxes);
    for (int power = -30; power <= 30; power += 6) {
      GridScale scale;
      scale.finest_edge = std::ldexp(1.0, power);
      ASSERT_TRUE(answersOf(test::gridOf(boxes, scale), boxes) == expected) << "edge 2^" << power;
    }
  }
}

TEST(HGridInvariance, ScaledByAPowerOfTwoTheSamePairsTouch) {
  int compared = 0;
  for (unsigned seed = 1; seed <= 110; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::vector<Aabb> boxes = someWorld(seed);
    const test::Pairs expected = test::pairsOf(test::gridOf(boxes, GridScale{}));
    for (const int power : {-20, -3, 1, 7, 40}) {
      const float factor = std::ldexp(1.f, power);
      std::vector<Aabb> scaled = boxes;
      for (Aabb& box : scaled) box.min *= factor, box.max *= factor;
      bool exact = true;  // false if the scaling rounded a denormal number
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        exact &= scaled[i].min / factor == boxes[i].min && scaled[i].max / factor == boxes[i].max;
      }
      if (!exact) continue;
      ++compared;
      ASSERT_EQ(test::pairsOf(test::gridOf(scaled, GridScale{})), expected) << "by 2^" << power;
    }
  }
  EXPECT_GT(compared, 400);
}

TEST(HGridInvariance, ShiftedByWholeCellsTheSamePairsTouch) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<Aabb> boxes(100);  // their coordinates are multiples of 1/256 m, so no sum is rounded
    for (Aabb& box : boxes) {
      for (int k = 0; k < 3; ++k) {
        box.min[k] = float(random.between(-512, 512)) / 256.f;
        box.max[k] = box.min[k] + float(random.between(0, 200)) / 256.f;
      }
    }
    const test::Pairs expected = test::pairsOf(test::gridOf(boxes, GridScale{}));
    for (const float shift : {0.0625f, -0.0625f, 64.f, -4096.f, 16384.f}) {
      std::vector<Aabb> moved = boxes;
      for (Aabb& box : moved) box.min.array() += shift, box.max.array() += shift;
      ASSERT_EQ(test::pairsOf(test::gridOf(moved, GridScale{})), expected) << "by " << shift;
    }
  }
}

TEST(HGridInvariance, ABulkUpdateLeavesWhatInsertingWouldLeave) {
  for (unsigned seed = 1; seed <= 110; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const std::vector<Aabb> before = someWorld(seed + 1000), boxes = someWorld(seed);
    HGrid grid = test::gridOf(before, GridScale{});
    std::vector<ProxyId> ids;
    std::vector<Aabb> chosen;
    HGrid expected;
    for (ProxyId id = 0; id < boxes.size(); ++id) {
      if (random.chance(0.3)) continue;
      ids.push_back(id);
      chosen.push_back(boxes[id]);
      expected.insert(id, boxes[id]);
    }
    grid.update(ids, chosen);
    grid.checkInvariants();
    ASSERT_EQ(grid.size(), ids.size());
    ASSERT_TRUE(answersOf(grid, boxes) == answersOf(expected, boxes));
  }
}

TEST(HGridInvariance, FourThreadsAtOnceGetTheAnswersOfOne) {
  std::vector<Aabb> boxes;
  for (unsigned seed = 1; seed <= 11; ++seed) {
    const std::vector<Aabb> world = someWorld(seed);
    boxes.insert(boxes.end(), world.begin(), world.end());
  }
  const HGrid grid = test::gridOf(boxes, GridScale::fitting(boxes));
  const Answers expected = answersOf(grid, boxes);
  std::atomic<int> equal{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      for (int round = 0; round < 5; ++round) equal += answersOf(grid, boxes) == expected;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(equal, 20);
}

}  // namespace
}  // namespace hgrid
