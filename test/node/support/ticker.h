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

/// Calls a function again and again, on a thread of its own, until it is destroyed. Not a ros::SteadyTimer: the last
/// call of that may outlive it.
class Ticker {
 public:
  Ticker(std::chrono::milliseconds period, std::function<void()> deed)
      : thread_([this, period, deed = std::move(deed)] {
          std::unique_lock<std::mutex> lock(mutex_);
          while (!ended_.wait_for(lock, period, [this] { return end_; })) deed();
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
  std::thread thread_;  // last: it uses the others
};

}  // namespace test
}  // namespace hgrid
