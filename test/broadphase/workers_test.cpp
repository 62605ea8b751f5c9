// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/broadphase/workers.h"

#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <stdexcept>
#include <thread>

namespace hgrid {
namespace test {
namespace {

constexpr int kThreads = 3;

/// Runs one job per thread; each job waits for the others, so that every thread has one. The job of `thrower` throws.
template <class Exception>
void runWithThrower(Workers& workers, std::size_t thrower, const Exception& exception) {
  std::atomic<int> inside{0};
  workers.run(kThreads, [&](std::size_t, std::size_t thread) {
    ++inside;
    while (inside < kThreads) std::this_thread::yield();
    if (thread == thrower) throw exception;
  });
}

TEST(Workers, ThrowToTheCallerWhatAJobThrowsInAnyThread) {
  Workers workers(kThreads);
  ASSERT_EQ(workers.threads(), kThreads);
  for (std::size_t thrower = 0; thrower < kThreads; ++thrower) {
    SCOPED_TRACE("thread " + std::to_string(thrower));
    EXPECT_THROW(runWithThrower(workers, thrower, std::runtime_error("of a job")), std::runtime_error);
    EXPECT_THROW(runWithThrower(workers, thrower, std::bad_alloc()), std::bad_alloc);
    EXPECT_THROW(runWithThrower(workers, thrower, 1), int);
    EXPECT_NO_THROW(runWithThrower(workers, kThreads, 1)) << "nothing is left of the last run";
  }
}

TEST(Workers, ReturnOnlyWhenNoThreadUsesTheJobAnyMore) {
  Workers workers(kThreads);
  std::atomic<int> inside{0}, done{0};
  auto job = [&](std::size_t, std::size_t thread) {
    ++inside;
    while (inside < kThreads) std::this_thread::yield();
    if (thread == 0) throw std::runtime_error("of the caller's job");
    std::this_thread::yield();
    ++done;
  };
  EXPECT_THROW(workers.run(kThreads, job), std::runtime_error);
  EXPECT_EQ(done, kThreads - 1);
}

TEST(Workers, OfOneThreadThrowToo) {
  Workers workers(1);
  EXPECT_THROW(workers.run(2, [](std::size_t, std::size_t) { throw std::runtime_error("of a job"); }),
               std::runtime_error);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
