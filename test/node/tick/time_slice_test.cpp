// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/tick/time_slice.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <thread>

namespace hgrid {
namespace test {
namespace {

/// Returns the time slice of the calling thread [ns]; 0 if the system does not tell it.
std::uint64_t slice() {
  std::array<std::uint64_t, 6> attributes{};  // sched_getattr(2): the slice is the fourth number
  return syscall(SYS_sched_getattr, 0, attributes.data(), sizeof attributes, 0) == 0 ? attributes[3] : 0;
}

TEST(TimeSlice, IsShortAlsoForThreadsThatAreCreatedLater) {
  std::uint64_t before = 0, after = 0, inherited = 0;
  int policy = -1, nice_value = -1;
  std::thread([&] {
    ASSERT_EQ(setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), 5), 0);  // only of this thread
    before = slice();
    askForShortTimeSlices();
    after = slice();
    policy = sched_getscheduler(0);
    nice_value = getpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)));
    std::thread([&] { inherited = slice(); }).join();
  }).join();
  EXPECT_EQ(policy, SCHED_OTHER);
  EXPECT_EQ(nice_value, 5);  // it stays
  if (before == 0) GTEST_SKIP() << "this system has no time slices that programs can set";
  EXPECT_EQ(after, 100000u);
  EXPECT_EQ(inherited, 100000u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
