// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/measure/processors.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

namespace hgrid {
namespace bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kRounds = 200000;
constexpr int kTrials = 5;

/// Adds numbers to six independent sums, which uses all adders of a core. A second thread on this core gains nothing.
void addRegisters() {
  std::array<std::uint64_t, 6> sums{1, 2, 3, 4, 5, 6};
  for (int i = 0; i < kRounds; ++i) {
    for (std::uint64_t& sum : sums) {
      sum += 3;
      __asm__ volatile("" : "+r"(sum));  // prevents the compiler from merging two additions
      sum += 5;
      __asm__ volatile("" : "+r"(sum));
    }
  }
}

double msOf(Clock::duration time) { return std::chrono::duration<double, std::milli>(time).count(); }

}  // namespace

double gainOfTwoProcessors() {
  std::atomic<int> asked{0}, answered{0};
  // This thread spins while it waits. Then no trial includes the time that the system needs to wake up a thread.
  std::thread other([&] {
    for (int trial = 1; trial <= kTrials; ++trial) {
      while (asked.load(std::memory_order_acquire) < trial) std::this_thread::yield();
      addRegisters();
      answered.store(trial, std::memory_order_release);
    }
  });
  std::array<double, kTrials> gains;
  for (int trial = 1; trial <= kTrials; ++trial) {
    const Clock::time_point begin = Clock::now();
    asked.store(trial, std::memory_order_release);
    addRegisters();
    while (answered.load(std::memory_order_acquire) < trial) std::this_thread::yield();
    gains[static_cast<std::size_t>(trial - 1)] = msOf(Clock::now() - begin);
  }
  other.join();
  for (double& gain : gains) {
    const Clock::time_point begin = Clock::now();
    addRegisters();
    addRegisters();
    gain = msOf(Clock::now() - begin) / gain;
  }
  std::nth_element(gains.begin(), gains.begin() + kTrials / 2, gains.end());
  return gains[kTrials / 2];
}

}  // namespace bench
}  // namespace hgrid
