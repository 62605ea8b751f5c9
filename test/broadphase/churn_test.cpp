// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <fstream>

#include "test/broadphase/churn_world.h"

namespace hgrid {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMegabyte = 1u << 20;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kMemoryIsOurs = false;  // a sanitizer keeps what is freed, and books of its own
#else
constexpr bool kMemoryIsOurs = true;
#endif

/// [bytes] Resident set of this process.
std::size_t residentBytes() {
  std::ifstream statm("/proc/self/statm");
  std::size_t all = 0, resident = 0;
  statm >> all >> resident;
  return resident * std::size_t(sysconf(_SC_PAGESIZE));
}

/// What a grid may keep for a world of so many ids: nothing of it may depend on how long it has been in use.
std::size_t bytesFor(std::size_t ids) { return 200 * ids + kMegabyte / 4; }

/// Claim: whatever comes, goes, moves and changes, and for however long, pairs and answers are those of a look at all
/// boxes, and memory is that of the largest world. HGRID_TEST_CHURN says for how many seconds.
TEST(HGridChurn, StaysRightAndFlat) {
  const std::chrono::seconds duration(std::max(1, test::countFromEnvironment("HGRID_TEST_CHURN", 3)));
  const auto begin = Clock::now();
  test::Random random(1);
  test::ChurnWorld world(2);
  std::size_t most_bytes = 0, rounds = 0, checks = 0;
  std::array<std::size_t, 10> resident_in{};  // most in each tenth of the run
  for (; rounds < 4 || Clock::now() - begin < duration; ++rounds) {
    const bool large = rounds < 4 || random.chance(0.02);  // large enough to be shared among threads
    world.begin(large ? 40000 : std::size_t(random.logUniform(100, 4000)));
    for (int i = large ? 3 : 25; i > 0 && (rounds < 4 || Clock::now() - begin < duration); --i, ++checks) {
      SCOPED_TRACE("round " + std::to_string(rounds) + ", deed " + std::to_string(world.deeds()));
      for (int deeds = random.between(1, 4); deeds > 0; --deeds) world.act();
      ASSERT_NO_FATAL_FAILURE(world.check());
      most_bytes = std::max(most_bytes, world.grid().bytes());
      ASSERT_LE(most_bytes, bytesFor(world.mostBoxes()));
    }
    const std::size_t resident = residentBytes();
    const auto tenth = std::size_t(10 * (Clock::now() - begin) / duration);
    std::size_t& most = resident_in[rounds < 4 ? 0 : std::min<std::size_t>(tenth, 9)];
    most = std::max(most, resident);
    if (kMemoryIsOurs) {
      ASSERT_LE(resident, resident_in[0] + 16 * kMegabyte) << "round " << rounds;
    }
  }
  EXPECT_GT(world.pairsSeen(), checks) << "a comparison of two empty lists proves nothing";
  std::printf("%zu rounds, %zu deeds, %zu comparisons, %zu pairs; at most %zu kB in the grid; resident by tenths:",
              rounds, world.deeds(), checks, world.pairsSeen(), most_bytes / 1024);
  for (const std::size_t resident : resident_in) std::printf(" %.1f", double(resident) / kMegabyte);
  std::printf(" MB\n");
}

}  // namespace
}  // namespace hgrid
