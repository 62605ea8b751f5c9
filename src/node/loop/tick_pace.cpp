// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/loop/tick_pace.h"

#include <algorithm>

namespace hgrid {
namespace {

TickPace::Duration periodOf(double rate) {
  return std::chrono::duration_cast<TickPace::Duration>(std::chrono::duration<double>(1.0 / rate));
}

}  // namespace

TickPace::TickPace(double rate, double heartbeat, bool follows_data, Time start)
    : period_(periodOf(rate)),
      heartbeat_(periodOf(heartbeat)),
      follows_data_(follows_data),
      earliest_(start),
      latest_(start) {}

void TickPace::noteReason(Time since) {
  if (!reason_) reason_ = since;
}

void TickPace::noteChange(Time since) {
  if (!change_) change_ = since;
}

TickPace::Time TickPace::due() const {
  if (!follows_data_) return latest_;
  Time due = latest_;
  if (reason_) due = std::min(due, std::max(earliest_, *reason_));
  if (change_) due = std::min(due, std::max(earliest_ + period_ / 2, *change_));
  return due;
}

void TickPace::noteTick(Time now) {
  if (follows_data_) {
    // Data of the same rate that arrives with jitter must not wait for the rest of a period each time. So a tick that
    // came late is followed by a shorter pause, but the mean pause stays one period.
    earliest_ = std::max(earliest_ + period_, now + period_ / 2);
    latest_ = std::max(earliest_, now + heartbeat_);
  } else {
    earliest_ += period_;
    if (earliest_ <= now) earliest_ = now + period_;  // a tick took longer than a period: the others are left out
    latest_ = earliest_;
  }
  reason_.reset();
  change_.reset();
}

}  // namespace hgrid
