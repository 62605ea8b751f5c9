// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// This test is a separate program, because it replaces operator new for the whole program.
#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "test/support/grids.h"
#include "test/support/scenes.h"

namespace {
std::atomic<std::size_t> allocations{0};
std::atomic<std::size_t> fails_at{0};            // the allocation with this number throws bad_alloc; 0: none throws
std::atomic<std::size_t> held{0}, most_held{0};  // [bytes] allocated memory now, and its maximum so far

void* counted(std::size_t size) {
  if (++allocations == fails_at) throw std::bad_alloc();
  void* const memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  const std::size_t now = held += malloc_usable_size(memory);
  for (std::size_t most = most_held; now > most && !most_held.compare_exchange_weak(most, now);) {
  }
  return memory;
}

void giveBack(void* memory) {
  held -= malloc_usable_size(memory);
  std::free(memory);
}
}  // namespace

__attribute__((noinline)) void* operator new(std::size_t size) { return counted(size); }
__attribute__((noinline)) void* operator new[](std::size_t size) { return counted(size); }
__attribute__((noinline)) void operator delete(void* memory) noexcept { giveBack(memory); }
__attribute__((noinline)) void operator delete[](void* memory) noexcept { giveBack(memory); }
__attribute__((noinline)) void operator delete(void* memory, std::size_t) noexcept { giveBack(memory); }
__attribute__((noinline)) void operator delete[](void* memory, std::size_t) noexcept { giveBack(memory); }

namespace hgrid {
namespace {

constexpr int kWarmUp = 70, kFrames = 130;

/// Returns boxes of various sizes at random positions in a cube.
std::vector<Aabb> hallOf(std::size_t count, test::Random& random) {
  std::vector<Aabb> boxes;
  const double half = 0.5 * std::cbrt(double(count));
  while (boxes.size() < count) {
    const Eigen::Vector3d center = test::randomVector(random, -half, half);
    boxes.push_back(test::boxAround(center, random.logUniform(0.2, 2) * test::randomVector(random, 0.3, 1)));
  }
  return boxes;
}

/// Selects the boxes that move: one in every `among` boxes. If `in_turn` is true, different boxes move in each step;
/// otherwise the same boxes move in all steps.
struct Motion {
  const char* name;
  std::size_t among;
  bool in_turn;
};

/// Returns the number of calls of operator new in `kFrames` steps, after `kWarmUp` steps that do not count.
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
  EXPECT_GT(met, count) << "too few pairs for a meaningful test";
  return counted;
}

/// Claim: after some steps, a bulk update and the following search for pairs allocate no memory.
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

/// Claim: after some ticks, Scene::commit() allocates no memory if the earlier snapshots have been released.
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
  EXPECT_GT(events, 1000u) << "too few events to test that events allocate no memory";
  EXPECT_EQ(allocations - before, 0u);
}

/// Returns the largest additional memory [bytes] that the program had allocated at any time while `work` ran.
template <class Work>
std::size_t peakOf(Work&& work) {
  const std::size_t before = held;
  most_held = before;
  work();
  return most_held - before;
}

constexpr std::size_t kMegabyte = 1 << 20;

std::vector<ProxyId> idsOf(const std::vector<Aabb>& boxes) {
  std::vector<ProxyId> ids;
  for (ProxyId id = 0; id < boxes.size(); ++id) ids.push_back(id);
  return ids;
}

/// Claim: a bounded search in a pile of 40,000 boxes (800 million pairs, 6 GB) needs little memory, even if most boxes
/// rest.
TEST(Allocation, ABoundedSearchTakesBoundedMemory) {
  const std::vector<Aabb> boxes(40000, test::boxAround(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()));
  std::vector<Aabb> moved = boxes;
  for (std::size_t i = 0; i < boxes.size(); i += 100) moved[i].max.x() += 0.1f;
  for (const int threads : {1, 3}) {
    HGrid grid;
    grid.setThreads(threads);
    grid.setPairBound({10000, 100000});
    std::vector<ProxyPair> pairs;
    grid.update(idsOf(boxes), boxes);
    const std::size_t peak = peakOf([&] {
      for (int tick = 0; tick < 3; ++tick) {
        EXPECT_FALSE(grid.boundedPairs(pairs));
        grid.update(idsOf(boxes), tick % 2 == 0 ? moved : boxes);
      }
    });
    EXPECT_EQ(pairs.size(), 10000u);
    EXPECT_LT(peak, 10 * kMegabyte) << threads << " threads";
  }
}

/// Claim: Scene::commit() with 3,000 moving bodies at one place (4.5 million pairs) needs little memory. After some
/// ticks, it allocates no memory.
TEST(Allocation, ATruncatedCommitTakesBoundedMemory) {
  SceneOptions options;
  options.max_pairs = 1000;
  Scene scene(options);
  std::vector<BodyId> bodies;
  for (int i = 0; i < 3000; ++i) bodies.push_back(test::put(scene, test::ball(std::to_string(1000 + i)), test::at(0)));
  const std::vector<SourceGap> gaps;
  std::shared_ptr<const Snapshot> latest;
  std::size_t before = 0;
  const std::size_t peak = peakOf([&] {
    for (int tick = 1; tick <= 30; ++tick) {
      if (tick == 21) before = allocations;
      for (const BodyId id : bodies) scene.place(id, test::at(0.001 * tick), Time{tick});
      latest = scene.commit(Time{tick}, gaps);
    }
  });
  EXPECT_EQ(allocations - before, 0u);
  EXPECT_TRUE(latest->truncated());
  EXPECT_EQ(latest->pairs().size(), 1000u);
  EXPECT_LT(peak, 40 * kMegabyte);
}

/// Claim: if any memory allocation of a search for pairs fails, on any thread, the caller receives std::bad_alloc. The
/// next search finds the same pairs as before.
TEST(Allocation, ASearchForPairsThatFindsNoMemoryCanBeRepeated) {
  test::Random random(9);
  const std::vector<Aabb> boxes = hallOf(40000, random);
  for (const int threads : {1, 2, 4}) {
    std::vector<ProxyPair> expected;
    for (std::size_t failing = 0, failed = 1; failed > 0; ++failing) {
      HGrid grid;
      grid.setThreads(threads);
      grid.update(idsOf(boxes), boxes);
      std::vector<ProxyPair> pairs;
      failed = 0;
      fails_at = failing == 0 ? 0 : allocations + failing;
      try {
        grid.boundedPairs(pairs);
      } catch (const std::bad_alloc&) {
        failed = failing;
      }
      fails_at = 0;
      EXPECT_TRUE(grid.boundedPairs(pairs));
      if (failing == 0) {
        expected = pairs;
        failed = 1;
      }
      ASSERT_TRUE(pairs == expected) << "allocation " << failing << ", threads " << threads;
      EXPECT_TRUE(failed > 0 || failing > 5) << "fewer than 5 allocations were made to fail";
    }
  }
}

}  // namespace
}  // namespace hgrid
