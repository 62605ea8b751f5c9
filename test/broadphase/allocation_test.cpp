// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// A program of its own, since it replaces operator new for all of it.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "test/support/grids.h"
#include "test/support/scenes.h"

namespace {
std::atomic<std::size_t> allocations{0};

void* counted(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
}  // namespace

__attribute__((noinline)) void* operator new(std::size_t size) { return counted(size); }
__attribute__((noinline)) void* operator new[](std::size_t size) { return counted(size); }
__attribute__((noinline)) void operator delete(void* memory) noexcept { std::free(memory); }
__attribute__((noinline)) void operator delete[](void* memory) noexcept { std::free(memory); }
__attribute__((noinline)) void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
__attribute__((noinline)) void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace hgrid {
namespace {

constexpr int kWarmUp = 70, kFrames = 130;

/// Boxes on a hall's floor and shelves.
std::vector<Aabb> hallOf(std::size_t count, test::Random& random) {
  std::vector<Aabb> boxes;
  const double half = 0.5 * std::cbrt(double(count));
  while (boxes.size() < count) {
    const Eigen::Vector3d center = test::randomVector(random, -half, half);
    boxes.push_back(test::boxAround(center, random.logUniform(0.2, 2) * test::randomVector(random, 0.3, 1)));
  }
  return boxes;
}

/// One of `among` boxes moves: always the same ones, or each frame those whose turn it is.
struct Motion {
  const char* name;
  std::size_t among;
  bool in_turn;
};

/// Calls of operator new in `kFrames` frames after some to warm up.
std::size_t allocationsOf(const Motion& motion, std::size_t count, int threads) {
  test::Random random(count + unsigned(threads));
  const std::vector<Aabb> home = hallOf(count, random);
  std::vector<Aabb> boxes = home;
  std::vector<ProxyId> ids;
  for (ProxyId id = 0; id < count; ++id) ids.push_back(id);
  HGrid grid;
  grid.setThreads(threads);
  std::vector<ProxyPair> pairs;
  std::size_t before = 0, met = 0;
  for (int frame = 0; frame < kWarmUp + kFrames; ++frame) {
    if (frame == kWarmUp) before = allocations;
    for (ProxyId id = 0; id < count; ++id) {
      if ((id + (motion.in_turn ? std::size_t(frame) : 0)) % motion.among != 0) continue;
      const Eigen::Vector3f way = test::randomVector(random, -0.3, 0.3).cast<float>();
      boxes[id] = {home[id].min + way, home[id].max + way};
    }
    grid.update(ids, boxes);
    grid.overlappingPairs(pairs);
    met += pairs.size();
  }
  const std::size_t counted = allocations - before;
  EXPECT_GT(met, count) << "a search that finds nothing proves nothing";
  return counted;
}

/// Claim: once its arrays have their size, a bulk update and the search for pairs after it allocate nothing.
TEST(Allocation, ASteadyTickOfTheGridAllocatesNothing) {
  const Motion motions[] = {{"all move", 1, false},
                            {"the same tenth moves", 10, false},
                            {"another tenth moves", 10, true},
                            {"another hundredth moves", 100, true}};
  for (const Motion& motion : motions) {
    EXPECT_EQ(allocationsOf(motion, 1000, 1), 0u) << motion.name << ", 1000 boxes";
    EXPECT_EQ(allocationsOf(motion, 33000, 2), 0u) << motion.name << ", 33000 boxes, 2 threads";
  }
}

/// Claim: so does a commit whose snapshots are given back, however many of them are held at a time.
TEST(Allocation, ASteadyCommitAllocatesNothing) {
  test::Random random(5);
  Scene scene{SceneOptions{}};
  std::vector<BodyId> bodies;
  for (int i = 0; i < 500; ++i) {
    const auto mobility = i % 5 == 0 ? Mobility::fixed : Mobility::moving;
    bodies.push_back(test::put(scene, test::ball(std::to_string(i), 0.3, mobility),
                               test::at(random.uniform(-5, 5), random.uniform(-5, 5))));
  }
  std::shared_ptr<const Snapshot> latest;
  const std::vector<SourceGap> gaps;
  std::size_t before = 0, events = 0;
  for (int tick = 1; tick <= kWarmUp + kFrames; ++tick) {
    if (tick == kWarmUp + 1) before = allocations;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (i % 5 == 0) continue;
      Pose pose = scene.poseOf(bodies[i]).world_from_body;
      pose.translation() += test::randomVector(random, -0.01, 0.01);
      scene.place(bodies[i], pose, Time{tick});
      scene.setState(bodies[i], Freshness::fresh, 0.0);
    }
    latest = scene.commit(Time{tick}, gaps);
    ASSERT_FALSE(latest->pairs().empty());
    events += latest->events().size();
  }
  EXPECT_GT(events, 1000u) << "they take no memory either";
  EXPECT_EQ(allocations - before, 0u);
}

}  // namespace
}  // namespace hgrid
