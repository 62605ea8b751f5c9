// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Claims: HGrid::prepareQueries() changes no answer, whatever the world and the instruction set, and its trees are used
// only while the boxes of their layer do not change.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include "test/support/brute_force.h"
#include "test/support/expectations.h"
#include "test/support/grids.h"

namespace hgrid {
namespace {

using test::allIds;
using test::boxAround;
using test::Random;
using test::randomVector;

/// The ids that queries of all kinds find, near boxes and far from them.
using Answers = std::vector<std::vector<ProxyId>>;

/// Asks queries of all kinds at places that depend on the seed.
/// @param count  number of queries of each kind
Answers answersOf(const BroadPhaseReader& tested, const std::vector<Aabb>& boxes, unsigned seed, int count = 60) {
  Answers answers;
  Random random(seed);
  for (int i = 0; i < count; ++i) {
    const Aabb& a = boxes[std::size_t(random.below(int(boxes.size())))];
    const Aabb& b = boxes[std::size_t(random.below(int(boxes.size())))];
    const double size = (a.max - a.min).cast<double>().maxCoeff() * random.logUniform(0.1, 10.0);
    const Eigen::Vector3d near = a.min.cast<double>() + size * randomVector(random, -1, 1);
    const Eigen::Vector3d far = near + randomVector(random, -1, 1) * size * random.logUniform(1.0, 1e4);
    const Eigen::Vector3d corner = a.max.cast<double>(), other = b.min.cast<double>();
    Eigen::Vector3d along_axis = corner;
    along_axis[i % 3] += size * random.logUniform(0.1, 100.0);
    answers.push_back(test::foundBy(tested, boxAround(near, size * randomVector(random, 0.0, 2.0))));
    answers.push_back(test::foundBy(tested, Sphere{i % 2 == 0 ? near : corner, i % 5 == 0 ? 0.0 : size}));
    answers.push_back(test::foundBy(tested, Sphere{corner + size * Eigen::Vector3d::Unit(i % 3), size}));  // touches it
    for (const Segment& segment :
         {Segment{near, far, 0.0}, Segment{corner, other, i % 2 == 0 ? 0.0 : size}, Segment{corner, along_axis, 0.0},
          Segment{along_axis, corner, 0.0}, Segment{corner, corner, 0.0}}) {
      answers.push_back(test::idsAlong(tested, segment));
    }
    std::vector<NearHit> nearest;
    tested.nearest(near, 5, std::numeric_limits<double>::infinity(), nearest);
    answers.emplace_back();
    for (const NearHit& hit : nearest) answers.back().push_back(hit.id);
  }
  return answers;
}

/// Worlds that divide a tree in different ways.
const std::vector<std::pair<const char*, std::function<Aabb(std::size_t, Random&)>>> kWorlds = {
    {"even",
     [](std::size_t, Random& random) { return boxAround(randomVector(random, -20, 20), randomVector(random, 0, 1)); }},
    {"two heaps far apart",
     [](std::size_t i, Random& random) {
       const Eigen::Vector3d heap(i % 2 == 0 ? 0.0 : 4e3, 0.0, i % 2 == 0 ? 0.0 : 7e3);
       return boxAround(heap + randomVector(random, -10, 10), randomVector(random, 0, 1));
     }},
    {"strays",
     [](std::size_t, Random& random) {
       return boxAround(randomVector(random, -1, 1) * (random.chance(0.05) ? 1e5 : 20.0), randomVector(random, 0, 1));
     }},
    {"all equal",
     [](std::size_t, Random&) {
       return Aabb{{1, 2, 3}, {2, 3, 4}};
     }},
    {"points on a line",
     [](std::size_t i, Random&) {
       return Aabb{{float(i), 0, 0}, {float(i), 0, 0}};
     }},
    {"each point at half the distance of the one before",
     [](std::size_t i, Random&) {
       const float x = std::ldexp(1.0f, 100 - int(i % 230));
       return Aabb{{x, 0, 0}, {x, 0, 0}};
     }},
    {"sizes from a millimeter to a kilometer",
     [](std::size_t, Random& random) {
       return boxAround(randomVector(random, -1, 1) * 100.0,
                        random.logUniform(1e-3, 1e3) * randomVector(random, 0.1, 1));
     }},
    {"rods",
     [](std::size_t i, Random& random) {
       Eigen::Vector3d sides = Eigen::Vector3d::Constant(0.1);
       sides[int(i % 3)] = random.uniform(5.0, 15.0);
       return boxAround(randomVector(random, -40, 40), sides);
     }},
    {"near the largest float",
     [](std::size_t, Random& random) {
       return boxAround(randomVector(random, -1e38, 1e38), randomVector(random, 0, 1e37));
     }},
    {"far from the origin",
     [](std::size_t, Random& random) {
       return boxAround(Eigen::Vector3d(5e5, -4e6, 1e3) + randomVector(random, -50, 50), randomVector(random, 0, 1));
     }},
    {"tiny",
     [](std::size_t, Random& random) {
       return boxAround(randomVector(random, -1e-30, 1e-30), randomVector(random, 0, 1e-31));
     }},
};

TEST(QueryTree, ChangesNoAnswer) {
  for (const auto& world : kWorlds) {
    for (const std::size_t count : {1, 15, 16, 17, 256, 257, 511, 513, 3000}) {
      Random random(static_cast<unsigned>(count));
      std::vector<Aabb> boxes;
      for (std::size_t i = 0; i < count; ++i) boxes.push_back(world.second(i, random));
      test::BruteForce brute_force;
      brute_force.update(allIds(count), boxes);
      const Answers expected = answersOf(brute_force, boxes, 1);
      for (const Isa isa : test::supportedIsas()) {
        SCOPED_TRACE(world.first + (", boxes: " + std::to_string(count)) + ", " + name(isa));
        HGrid grid;
        grid.setIsa(isa);
        grid.update(allIds(count), boxes);
        grid.prepareQueries();
        ASSERT_NO_THROW(grid.checkInvariants());
        ASSERT_TRUE(answersOf(grid, boxes, 1) == expected);
      }
    }
  }
}

TEST(QueryTree, ChangesNoAnswerOfManyBoxes) {
  constexpr std::size_t kCount = 40000;
  for (const auto& world : kWorlds) {
    if (world.first == std::string("all equal")) continue;  // each query would find all boxes
    SCOPED_TRACE(world.first);
    Random random(5);
    std::vector<Aabb> boxes;
    for (std::size_t i = 0; i < kCount; ++i) boxes.push_back(world.second(i, random));
    HGrid grid;
    grid.update(allIds(kCount), boxes);
    const Answers expected = answersOf(grid, boxes, 2, 20);
    for (const Isa isa : test::supportedIsas()) {
      grid.setIsa(isa);
      grid.prepareQueries();
      ASSERT_TRUE(answersOf(grid, boxes, 2, 20) == expected) << name(isa);
    }
    ASSERT_NO_THROW(grid.checkInvariants());
  }
}

TEST(QueryTree, FindsAllBoxesOfAnInfiniteQuery) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const Isa isa : test::supportedIsas()) {
    for (const std::size_t count : {1, 20, 700, 9000}) {
      SCOPED_TRACE(name(isa) + (", boxes: " + std::to_string(count)));
      Random random(1);
      std::vector<Aabb> boxes;
      for (std::size_t i = 0; i < count; ++i) {
        boxes.push_back(boxAround(randomVector(random, -50, 50), randomVector(random, 0, 1)));
      }
      HGrid grid;
      grid.setIsa(isa);
      grid.update(allIds(count), boxes);
      grid.prepareQueries();
      const Eigen::Vector3f all = Eigen::Vector3f::Constant(kInfinity);
      const Eigen::Vector3d origin = Eigen::Vector3d::Zero(), far = Eigen::Vector3d::Constant(1e39);
      EXPECT_EQ(test::foundBy(grid, Aabb{-all, all}), allIds(count));
      EXPECT_EQ(test::foundBy(grid, Sphere{origin, double(kInfinity)}), allIds(count));
      EXPECT_EQ(test::foundBy(grid, Sphere{far, 2e39}), allIds(count));
      EXPECT_EQ(test::alongOf(grid, Segment{origin, Eigen::Vector3d::UnitX(), double(kInfinity)}).size(), count);
      EXPECT_EQ(test::foundBy(grid, Aabb{all, all}), std::vector<ProxyId>{});
    }
  }
}

