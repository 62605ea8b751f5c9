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

/// A message of /tf or /tf_static that nobody has read yet.
struct ReceivedTransforms {
  boost::shared_ptr<const TransformBytes> message;
  bool is_static = false;
  std::string publisher;
  Moment received;

  /// As in "the message on /tf from '/robot'".
  std::string name() const;
};

/// Stores messages of /tf and /tf_static between the thread that receives them and the tick thread, up to a number of
/// bytes.
///
/// Each topic has the whole bound to itself, so that a flood on /tf removes no static transform, which comes only once.
/// When a topic's messages exceed the bound, its oldest ones are dropped. Any thread may call any function.
class TfQueue {
 public:
  /// Bytes that a message counts for, beside its own and those of its publisher's name.
  static constexpr std::size_t kOverhead = 256;

  /// @param most_bytes  bound for each topic; a message that is longer by itself is refused
  TfQueue(std::size_t most_bytes, Ledger& ledger) : most_bytes_(most_bytes), ledger_(ledger) {}

  /// Appends a message. Counts and logs what it drops or refuses.
  void push(ReceivedTransforms transforms);
  /// Removes the message that was received first; nothing if the queue is empty.
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
