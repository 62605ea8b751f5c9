// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include "test/broadphase/bound_tasks.h"

namespace hgrid {
namespace {

using test::allIds;
using test::boundedPairsOf;
using test::Divisible;
using test::Found;
using test::Random;
using test::Task;

/// Whether to run fewer cases. HGRID_TEST_WORLDS asks for this with a sanitizer, which makes everything slow.
const bool kTakesItsTime = test::countFromEnvironment("HGRID_TEST_WORLDS", 10000) < 10000;

/// Returns 40,000 boxes. `piled` boxes are at one place. The others are so far apart that few of them overlap.
std::vector<Aabb> hallWithPile(std::size_t piled, Random& random) {
  std::vector<Aabb> boxes;
  while (boxes.size() < 40000) {
    const bool in_pile = boxes.size() % (40000 / piled) == 0;
    const Eigen::Vector3d center = in_pile ? Eigen::Vector3d(0.1, 0.2, 0.3) : test::randomVector(random, -25, 25);
    boxes.push_back(test::boxAround(center, Eigen::Vector3d::Constant(0.6)));
  }
  return boxes;
}

/// Claim: the results do not depend on the number of threads or on the instruction set. This holds whether or not the
/// search stops at its bound, and whether the boxes move or rest.
TEST(HGridBound, ThreadsAndInstructionSetsDoNotShow) {
  Random random(4);
  Task task;
  task.boxes = hallWithPile(500, random);
  task.divisor = 2;
  Divisible divisible;
  divisible.divisor = task.divisor;
  const std::vector<ProxyId> ids = allIds(task.boxes.size());
  const std::vector<Isa> isas = kTakesItsTime ? std::vector<Isa>{bestIsa()} : test::supportedIsas();
  const std::vector<int> thread_counts = kTakesItsTime ? std::vector<int>{3} : std::vector<int>{1, 2, 4};
  for (const PairBound& bound :
       {PairBound{20000, PairBound::kNone}, PairBound{PairBound::kNone, 30000}, PairBound{1000000, 2000000}}) {
    task.bound = bound;
    HGrid reference;
    setUp(reference, task, divisible);
    bringTo(reference, task, random);
    const Found expected = boundedPairsOf(reference);
    EXPECT_EQ(expected.all, bound.pairs == 1000000u);
    for (const Isa isa : isas) {
      for (const int threads : thread_counts) {
        for (const double share : {0.0, 0.05, 1.0}) {  // fraction of the boxes that move
          SCOPED_TRACE(std::string(name(isa)) + ", threads " + std::to_string(threads) + ", share " +
                       std::to_string(share));
          HGrid grid;
          grid.setIsa(isa);
          grid.setThreads(threads);
          setUp(grid, task, divisible);
          std::vector<Aabb> before = task.boxes;
          for (Aabb& box : before) {
            if (random.chance(share)) box.max.x() += 0.1f;
          }
          grid.update(ids, before);
          boundedPairsOf(grid);  // after this search, the grid keeps the pairs of resting boxes
          grid.update(ids, task.boxes);
          ASSERT_TRUE(boundedPairsOf(grid) == expected);
        }
      }
    }
  }
}

/// Claim: a search passes a limited number of pairs to the filter, even if the filter leaves out every pair. The grid
/// may pass twice the bound, plus all overlaps of one box, plus one full buffer of pairs for each thread.
TEST(HGridBound, BoundsTheWorkOfPilesWhosePairsAreAllLeftOut) {
  constexpr std::size_t kBoxes = 100000, kOverlaps = 100000, kBuffer = 2 * 65536;
  const std::vector<Aabb> boxes(kBoxes, test::boxAround(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()));
  std::vector<Aabb> moved = boxes;
  for (std::size_t i = 0; i < kBoxes; i += 100) moved[i].max.x() += 0.1f;
  for (const int threads : {1, 4}) {
    Divisible divisible;
    divisible.divisor = 1u << 30;
    HGrid grid;
    grid.setThreads(threads);
    grid.setOverlapFilter(divisible.filter());
    grid.setPairBound({1000, kOverlaps});
    for (int tick = 0; tick < 4; ++tick) {
      divisible.asked = 0;
      grid.update(allIds(boxes.size()), tick % 2 == 0 ? boxes : moved);
      const Found found = boundedPairsOf(grid);
      EXPECT_FALSE(found.all);
      EXPECT_TRUE(found.pairs.empty());
      EXPECT_LE(divisible.asked, 2 * (2 * kOverlaps + kBoxes) + 2 * std::size_t(threads) * kBuffer);
    }
  }
}

}  // namespace
}  // namespace hgrid