/// Returns a random vector. Its components have all magnitudes up to `most`, also magnitudes that are too small or too
/// large for float. Some are 0.
Eigen::Vector3d anyVector(Random& random, double most = 3e38) {
  Eigen::Vector3d vector;
  for (int axis = 0; axis < 3; ++axis) {
    const double size = random.chance(0.2) ? 0.0 : random.logUniform(1e-60, most);
    vector[axis] = random.chance(0.5) ? -size : size;
  }
  return vector;
}

/// Claim: whatever the magnitudes of boxes and queries, the answers are those of brute force, although trees compute in
/// float.
TEST(QueryTree, ChangesNoAnswerToQueriesOfAnySize) {
  for (const std::size_t count : {3, 30, 600}) {
    Random random(static_cast<unsigned>(count));
    std::vector<Aabb> boxes;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3f a = anyVector(random).cast<float>(), b = anyVector(random).cast<float>();
      boxes.push_back({a.cwiseMin(b), a.cwiseMax(b)});
    }
    test::BruteForce brute_force;
    brute_force.update(allIds(count), boxes);
    for (const Isa isa : test::supportedIsas()) {
      HGrid grid;
      grid.setIsa(isa);
      grid.update(allIds(count), boxes);
      grid.prepareQueries();
      for (int i = 0; i < 2000; ++i) {
        SCOPED_TRACE(name(isa) + (", boxes: " + std::to_string(count)) + ", query " + std::to_string(i));
        const double most = random.logUniform(1e-40, 1e39),
                     radius = random.chance(0.3) ? 0.0 : random.logUniform(1e-42, most);
        const Eigen::Vector3d from = anyVector(random, most);
        const Eigen::Vector3d to = random.chance(0.3) ? from : Eigen::Vector3d(from + anyVector(random, most));
        const Sphere sphere{from, radius};
        ASSERT_EQ(test::foundBy(grid, sphere), test::foundBy(brute_force, sphere));
        const Segment segment{from, to, radius};
        ASSERT_EQ(test::idsAlong(grid, segment), test::idsAlong(brute_force, segment));
      }
    }
  }
}

