// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <boost/shared_ptr.hpp>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>

#include "node/time/clock_watch.h"
#include "node/wire/message_bytes.h"

namespace hgrid {

/// A message of a tracker that has been received but not read yet.
struct ReceivedTracks {
  boost::shared_ptr<const MessageBytes> message;
  Moment arrival;
};

/// A queue that passes the messages of one tracker from the threads that receive them to the thread that reads them.
/// The number of bytes in it is bounded: the newest messages stay. Any thread may call any function.
class TrackQueue {
 public:
  /// Bytes that each message counts in addition to its own bytes.
  static constexpr std::size_t kOverhead = 256;

  explicit TrackQueue(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// Appends a message. Removes the oldest ones if the bound is exceeded, but not the appended one.
  /// @returns how many messages were removed
  std::size_t push(ReceivedTracks received);
  /// Removes and returns the oldest message. Waits for it at most this long; nullopt: there is none.
  std::optional<ReceivedTracks> popFor(std::chrono::milliseconds most_time);
  /// Ends the wait of popFor(), now and later.
  void end();
  /// Whether end() was called.
  bool ended() const;

 private:
  const std::size_t most_bytes_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<ReceivedTracks> waiting_;  // guarded by mutex_
  std::size_t bytes_ = 0;               // guarded by mutex_
  bool ended_ = false;                  // guarded by mutex_
};

}  // namespace hgrid
