// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/transform_store.h"

#include <algorithm>

namespace hgrid {

/// Adds empty histories for the two frames that a transform can add: its child and its parent. So each numbered frame
/// has a history, even if memory runs out.
void TransformStore::makeRoom() {
  while (histories_.size() < table_.size() + 2) histories_.emplace_back();
}

/// Returns the number of the parent. If the parent has not changed, this needs no search.
std::uint32_t TransformStore::numberOfParent(std::uint32_t frame, std::string_view parent) {
  if (table_.isInParent(frame, parent)) return table_.parent(frame);
  makeRoom();
  return table_.numberOf(parent);
}

std::uint32_t TransformStore::admit(std::string_view parent, std::string_view child) {
  const Writing writing(*this);
  makeRoom();
  return table_.admit(parent, child);
}

void TransformStore::prefetch(std::uint32_t frame) const {
  const char* const history = reinterpret_cast<const char*>(&histories_[frame]);
  __builtin_prefetch(history, 1);
  __builtin_prefetch(history + sizeof(FrameHistory) - 1, 1);
}

void TransformStore::need(const std::vector<std::string>& names) {
  const Writing writing(*this);
  table_.need(names);
}

bool TransformStore::setFree(std::set<std::string, std::less<>> names) {
  const Writing writing(*this);
  return table_.setFree(std::move(names));
}

void TransformStore::fix(std::uint32_t frame, std::string_view parent, const FramePose& parent_from_frame) {
  const Writing writing(*this);
  histories_[frame].fix({Time(0), numberOfParent(frame, parent), true, parent_from_frame});
  table_.setParent(frame, parent);
}

void TransformStore::advance(std::uint32_t frame, std::string_view parent, PoseSample sample, Time now) {
  const Writing writing(*this);
  sample.parent = numberOfParent(frame, parent);
  append(frame, sample, now);
  table_.setParent(frame, parent);
}

void TransformStore::advance(std::uint32_t frame, PoseSample sample, Time now) {
  const Writing writing(*this);
  sample.parent = table_.parent(frame);
  append(frame, sample, now);
}

void TransformStore::append(std::uint32_t frame, const PoseSample& sample, Time now) {
  FrameHistory& history = histories_[frame];
  history.advance(sample, std::min(sample.stamp, now + cache_ / 2) - cache_);
  dropped_ += history.trim(max_samples_);
}

bool TransformStore::fill(std::uint32_t frame, PoseSample sample) {
  const Writing writing(*this);
  sample.parent = table_.parent(frame);
  const bool filled = histories_[frame].fill(sample);
  dropped_ += histories_[frame].trim(max_samples_);
  return filled;
}

void TransformStore::forgetStamps() {
  const Writing writing(*this);
  for (FrameHistory& history : histories_) history.forgetStamps();
}

}  // namespace hgrid
