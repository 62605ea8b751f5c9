// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/audit/transform_record.h"

#include <algorithm>

#include "node/audit/usable_numbers.h"

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
  StaticTransforms kept;
  const bool valid = visitTransforms(message.message->bytes, [&](const SerializedTransform& transform) {
    if (usableNumbers(transform.numbers)) kept.insert_or_assign({transform.child, message.publisher}, transform);
  });
  if (!valid) return;  // the node refuses such a message
  shared_fixed_.reset();
  for (auto& [key, transform] : kept) {
    const auto known = fixed_.find(key);
    if (known != fixed_.end()) {
      known->second = transform;
    } else if (fixed_.size() < most_static_) {
      fixed_.emplace(key, transform);
    } else {
      all_static_ = false;
    }
  }
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

TransformRecord::Content TransformRecord::content() {
  if (!shared_fixed_) shared_fixed_ = std::make_shared<const StaticTransforms>(fixed_);
  Content content;
  content.fixed = shared_fixed_;
  content.moving.assign(moving_.begin(), moving_.end());
  content.begin = begin_;
  content.all_static = all_static_;
  return content;
}

}  // namespace hgrid
