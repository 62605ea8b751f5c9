// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/frame_history.h"

namespace hgrid {
namespace {

constexpr std::size_t kMostSeams = 16;    // a frame with more seams is one over which publishers fight
constexpr std::size_t kMostSamples = 64;  // of a frame that tf2 takes for static

}  // namespace

void FrameHistory::fix(const PoseSample& sample) {
  newest_ = sample;
  before_ = PoseSample{};
  seams_.clear();
  older_.clear();
  moves_ = false;
}

void FrameHistory::advance(const PoseSample& sample, bool same_parent, bool keeps_all) {
  if (!moves_) newest_ = PoseSample{};
  if (!same_parent) parent_since_ = newest_.stamp.count() > 0 ? sample.stamp : Time(0);
  before_ = sample.stamp < newest_.stamp ? PoseSample{} : newest_;
  newest_ = sample;
  moves_ = true;
  keeps_all_ = keeps_all;
  if (keeps_all_) keep();
}

void FrameHistory::keep() {
  if (before_.stamp.count() == 0) older_.clear();
  if (older_.size() >= kMostSamples) older_.erase(older_.begin());
  older_.push_back(newest_);
}

void FrameHistory::fill(const PoseSample& sample) {
  if (sample.stamp > before_.stamp) before_ = sample;
}

void FrameHistory::addSeam(Time until) {
  if (seams_.size() >= kMostSeams) seams_.erase(seams_.begin());
  seams_.push_back({newest_.stamp, until});
}

void FrameHistory::forgetStamps() {
  newest_.stamp = before_.stamp = parent_since_ = Time(0);
  seams_.clear();
  older_.clear();
}

FramePose FrameHistory::interpolated(const PoseSample& from, const PoseSample& to, Time time) {
  const double whole = static_cast<double>((to.stamp - from.stamp).count());
  return between(from.parent_from_frame, to.parent_from_frame,
                 static_cast<double>((time - from.stamp).count()) / whole);
}

bool FrameHistory::isInSeam(Time time) const {
  for (const Seam& seam : seams_) {
    if (time > seam.begin && time < seam.end) return true;
  }
  return false;
}

std::optional<FramePose> FrameHistory::recall(Time time) const {
  for (std::size_t i = older_.size(); i > 1; --i) {
    const PoseSample &from = older_[i - 2], &to = older_[i - 1];
    if (time < from.stamp) continue;
    if (time > to.stamp || from.parent != newest_.parent || to.parent != newest_.parent) return std::nullopt;
    return interpolated(from, to, time);
  }
  return std::nullopt;
}

}  // namespace hgrid
