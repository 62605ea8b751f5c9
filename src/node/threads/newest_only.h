// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace hgrid {

/// A thread that works on the newest value that it received. If the next value arrives before the work on a value has
/// begun, the older value is dropped.
template <class Value>
class NewestOnly {
 public:
  /// @param work  called on the thread for each value that is not dropped; must not throw
  explicit NewestOnly(std::function<void(const Value&)> work) : work_(std::move(work)), thread_([this] { run(); }) {}
  /// Waits until the work that has begun is done. Drops a value that still waits.
  ~NewestOnly() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ends_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  NewestOnly(const NewestOnly&) = delete;
  NewestOnly& operator=(const NewestOnly&) = delete;

  /// Passes a value to the thread. Never waits for the work. Any thread may call this.
  /// @returns whether an older value was dropped
  bool give(Value value) {
    std::optional<Value> next(std::move(value));
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      std::swap(next, waiting_);
      ++given_;
    }
    changed_.notify_all();
    return next.has_value();
  }
  /// Waits until the work on all values passed before this call is done. If a value was dropped, waits for the value
  /// that replaced it. Any thread may call this, except the thread that works. No call may be in progress when the
  /// destructor starts.
  void wait() {
    std::unique_lock<std::mutex> lock(mutex_);
    const std::uint64_t given = given_;
    changed_.wait(lock, [this, given] { return done_ >= given; });
  }

 private:
  void run() {
    std::unique_lock<std::mutex> lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return ends_ || waiting_; });
      if (ends_) return;
      const std::uint64_t given = given_;
      {
        const Value value = std::move(*waiting_);
        waiting_.reset();
        lock.unlock();
        work_(value);
      }
      lock.lock();
      done_ = given;
      changed_.notify_all();
    }
  }

  std::function<void(const Value&)> work_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Value> waiting_;  // guarded by mutex_
  std::uint64_t given_ = 0;       // number of values that were passed; guarded by mutex_
  std::uint64_t done_ = 0;        // given_ when the thread took the value that it finished last; guarded by mutex_
  bool ends_ = false;             // guarded by mutex_
  std::thread thread_;            // declared last, because it uses the members above
};

}  // namespace hgrid