TEST(QueryTree, IsUsedOnlyWhileItsLayerDoesNotChange) {
  Random random(7);
  std::vector<Aabb> boxes;
  for (int i = 0; i < 500; ++i) boxes.push_back(boxAround(randomVector(random, -5, 5), randomVector(random, 0, 1)));
  HGrid grid;
  test::BruteForce brute_force;
  std::vector<ProxyId> fixed;
  for (ProxyId id = 0; id < 200; ++id) fixed.push_back(id);
  grid.setFixed(fixed);
  grid.update(allIds(500), boxes);
  brute_force.update(allIds(500), boxes);
  for (int step = 0; step < 600; ++step) {
    const auto id = ProxyId(random.below(500));
    const bool stored = brute_force.boxes().count(id) != 0;
    if (stored && random.chance(0.2)) {
      grid.remove(id);
      brute_force.remove(id);
    } else {
      boxes[id] = boxAround(randomVector(random, -5, 5), randomVector(random, 0, 1));
      for (BroadPhase* one : {static_cast<BroadPhase*>(&grid), static_cast<BroadPhase*>(&brute_force)}) {
        stored ? one->update(id, boxes[id]) : one->insert(id, boxes[id]);
      }
    }
    if (random.chance(0.3)) grid.prepareQueries();
    ASSERT_TRUE(answersOf(grid, boxes, unsigned(step), 5) == answersOf(brute_force, boxes, unsigned(step), 5)) << step;
    if (step % 50 == 0) {
      ASSERT_NO_THROW(grid.checkInvariants());
    }
  }
}

TEST(QueryTree, CanBeBuiltWhileOtherThreadsAsk) {
  Random random(8);
  std::vector<Aabb> boxes;
  for (int i = 0; i < 3000; ++i) boxes.push_back(boxAround(randomVector(random, -8, 8), randomVector(random, 0, 1)));
  test::BruteForce brute_force;
  brute_force.update(allIds(boxes.size()), boxes);
  const Answers expected = answersOf(brute_force, boxes, 3);
  for (int round = 0; round < 20; ++round) {
    HGrid grid;
    grid.update(allIds(boxes.size()), boxes);
    std::atomic<int> right{0};
    std::vector<std::thread> threads;
    for (int i = 0; i < 3; ++i) {
      threads.emplace_back([&, i] {
        if (i > 0) grid.prepareQueries();
        right += answersOf(grid, boxes, 3) == expected ? 1 : 0;
      });
    }
    for (std::thread& thread : threads) thread.join();
    ASSERT_EQ(right, 3);
  }
}

}  // namespace
}  // namespace hgrid
