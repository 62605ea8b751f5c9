// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tracks/track_queue.h"

#include <utility>

namespace hgrid {
namespace {

std::size_t sizeOf(const ReceivedTracks& received) { return received.message->bytes.size() + TrackQueue::kOverhead; }

}  // namespace

std::size_t TrackQueue::push(ReceivedTracks received) {
  std::size_t removed = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    bytes_ += sizeOf(received);
    waiting_.push_back(std::move(received));
    for (; bytes_ > most_bytes_ && waiting_.size() > 1; ++removed) {
      bytes_ -= sizeOf(waiting_.front());
      waiting_.pop_front();
    }
  }
  changed_.notify_one();
  return removed;
}

std::optional<ReceivedTracks> TrackQueue::popFor(std::chrono::milliseconds most_time) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_for(lock, most_time, [this] { return ended_ || !waiting_.empty(); });
  if (ended_ || waiting_.empty()) return std::nullopt;
  ReceivedTracks oldest = std::move(waiting_.front());
  waiting_.pop_front();
  bytes_ -= sizeOf(oldest);
  return oldest;
}

void TrackQueue::end() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
  }
  changed_.notify_one();
}

bool TrackQueue::ended() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return ended_;
}

}  // namespace hgrid
