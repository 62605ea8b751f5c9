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

#include "node/diagnostics/ledger.h"
#include "node/time/clock_watch.h"
#include "node/wire/transform_bytes.h"

namespace hgrid {

/// A message of /tf or /tf_static that has been received but not deserialized yet.
struct ReceivedTransforms {
  boost::shared_ptr<const TransformBytes> message;
  bool is_static = false;
  std::string publisher;
  Moment received;

  /// Returns a description of the message for error sentences, for example "the message on /tf from '/robot'".
  std::string name() const;
};

/// A queue that passes messages of /tf and /tf_static from the thread that receives them to the tick thread. The number
/// of bytes in it is bounded.
///
/// The bound applies to each topic separately. So a flood on /tf removes no static transform, which is sent only once.
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

  std::size_t most_bytes_;
  Ledger& ledger_;
  mutable std::mutex mutex_;
  Lane moving_, static_;
};

}  // namespace hgrid
