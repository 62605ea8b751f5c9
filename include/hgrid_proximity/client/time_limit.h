// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace hgrid_proximity {

/// Ends calls that take too long, with a thread of its own. One call can be in progress at a time.
///
/// While calls follow each other, the thread sleeps until the limit of an earlier call, so begin() and end() only lock
/// a mutex.
class TimeLimit {
 public:
  /// @param expire  ends the call in progress; the thread of this object calls it; it must not throw
  explicit TimeLimit(std::function<void()> expire) : expire_(std::move(expire)), thread_([this] { watch(); }) {}
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;
  ~TimeLimit() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stopping_ = true;
    }
    changed_.notify_one();
    thread_.join();
  }

  /// A call begins, which must end within this time.
  void begin(std::chrono::steady_clock::duration limit) {
    const std::lock_guard<std::mutex> lock(mutex_);
    deadline_ = std::chrono::steady_clock::now() + limit;
    expired_ = false;
    if (!wakes_at_ || *deadline_ < *wakes_at_) changed_.notify_one();
  }
  /// The call has ended. @returns whether the limit ended it
  bool end() {
    const std::lock_guard<std::mutex> lock(mutex_);
    deadline_.reset();
    return expired_;
  }

 private:
  void watch() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!stopping_) {
      wakes_at_ = deadline_;
      if (!deadline_) {
        changed_.wait(lock);
      } else if (std::chrono::steady_clock::now() < *deadline_) {
        changed_.wait_until(lock, *wakes_at_);
      } else {
        deadline_.reset();
        expired_ = true;
        expire_();
      }
    }
  }

  const std::function<void()> expire_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<std::chrono::steady_clock::time_point> deadline_;  // of the call in progress
  std::optional<std::chrono::steady_clock::time_point> wakes_at_;  // when the thread wakes by itself
  bool expired_ = false;
  bool stopping_ = false;
  std::thread thread_;  // the last member, because its thread uses the others
};

}  // namespace hgrid_proximity
