// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/workers.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace hgrid {
namespace {

// The parts of one bulk update follow each other faster than a thread goes to sleep and wakes up.
constexpr std::chrono::microseconds kPatience{50};

/// Waits for a little while. @returns whether the condition came true
template <class Condition>
bool waitBriefly(Condition&& condition) {
  const auto until = std::chrono::steady_clock::now() + kPatience;
  for (;;) {
    for (int i = 0; i < 64; ++i) {
      if (condition()) return true;
    }
    if (std::chrono::steady_clock::now() > until) return condition();
    std::this_thread::yield();  // somebody else may need the processor more
  }
}

}  // namespace

struct Workers::State {
  std::mutex mutex;
  std::condition_variable wake, done;
  void (*call)(void*, std::size_t) = nullptr;
  void* job = nullptr;
  std::size_t count = 0;
  std::atomic<std::size_t> next{0}, round{0}, busy{0};
  bool stop = false;
  std::vector<std::thread> threads;

  void work() {
    for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) call(job, i);
  }

  void live() {
    std::size_t seen = 0;
    for (;;) {
      if (!waitBriefly([&] { return round.load(std::memory_order_acquire) != seen; })) {
        std::unique_lock<std::mutex> lock(mutex);
        wake.wait(lock, [&] { return stop || round.load(std::memory_order_acquire) != seen; });
        if (stop) return;
      }
      ++seen;  // no round begins before all are done with the last
      work();
      if (busy.fetch_sub(1, std::memory_order_acq_rel) == 1) {
        const std::lock_guard<std::mutex> lock(mutex);
        done.notify_one();
      }
    }
  }
};

Workers::Workers(int threads) : state_(std::make_unique<State>()) {
  try {
    for (int i = 1; i < threads; ++i) state_->threads.emplace_back([this] { state_->live(); });
  } catch (const std::system_error&) {
    // The system gives no more; fewer threads do the same work.
  }
}

Workers::~Workers() {
  {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    state_->stop = true;
  }
  state_->wake.notify_all();
  for (std::thread& thread : state_->threads) thread.join();
}

int Workers::threads() const { return static_cast<int>(state_->threads.size()) + 1; }

void Workers::runAll(std::size_t count, void (*call)(void*, std::size_t), void* job) {
  State& s = *state_;
  if (s.threads.empty() || count <= 1) {
    for (std::size_t i = 0; i < count; ++i) call(job, i);
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(s.mutex);
    s.call = call;
    s.job = job;
    s.count = count;
    s.next.store(0, std::memory_order_relaxed);
    s.busy.store(s.threads.size(), std::memory_order_relaxed);
    s.round.fetch_add(1, std::memory_order_release);
  }
  s.wake.notify_all();
  s.work();
  const auto all_done = [&s] { return s.busy.load(std::memory_order_acquire) == 0; };
  if (waitBriefly(all_done)) return;
  std::unique_lock<std::mutex> lock(s.mutex);
  s.done.wait(lock, all_done);
}

}  // namespace hgrid
