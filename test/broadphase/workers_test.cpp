// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/broadphase/workers.h"

#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace hgrid {
namespace {

constexpr int kThreadCounts[] = {1, 2, 4};

void expectEachJobOnce(Workers& workers, std::size_t count) {
  std::vector<std::atomic<int>> calls(count);
  workers.run(count, [&](std::size_t number, std::size_t) { ++calls[number]; });
  for (std::size_t number = 0; number < count; ++number) EXPECT_EQ(calls[number], 1) << "job " << number;
}

/// Each of the first `threads` jobs waits until every thread has a job. Thus every thread runs exactly one of them.
class MeetingPoint {
 public:
  explicit MeetingPoint(const Workers& workers) : expected_(workers.threads()) {}
  void attend() {
    ++arrived_;
    while (arrived_ < expected_) std::this_thread::yield();
  }

 private:
  const int expected_;
  std::atomic<int> arrived_{0};
};

TEST(Workers, CallEveryJobOnce) {
  for (const int threads : kThreadCounts) {
    Workers workers(threads);
    for (const std::size_t count : {0u, 1u, 2u, 3u, 7u, 64u, 1000u}) expectEachJobOnce(workers, count);
  }
}

TEST(Workers, AnExceptionOfAnyJobReachesTheCallerAndTheNextRoundIsWhole) {
  for (const int threads : kThreadCounts) {
    Workers workers(threads);
    for (const std::size_t count : {1u, 2u, 5u, 40u}) {
      for (std::size_t bad = 0; bad < count; ++bad) {
        SCOPED_TRACE("threads " + std::to_string(threads) + ", job " + std::to_string(bad) + " of " +
                     std::to_string(count));
        std::vector<std::atomic<int>> calls(count);
        std::string caught = "nothing";
        try {
          workers.run(count, [&](std::size_t number, std::size_t) {
            ++calls[number];
            if (number == bad) throw std::runtime_error("job " + std::to_string(number));
          });
        } catch (const std::runtime_error& error) {
          caught = error.what();
        }
        EXPECT_EQ(caught, "job " + std::to_string(bad));
        for (std::size_t number = 0; number < count; ++number) EXPECT_LE(calls[number], 1) << "job " << number;
        expectEachJobOnce(workers, count);
      }
    }
  }
}

TEST(Workers, AnExceptionOnAnyThreadReachesTheCaller) {
  for (const int threads : kThreadCounts) {
    Workers workers(threads);
    const auto count = static_cast<std::size_t>(workers.threads());
    for (std::size_t bad = 0; bad < count; ++bad) {
      SCOPED_TRACE("thread " + std::to_string(bad) + " of " + std::to_string(count));
      MeetingPoint meeting(workers);
      EXPECT_THROW(workers.run(count,
                               [&](std::size_t, std::size_t thread) {
                                 meeting.attend();
                                 if (thread == bad) throw std::bad_alloc();
                               }),
                   std::bad_alloc);
      expectEachJobOnce(workers, 100);
    }
  }
}

TEST(Workers, AnExceptionOnAllThreadsReachesTheCallerOnce) {
  for (const int threads : kThreadCounts) {
    Workers workers(threads);
    for (int round = 0; round < 50; ++round) {
      EXPECT_THROW(
          workers.run(40, [&](std::size_t number, std::size_t) { throw std::runtime_error(std::to_string(number)); }),
          std::runtime_error);
      expectEachJobOnce(workers, 40);
    }
  }
}

/// Claim: when run() throws the exception of a job on the calling thread, no other thread is still running a job.
TEST(Workers, NoJobRunsAnyMoreWhenTheCallerSeesTheException) {
  Workers workers(4);
  for (int round = 0; round < 50; ++round) {
    MeetingPoint meeting(workers);
    std::atomic<bool> thrown{false};
    std::atomic<int> inside{0};
    std::atomic<std::uint64_t> steps{0};
    EXPECT_THROW(workers.run(static_cast<std::size_t>(workers.threads()),
                             [&](std::size_t, std::size_t thread) {
                               ++inside;
                               meeting.attend();
                               if (thread == 0) {
                                 --inside;
                                 thrown = true;
                                 throw std::runtime_error("the caller's own job");
                               }
                               while (!thrown) std::this_thread::yield();
                               for (int i = 0; i < 10000; ++i) ++steps;
                               --inside;
                             }),
                 std::runtime_error);
    EXPECT_EQ(inside, 0);
  }
}

}  // namespace
}  // namespace hgrid
