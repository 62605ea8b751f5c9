// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace hgrid {
namespace test {

/// Calls a function periodically on a separate thread until this object is destroyed. Replaces ros::SteadyTimer: the
/// last call of such a timer may still run after the timer was destroyed.
class Ticker {
 public:
  Ticker(std::chrono::milliseconds period, std::function<void()> function)
      : thread_([this, period, function = std::move(function)] {
          std::unique_lock<std::mutex> lock(mutex_);
          while (!ended_.wait_for(lock, period, [this] { return end_; })) function();
        }) {}
  ~Ticker() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      end_ = true;
    }
    ended_.notify_all();
    thread_.join();
  }

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false;
  std::thread thread_;  // declared last because the thread uses the other members
};

}  // namespace test
}  // namespace hgrid
