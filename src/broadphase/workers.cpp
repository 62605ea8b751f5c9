// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/workers.h"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace hgrid {

struct Workers::State {
  std::mutex mutex;
  std::condition_variable wake, done;
  void (*call)(void*, std::size_t) = nullptr;
  void* job = nullptr;
  std::size_t count = 0;
  std::atomic<std::size_t> next{0};
  std::size_t round = 0;
  std::size_t busy = 0;
  bool stop = false;
  std::vector<std::thread> threads;

  void work() {
    for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) call(job, i);
  }

  void live() {
    std::size_t seen = 0;
    std::unique_lock<std::mutex> lock(mutex);
    for (;;) {
      wake.wait(lock, [&] { return stop || round != seen; });
      if (stop) return;
      seen = round;
      lock.unlock();
      work();
      lock.lock();
      if (--busy == 0) done.notify_one();
    }
  }
};

Workers::Workers(int threads) : state_(std::make_unique<State>()) {
  for (int i = 1; i < threads; ++i) state_->threads.emplace_back([this] { state_->live(); });
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
    s.busy = s.threads.size();
    ++s.round;
  }
  s.wake.notify_all();
  s.work();
  std::unique_lock<std::mutex> lock(s.mutex);
  s.done.wait(lock, [&s] { return s.busy == 0; });
}

}  // namespace hgrid
