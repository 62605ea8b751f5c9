// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/audit/transform_record.h"

#include <algorithm>

namespace hgrid {
namespace {

std::size_t bytesOf(const ReceivedTransforms& message) { return message.message->bytes.size() + TfQueue::kOverhead; }

}  // namespace

void TransformRecord::begins(const ReceivedTransforms& message) {
  reading_ = true;
  if (message.is_static) return keepStatic(message);
  moving_.push_back(std::make_shared<const ReceivedTransforms>(message));
  moving_bytes_ += bytesOf(message);
  while (moving_bytes_ > most_bytes_ || moving_.front()->received.steady < message.received.steady - window_)
    dropOldest();
}

void TransformRecord::ends(bool complete) {
  reading_ = false;
  if (!complete && !moving_.empty()) forgetMoving(moving_.back()->received.ros);
}

void TransformRecord::keepStatic(const ReceivedTransforms& message) {
  const auto last = std::find_if(static_.rbegin(), static_.rend(),
                                 [&](const Message& other) { return other->publisher == message.publisher; });
  if (last != static_.rend() && (*last)->message->bytes == message.message->bytes) return;
  if (static_bytes_ + bytesOf(message) > most_bytes_) {
    overflown_ = true;
    return;
  }
  static_.push_back(std::make_shared<const ReceivedTransforms>(message));
  static_bytes_ += bytesOf(message);
}

void TransformRecord::dropOldest() {
  begin_ = std::max(begin_, moving_.front()->received.ros);
  moving_bytes_ -= bytesOf(*moving_.front());
  moving_.pop_front();
}

void TransformRecord::forgetMoving(Time now) {
  moving_.clear();
  moving_bytes_ = 0;
  begin_ = now;
}

TransformRecord::Content TransformRecord::content() const {
  Content content;
  content.messages.assign(static_.begin(), static_.end());
  content.messages.insert(content.messages.end(), moving_.begin(), moving_.end());
  content.begin = begin_;
  content.overflown = overflown_;
  return content;
}

}  // namespace hgrid
