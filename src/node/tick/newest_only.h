// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <condition_variable>
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
    changed_.notify_one();
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
    }
    changed_.notify_one();
    return next.has_value();
  }

 private:
  void run() {
    for (;;) {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return ends_ || waiting_; });
      if (ends_) return;
      const Value value = std::move(*waiting_);
      waiting_.reset();
      lock.unlock();
      work_(value);
    }
  }

  std::function<void(const Value&)> work_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Value> waiting_;  // guarded by mutex_
  bool ends_ = false;             // guarded by mutex_
  std::thread thread_;            // declared last, because it uses the members above
};

}  // namespace hgrid
