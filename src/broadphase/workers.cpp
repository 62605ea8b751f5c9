// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/workers.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace hgrid {
namespace {

// A thread that has nothing to do spins for this long before it sleeps. The parts of one bulk update follow each other
// faster than a thread can go to sleep and wake up.
constexpr std::chrono::microseconds kPatience{50};

/// Checks the condition again and again, for at most kPatience. @returns whether it became true
template <class Condition>
bool waitBriefly(Condition&& condition) {
  const auto until = std::chrono::steady_clock::now() + kPatience;
  for (;;) {
    for (int i = 0; i < 64; ++i) {
      if (condition()) return true;
    }
    if (std::chrono::steady_clock::now() > until) return condition();
    std::this_thread::yield();  // lets other threads use the processor
  }
}

}  // namespace

struct Workers::State {
  // Each call of run() is one round. A round is open until the caller finds no more jobs. If a thread wakes up later,
  // it does not enter the round, and the caller does not wait for it. The bits of `round` hold three values: the number
  // of the round, whether the round is open, and how many threads are inside it, without the caller.
  static constexpr std::uint64_t kInside = 0xffff, kOpen = 0x10000, kNumber = ~(kInside | kOpen);

  /// The jobs that one thread starts with: begin .. end - 1. `left` holds `begin` in its lower half and `end` in its
  /// upper half. The thread takes jobs from the front. Threads that have finished their own jobs take jobs from the
  /// back. So one thread mostly runs consecutive jobs, and their data are in its cache.
  struct alignas(64) Share {
    std::atomic<std::uint64_t> left{0};

    void set(std::size_t begin, std::size_t end) {
      left.store(static_cast<std::uint64_t>(end) << 32 | begin, std::memory_order_relaxed);
    }
    template <class Call>
    void workOff(bool from_front, const Call& call) {
      std::uint64_t now = left.load(std::memory_order_relaxed);
      for (;;) {
        const std::uint64_t begin = now & 0xffffffff, end = now >> 32;
        if (begin >= end) return;
        const std::uint64_t then = from_front ? now + 1 : now - (std::uint64_t{1} << 32);
        if (!left.compare_exchange_weak(now, then, std::memory_order_relaxed)) continue;
        call(from_front ? begin : end - 1);
        now = left.load(std::memory_order_relaxed);
      }
    }
  };

  std::mutex mutex;
  std::condition_variable wake, done;
  void (*call)(void*, std::size_t, std::size_t) = nullptr;
  void* job = nullptr;
  std::atomic<std::uint64_t> round{0};
  bool stop = false;
  std::unique_ptr<Share[]> shares;
  std::vector<std::thread> threads;
  std::atomic_flag failed = ATOMIC_FLAG_INIT;  // whether a job of this round has thrown an exception
  std::exception_ptr error;                    // the first exception; written by the thread that set `failed`

  void work(std::size_t self) {
    const std::size_t count = threads.size() + 1;
    try {
      for (std::size_t i = 0; i < count; ++i) {
        shares[(self + i) % count].workOff(i == 0, [&](std::size_t number) { call(job, number, self); });
      }
    } catch (...) {
      if (!failed.test_and_set(std::memory_order_relaxed)) error = std::current_exception();
      for (std::size_t i = 0; i < count; ++i) shares[i].set(0, 0);  // no thread starts another job
    }
  }

  /// Throws the first exception of the round, if there is one. The caller calls this after all threads left the round.
  void rethrow() {
    if (!error) return;
    failed.clear(std::memory_order_relaxed);
    std::rethrow_exception(std::exchange(error, nullptr));
  }

  /// Enters the open round, if there is one. Does not enter a round with the number `seen`, because this thread was in
  /// that round before. @returns whether it entered
  bool enter(std::uint64_t& seen) {
    std::uint64_t now = round.load(std::memory_order_relaxed);
    while ((now & kOpen) != 0 && (now & kNumber) != seen) {
      if (!round.compare_exchange_weak(now, now + 1, std::memory_order_acquire, std::memory_order_relaxed)) continue;
      seen = now & kNumber;
      return true;
    }
    return false;
  }

  void leave() {
    if (((round.fetch_sub(1, std::memory_order_release) - 1) & (kInside | kOpen)) != 0) return;
    const std::lock_guard<std::mutex> lock(mutex);
    done.notify_one();
  }

  void live(std::size_t self) {
    std::uint64_t seen = 0;
    for (;;) {
      if (!waitBriefly([&] { return enter(seen); })) {
        std::unique_lock<std::mutex> lock(mutex);
        wake.wait(lock, [&] { return stop || enter(seen); });
        if (stop) return;
      }
      work(self);
      leave();
    }
  }
};

Workers::Workers(int threads) : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.shares = std::make_unique<State::Share[]>(static_cast<std::size_t>(std::max(threads, 1)));
  s.threads.reserve(static_cast<std::size_t>(std::max(threads, 1)) - 1);
  try {
    for (int i = 1; i < threads; ++i) {
      s.threads.emplace_back([&s, i] { s.live(static_cast<std::size_t>(i)); });
    }
  } catch (const std::exception&) {
    // The system has no thread or no memory left. The threads that were created do all the work.
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

void Workers::runAll(std::size_t count, void (*call)(void*, std::size_t, std::size_t), void* job) {
  State& s = *state_;
  if (s.threads.empty() || count <= 1) {
    for (std::size_t i = 0; i < count; ++i) call(job, i, 0);
    return;
  }
  const std::size_t threads = s.threads.size() + 1;
  {
    const std::lock_guard<std::mutex> lock(s.mutex);
    s.call = call;
    s.job = job;
    for (std::size_t i = 0; i < threads; ++i) s.shares[i].set(count * i / threads, count * (i + 1) / threads);
    const std::uint64_t last = s.round.load(std::memory_order_relaxed) & State::kNumber;
    s.round.store((last + State::kOpen * 2) | State::kOpen, std::memory_order_release);
  }
  s.wake.notify_all();
  s.work(0);
  s.round.fetch_and(~State::kOpen, std::memory_order_relaxed);
  const auto all_left = [&s] { return (s.round.load(std::memory_order_acquire) & State::kInside) == 0; };
  if (!waitBriefly(all_left)) {
    std::unique_lock<std::mutex> lock(s.mutex);
    s.done.wait(lock, all_left);
  }
  s.rethrow();
}

}  // namespace hgrid
