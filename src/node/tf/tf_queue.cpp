// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/tf_queue.h"

#include <algorithm>
#include <utility>

namespace hgrid {
namespace {

std::size_t chargeOf(const ReceivedTransforms& transforms) {
  return transforms.message->bytes.size() + transforms.publisher.size() + TfQueue::kOverhead;
}

}  // namespace

std::string ReceivedTransforms::name() const {
  return std::string("the message on ") +
         (is_static    ? "/tf_static"
          : from_poses ? "~poses"
                       : "/tf") +
         " from '" + printable(publisher) + "'";
}

void TfQueue::push(ReceivedTransforms transforms) {
  const MessageBytes& message = *transforms.message;
  const std::size_t most_bytes = std::min(most_bytes_, message.most_bytes);
  if (message.size > most_bytes) {
    const std::string rule = " bytes; at most " + std::to_string(most_bytes) + " are accepted (~limits/tf_queue_bytes)";
    const std::string size = std::to_string(message.size);
    return ledger_.refuse("tf.refused", Refusal(Code::limit, transforms.name() + " has " + size + rule));
  }
  for (const ReceivedTransforms& dropped : store(std::move(transforms))) {
    ledger_.refuse(
        "tf.dropped",
        Refusal(Code::limit, dropped.name() + " is dropped: transforms arrive faster than they are read; at most " +
                                 std::to_string(most_bytes_) + " bytes may wait (~limits/tf_queue_bytes)"));
  }
}

/// Appends a message. @returns the messages that were dropped to keep the bound; never the new one
std::vector<ReceivedTransforms> TfQueue::store(ReceivedTransforms transforms) {
  std::vector<ReceivedTransforms> dropped;
  const std::lock_guard<std::mutex> lock(mutex_);
  Lane& lane = laneOf(transforms);
  lane.waiting.push_back(std::move(transforms));
  lane.bytes += chargeOf(lane.waiting.back());
  while (lane.bytes > most_bytes_ && lane.waiting.size() > 1) dropped.push_back(takeOldest(lane));
  return dropped;
}

ReceivedTransforms TfQueue::takeOldest(Lane& lane) {
  ReceivedTransforms oldest = std::move(lane.waiting.front());
  lane.waiting.pop_front();
  lane.bytes -= chargeOf(oldest);
  return oldest;
}

std::optional<ReceivedTransforms> TfQueue::pop() {
  const std::lock_guard<std::mutex> lock(mutex_);
  Lane* first = nullptr;
  for (Lane* lane : {&static_, &moving_, &poses_}) {
    if (lane->waiting.empty()) continue;
    if (first == nullptr || lane->waiting.front().received.steady < first->waiting.front().received.steady)
      first = lane;
  }
  return first == nullptr ? std::nullopt : std::optional<ReceivedTransforms>(takeOldest(*first));
}

bool TfQueue::empty() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return moving_.waiting.empty() && static_.waiting.empty() && poses_.waiting.empty();
}

}  // namespace hgrid
