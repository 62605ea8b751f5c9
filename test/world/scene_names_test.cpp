// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "test/support/random.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kFreedMemoryIsReused = false;  // a sanitizer keeps freed memory
#else
constexpr bool kFreedMemoryIsReused = true;
#endif

/// Returns the resident memory [bytes] of this process.
std::size_t memoryInUse() {
  std::ifstream statm("/proc/self/statm");
  std::size_t all = 0, resident = 0;
  statm >> all >> resident;
  return resident * std::size_t(sysconf(_SC_PAGESIZE));
}

/// Claim: nothing is left of names that are gone. A million bodies come and go, each with a name of its own. Memory
/// depends only on the largest world so far.
TEST(SceneNames, AMillionThatComeAndGoLeaveNothingBehind) {
  constexpr int kAtOnce = 10000;
  constexpr int kSettling = 10;  // rounds after which memory no longer grows
  const int rounds = test::countFromEnvironment("HGRID_TEST_WORLDS", 10000) < 10000 ? 40 : 100;
  SceneOptions options;
  options.margin = 0.0;
  Scene scene(options);
  std::vector<BodyId> ids;
  std::size_t settled = 0;
  for (int round = 0; round < rounds; ++round) {
    std::vector<Body> bodies;
    for (int i = 0; i < kAtOnce; ++i) {
      bodies.push_back(test::ball("a name of its own " + std::to_string(round * kAtOnce + i), 0.1));
    }
    ids = scene.exchange(ids, std::move(bodies));
    for (int i = 0; i < kAtOnce; ++i) scene.place(ids[std::size_t(i)], test::at(i), Time{round + 1});
    const auto snapshot = scene.commit(Time{round + 1}, {});
    ASSERT_EQ(snapshot->structure().bodies.size(), std::size_t(kAtOnce));
    if (round == kSettling) settled = memoryInUse();
  }
  EXPECT_EQ(scene.size(), std::size_t(kAtOnce));
  if (kFreedMemoryIsReused) {
    EXPECT_LE(memoryInUse(), settled + (16u << 20));
  }
}

}  // namespace
}  // namespace hgrid
