// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/frame_history.h"

#include <algorithm>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

/// Whether the pose is known at all times between two successive samples.
bool joined(const PoseSample& from, const PoseSample& to) { return to.continues && from.parent == to.parent; }

PoseSample interpolated(const PoseSample& from, const PoseSample& to, Time time) {
  const double whole = static_cast<double>((to.stamp - from.stamp).count());
  const double fraction = static_cast<double>((time - from.stamp).count()) / whole;
  return {time, to.parent, true, between(from.parent_from_frame, to.parent_from_frame, fraction)};
}

}  // namespace

const PoseSample FrameHistory::kNoSample;

void FrameHistory::prefetchNewest() const {
  const auto sample = reinterpret_cast<std::uintptr_t>(&newest());
  for (std::size_t at = 0; at < 2 * sizeof(PoseSample); at += 64) {
    __builtin_prefetch(reinterpret_cast<const void*>(sample + at), 1);
  }
}

void FrameHistory::fix(const PoseSample& sample) {
  if (samples_.empty()) {
    samples_.push_back(sample);
  } else {
    samples_.back() = sample;
  }
  samples_.erase(samples_.begin(), samples_.end() - 1);
  moves_ = false;
}

/// Returns the first sample that is valid: the first one that is not before kept_from_. The newest one is always valid.
FrameHistory::Samples::const_iterator FrameHistory::first() const {
  if (samples_.empty() || samples_.front().stamp >= kept_from_) return samples_.begin();
  return std::lower_bound(samples_.begin(), samples_.end() - 1, kept_from_,
                          [](const PoseSample& left, Time right) { return left.stamp < right; });
}

/// Drops samples that are no longer valid, but leaves up to kDropped of them.
void FrameHistory::dropSome() {
  pushed_ = 0;
  while (samples_.size() > kDropped && samples_[kDropped - 1].stamp < kept_from_) {
    samples_.erase(samples_.begin(), samples_.begin() + kDropped);
  }
}

/// Drops all samples that are no longer valid.
void FrameHistory::dropAll() { samples_.erase(samples_.cbegin(), first()); }

/// If memory runs out, nothing is changed, because the only allocation comes before all changes.
void FrameHistory::advance(const PoseSample& sample, Time keep_from) {
  if (!samples_.empty() && (!moves_ || newest().stamp.count() == 0)) {  // the only sample has no stamp
    fix(sample);
  } else if (!samples_.empty() && newest().stamp >= sample.stamp) {
    replaceFrom(sample);
  } else {
    samples_.push_back(sample);
  }
  moves_ = true;
  if (keep_from < kept_from_) dropAll();  // samples that were no longer valid must not become valid again
  kept_from_ = keep_from;
  if (++pushed_ >= kDropped) dropSome();
}

/// Replaces all samples that are not older than `sample` by it. If a replaced sample ended a seam, `sample` ends one.
void FrameHistory::replaceFrom(const PoseSample& sample) {
  dropAll();
  bool continues = sample.continues && samples_.back().continues;
  while (samples_.size() > 1 && samples_[samples_.size() - 2].stamp >= sample.stamp) {
    samples_.pop_back();
    continues = continues && samples_.back().continues;
  }
  samples_.back() = sample;
  samples_.back().continues = continues;
}

bool FrameHistory::fill(const PoseSample& sample) {
  if (sample.stamp < kept_from_) return false;
  const auto next = after(sample.stamp);
  const auto is_seam = [](const PoseSample& one) { return !one.continues; };
  if (std::any_of(next, samples_.cend(), is_seam)) return false;
  if (next == samples_.cbegin() || std::prev(next)->stamp < sample.stamp) samples_.insert(next, sample);
  return true;
}

std::size_t FrameHistory::trim(std::size_t most) {
  if (samples_.size() <= most) return 0;
  dropAll();
  if (samples_.size() <= most) return 0;
  const std::size_t dropped = samples_.size() - most;
  samples_.erase(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(dropped));
  kept_from_ = std::max(kept_from_, samples_.front().stamp);
  return dropped;
}

void FrameHistory::forgetStamps() {
  if (!moves_) return;
  samples_.erase(samples_.begin(), samples_.end() - 1);
  samples_.back().stamp = kept_from_ = Time(0);
}

FrameHistory::Samples::const_iterator FrameHistory::after(Time time) const {
  if (samples_.size() > 1 && time >= samples_[samples_.size() - 2].stamp) {  // fast path: ticks ask for new times
    return time >= newest().stamp ? samples_.end() : samples_.end() - 1;
  }
  return std::upper_bound(samples_.begin(), samples_.end(), time,
                          [](Time left, const PoseSample& right) { return left < right.stamp; });
}

std::optional<PoseSample> FrameHistory::sampleAt(Time time) const {
  if (samples_.empty()) return std::nullopt;
  if (!moves_) return newest();
  const auto to = after(time);
  if (to == samples_.begin()) return std::nullopt;
  const auto from = std::prev(to);
  if (from->stamp < kept_from_ && from < first()) return std::nullopt;
  if (from->stamp == time) return *from;
  if (to == samples_.end() || !joined(*from, *to)) return std::nullopt;
  return interpolated(*from, *to, time);
}

std::optional<FramePose> FrameHistory::at(Time time) const {
  if (moves_ && time == newest().stamp) return newest().parent_from_frame;
  const std::optional<PoseSample> sample = sampleAt(time);
  if (!sample || sample->parent != newest().parent) return std::nullopt;
  return sample->parent_from_frame;
}

std::optional<Time> FrameHistory::newestKnownTime(Time time) const {
  const auto next = after(time), oldest = first();
  if (next <= oldest || newest().stamp.count() == 0) return std::nullopt;
  auto known = std::prev(next);
  if (next != samples_.end() && joined(*known, *next) && next->parent == newest().parent) return time;
  while (known->parent != newest().parent) {
    if (known == oldest) return std::nullopt;
    --known;
  }
  return known->stamp;
}

std::string FrameHistory::knownTimes(Time time) const {
  const auto stampOf = [](const PoseSample& sample) { return text(seconds(sample.stamp)); };
  if (newest().stamp.count() == 0) return "has received no transform since the clock jumped";
  const auto next = after(time), oldest = first();
  if (next <= oldest || next == samples_.end()) {
    return "is known from " + stampOf(*oldest) + " s to " + stampOf(newest()) + " s";
  }
  return "is not known between " + stampOf(*std::prev(next)) + " s and " + stampOf(*next) +
         " s, because its publisher or parent changed or its transforms paused";
}

}  // namespace hgrid
