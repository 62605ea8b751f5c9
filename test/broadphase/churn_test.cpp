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
constexpr bool kMemoryIsOurs = false;  // a sanitizer keeps freed memory and needs memory for its own data
#else
constexpr bool kMemoryIsOurs = true;
#endif

/// Returns the resident memory [bytes] of this process.
std::size_t residentBytes() {
  std::ifstream statm("/proc/self/statm");
  std::size_t all = 0, resident = 0;
  statm >> all >> resident;
  return resident * std::size_t(sysconf(_SC_PAGESIZE));
}

/// Returns the memory [bytes] that a grid may use for a world with `ids` ids. This limit does not grow with the time
/// for which the grid is used.
std::size_t bytesFor(std::size_t ids) { return 200 * ids + kMegabyte / 4; }

/// Claim: after any number of random changes, pairs and query results equal those of a scan of all boxes. The memory
/// depends only on the largest world so far. HGRID_TEST_CHURN sets the duration of the test [s].
TEST(HGridChurn, StaysRightAndFlat) {
  const std::chrono::seconds duration(std::max(1, test::countFromEnvironment("HGRID_TEST_CHURN", 3)));
  const auto begin = Clock::now();
  test::Random random(1);
  test::ChurnWorld world(2);
  std::size_t most_bytes = 0, rounds = 0, checks = 0;
  std::array<std::size_t, 10> resident_in{};  // [bytes] largest resident memory in each tenth of the test
  for (; rounds < 4 || Clock::now() - begin < duration; ++rounds) {
    const bool large = rounds < 4 || random.chance(0.02);  // so large that the grid uses several threads
    world.begin(large ? 40000 : std::size_t(random.logUniform(100, 4000)));
    for (int i = large ? 3 : 25; i > 0 && (rounds < 4 || Clock::now() - begin < duration); --i, ++checks) {
      SCOPED_TRACE("round " + std::to_string(rounds) + ", change " + std::to_string(world.changes()));
      for (int changes = random.between(1, 4); changes > 0; --changes) world.act();
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
  EXPECT_GT(world.pairsSeen(), checks) << "too few pairs for a meaningful comparison";
  std::printf("%zu rounds, %zu changes, %zu comparisons, %zu pairs; grid at most %zu kB; resident in each tenth:",
              rounds, world.changes(), checks, world.pairsSeen(), most_bytes / 1024);
  for (const std::size_t resident : resident_in) std::printf(" %.1f", double(resident) / kMegabyte);
  std::printf(" MB\n");
}

}  // namespace
}  // namespace hgrid
