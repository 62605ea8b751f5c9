// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <atomic>
#include <boost/make_shared.hpp>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

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

  void start(std::uint32_t threads) {
    const std::lock_guard<std::mutex> lock(spinner_mutex_);
    spinner_ = std::make_unique<ros::AsyncSpinner>(threads, &queue_);
    spinner_->start();
    threads_ = threads;
  }
  /// Replaces the threads of start() by new ones. Waits until the callbacks that the old threads run are done.
  /// Meanwhile the new threads run the other callbacks. Any thread except those of this object may call this.
  /// @throws std::exception if the system cannot create the threads; the old ones then stay
  void resize(std::uint32_t threads) {
    const std::lock_guard<std::mutex> lock(spinner_mutex_);
    if (!spinner_ || stopping_ || threads == threads_) return;
    auto spinner = std::make_unique<ros::AsyncSpinner>(threads, &queue_);
    spinner->start();
    spinner_.swap(spinner);
    threads_ = threads;
  }
  /// Starts one thread that runs the callbacks, and calls `work` after each round of them.
  /// @param begin  the thread calls it first; it must not throw
  /// @param work   returns how long the thread may wait for the next callback; it must not throw
  void startLoop(std::function<void()> begin, std::function<std::chrono::nanoseconds()> work) {
    loop_ = std::thread([this, begin = std::move(begin), work = std::move(work)] {
      begin();
      std::chrono::nanoseconds wait{0};
      while (!stopping_ && node_.ok()) {
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
    {
      const std::lock_guard<std::mutex> lock(spinner_mutex_);
      if (spinner_) spinner_->stop();
    }
    if (!loop_.joinable()) return;
    wake();
    loop_.join();
  }

 private:
  /// A callback that only ends a wait.
  struct Wake : ros::CallbackInterface {
    explicit Wake(std::atomic<bool>& flag) : woken(flag) {}
    CallResult call() override {
      woken = false;
      return Success;
    }
    std::atomic<bool>& woken;
  };

  std::atomic<bool> stopping_{false}, woken_{false};
  ros::CallbackQueue queue_;
  ros::NodeHandle node_, private_node_;
  std::mutex spinner_mutex_;
  std::unique_ptr<ros::AsyncSpinner> spinner_;  // guarded by spinner_mutex_
  std::uint32_t threads_ = 0;                   // guarded by spinner_mutex_
  std::thread loop_;
};

}  // namespace hgrid
