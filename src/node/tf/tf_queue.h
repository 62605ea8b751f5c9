// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <boost/shared_ptr.hpp>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "node/health/ledger.h"
#include "node/time/clock_watch.h"
#include "node/wire/message_bytes.h"

namespace hgrid {

/// A message of /tf, /tf_static or ~poses that has been received but not deserialized yet.
struct ReceivedTransforms {
  boost::shared_ptr<const MessageBytes> message;  ///< a tf2_msgs/TFMessage; a message of ~poses is converted into one
  bool is_static = false;
  std::string publisher;
  Moment received;
  bool from_poses = false;  ///< whether it came on ~poses

  /// Returns a description of the message for error sentences, for example "the message on /tf from '/robot'".
  std::string name() const;
};

/// A queue that passes messages of /tf, /tf_static and ~poses from the thread that receives them to the tick thread.
/// The number of bytes in it is bounded.
///
/// The bound applies to each topic separately. So a flood on one topic removes no message of another, such as a static
/// transform, which is sent only once.
/// When the messages of a topic exceed the bound, the oldest of them are dropped. Any thread may call any function.
class TfQueue {
 public:
  /// Bytes that each message counts in addition to its own bytes and its publisher's name.
  static constexpr std::size_t kOverhead = 256;

  /// @param most_bytes  bound for each topic; a single message that is longer is refused
  TfQueue(std::size_t most_bytes, Ledger& ledger) : most_bytes_(most_bytes), ledger_(ledger) {}

  /// Appends a message. Counts and logs the messages that it drops or refuses.
  void push(ReceivedTransforms transforms);
  /// Removes and returns the message that was received first. Empty: the queue is empty.
  std::optional<ReceivedTransforms> pop();
  bool empty() const;

 private:
  struct Lane {
    std::deque<ReceivedTransforms> waiting;
    std::size_t bytes = 0;
  };
  std::vector<ReceivedTransforms> store(ReceivedTransforms transforms);
  static ReceivedTransforms takeOldest(Lane& lane);
  Lane& laneOf(const ReceivedTransforms& transforms) {
    return transforms.is_static ? static_ : transforms.from_poses ? poses_ : moving_;
  }

  std::size_t most_bytes_;
  Ledger& ledger_;
  mutable std::mutex mutex_;
  Lane moving_, static_, poses_;
};

}  // namespace hgrid
