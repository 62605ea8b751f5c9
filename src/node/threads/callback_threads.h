// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/callback_queue.h>
#include <ros/common.h>
#include <ros/init.h>
#include <ros/node_handle.h>

#include <algorithm>
#include <atomic>
#include <boost/make_shared.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace hgrid {

/// A callback queue with its own threads. All callbacks of its two node handles run on these threads only.
class CallbackThreads {
 public:
  CallbackThreads(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
      : node_(node), private_node_(private_node) {
    node_.setCallbackQueue(&queue_);
    private_node_.setCallbackQueue(&queue_);
  }
  ~CallbackThreads() { stop(); }

  const ros::NodeHandle& node() const { return node_; }
  const ros::NodeHandle& privateNode() const { return private_node_; }

  /// Sets the number of threads that run the callbacks; it begins with 0. If it falls, waits until the surplus threads
  /// have ended their callbacks, and up to kLongestWait more. Any thread except those of this object may call this.
  /// @throws std::exception if the system cannot create the threads; their number then stays
  void setThreads(std::uint32_t threads) {
    const std::lock_guard<std::mutex> lock(servers_mutex_);
    if (stopping_) return;
    const std::size_t before = servers_.size();
    try {
      wanted_ = std::max(wanted_.load(), threads);
      while (servers_.size() < threads) {
        servers_.emplace_back([this, number = static_cast<std::uint32_t>(servers_.size())] { serve(number); });
      }
    } catch (...) {
      endServers(before);
      throw;
    }
    endServers(threads);
  }
  /// Starts one thread that runs the callbacks, and calls `work` after each round of them.
  /// @param begin  the thread calls it first; it must not throw
  /// @param work   returns how long the thread may wait for the next callback; it must not throw
  void startLoop(std::function<void()> begin, std::function<std::chrono::nanoseconds()> work) {
    loop_ = std::thread([this, begin = std::move(begin), work = std::move(work)] {
      begin();
      std::chrono::nanoseconds wait{0};
      while (mayRun()) {
        queue_.callAvailable(ros::WallDuration(std::chrono::duration<double>(wait).count()));
        wait = work();
      }
    });
  }
  /// Ends the wait of the thread of startLoop(). Any thread may call this. Does nothing if there is no memory for it;
  /// then the wait ends by itself.
  void wake() noexcept {
    if (woken_.exchange(true)) return;
    try {
      queue_.addCallback(boost::make_shared<Wake>(woken_));
    } catch (const std::exception&) {
      woken_ = false;
    }
  }
  /// Starts no further callbacks, and waits for those that are running.
  void stop() {
    stopping_ = true;
    queue_.disable();  // ends all waits
    {
      const std::lock_guard<std::mutex> lock(servers_mutex_);
      endServers(0);
    }
    if (loop_.joinable()) loop_.join();
  }

 private:
  /// [s] A thread that has no callback to run waits for this long before it looks whether it must end. Threads of
  /// ros::AsyncSpinner wait for 0.1 s, which was a third to a half of the processor time of an idle node.
  static constexpr double kLongestWait = 1.0;

  /// A callback that only ends a wait.
  struct Wake : ros::CallbackInterface {
    explicit Wake(std::atomic<bool>& flag) : woken(flag) {}
    CallResult call() override {
      woken = false;
      return Success;
    }
    std::atomic<bool>& woken;
  };

  /// False from the beginning of the shutdown. A publisher that was advertised after that is invalid, and without
  /// NDEBUG roscpp ends a process that publishes with it.
  bool mayRun() const { return !stopping_ && node_.ok() && !ros::isShuttingDown(); }
  /// Runs callbacks until there must be at most `number` threads.
  void serve(std::uint32_t number) {
    ros::disableAllSignalsInThisThread();
    while (mayRun() && number < wanted_) queue_.callOne(ros::WallDuration(kLongestWait));
  }
  /// Ends all threads but the first `left`. The calling thread must have locked servers_mutex_.
  void endServers(std::size_t left) {
    wanted_ = static_cast<std::uint32_t>(left);
    for (; servers_.size() > left; servers_.pop_back()) servers_.back().join();
  }

  std::atomic<bool> stopping_{false}, woken_{false};
  std::atomic<std::uint32_t> wanted_{0};  // number of threads that run callbacks
  ros::CallbackQueue queue_;
  ros::NodeHandle node_, private_node_;
  std::mutex servers_mutex_;
  std::vector<std::thread> servers_;  // guarded by servers_mutex_
  std::thread loop_;
};

}  // namespace hgrid
