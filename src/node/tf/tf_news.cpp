// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/tf_news.h"

#include <algorithm>
#include <cmath>

namespace hgrid {

TfNews::TfNews(double max_wait) : max_wait_(std::llround(1e9 * max_wait)) {}

void TfNews::await(const std::vector<FrameStamp>& frames, Time tick, Time now) {
  for (const std::uint32_t frame : awaited_) waits_[frame] = Wait::none;
  awaited_.clear();
  missing_ = 0;
  structure_ = heard_ = false;
  tick_ = newest_ = tick;
  for (const FrameStamp& frame : frames) {
    if (frame.frame >= waits_.size()) waits_.resize(2 * std::size_t{frame.frame} + 8, Wait::none);
    awaited_.push_back(frame.frame);
    const bool has_news = frame.newest > tick;
    waits_[frame.frame] = has_news ? Wait::has_news : Wait::missing;
    if (!has_news) ++missing_;
    if (frame.newest <= now) newest_ = std::max(newest_, frame.newest);
  }
}

void TfNews::note(std::uint32_t frame, Time stamp, Time now) {
  if (frame >= waits_.size() || waits_[frame] == Wait::none) return;
  heard_ = true;
  newest_ = std::max(newest_, std::min(stamp, now));
  if (waits_[frame] == Wait::has_news || stamp <= tick_) return;
  waits_[frame] = Wait::has_news;
  --missing_;
}

}  // namespace hgrid
