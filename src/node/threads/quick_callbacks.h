// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/callback_queue_interface.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>

namespace hgrid {

/// A callback queue that runs a short callback at once, in the thread that adds it, and passes all others to another
/// queue. The thread that adds a callback is usually the one that receives. A callback that would take long throws
/// TakesLong; then the other queue runs it again.
///
/// Waking a thread can take longer than a short query. If all processors are busy, it takes milliseconds.
///
/// A callback runs at once only if no callback that was passed on is waiting or running. Otherwise two threads could
/// wait for each other, because roscpp locks two mutexes of a connection in both orders:
/// - The receiving thread locks the mutex of the transport in TransportTCP::socketUpdate() and runs the callback. The
///   callback writes its answer, for which it locks the mutex of the write callback.
/// - A thread that has just written an answer locks the mutex of the write callback at the end of
///   Connection::writeTransport(). Then it locks the mutex of the transport.
class QuickCallbacks : public ros::CallbackQueueInterface {
 public:
  /// No callback runs at once within this time after another one. Otherwise a client that sends requests without
  /// waiting for the answers would keep the receiving thread busy, because roscpp reads as long as there are requests.
  static constexpr std::chrono::microseconds kPause{20};

  /// @param others  the queue that callbacks are passed to; it must outlive this object
  explicit QuickCallbacks(ros::CallbackQueueInterface& others) : others_(others) {}

  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t owner) override;
  /// Removes the callbacks that were passed on. roscpp calls this after it closed the connections of the owner. Closing
  /// a connection waits until a callback that runs at once has ended.
  void removeByID(std::uint64_t owner) override { others_.removeByID(owner); }
  /// Runs no further callback at once, and waits for the one that is running.
  void stop();

 private:
  using Clock = std::chrono::steady_clock;
  class Passed;

  bool run(ros::CallbackInterface& callback);

  ros::CallbackQueueInterface& others_;
  const std::shared_ptr<std::atomic<int>> passed_ = std::make_shared<std::atomic<int>>(0);  // number that waits or runs
  std::recursive_mutex mutex_;  // recursive, because a callback can add another one
  bool stopped_ = false;        // guarded by mutex_, as all members below
  bool running_ = false;        // whether a callback is running at once
  Clock::time_point ended_;     // when the last such callback ended
};

}  // namespace hgrid
