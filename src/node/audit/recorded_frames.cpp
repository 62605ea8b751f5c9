// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/audit/recorded_frames.h"

#include <algorithm>

#include "node/audit/usable_numbers.h"

namespace hgrid {
namespace {

/// Whether the node uses a transform with these numbers and stamps.
bool isValid(const RecordedTransform& transform, double max_future) {
  if (!usableNumbers(transform.numbers)) return false;
  return transform.is_static || (transform.stamp.count() > 0 && transform.received.count() > 0 &&
                                 seconds(transform.stamp - transform.received) <= max_future);
}

}  // namespace

RecordedFrames::RecordedFrames(const AuditCase& audited) : audited_(audited), frames_(audited.names.size()) {
  for (std::size_t number = 0; number < audited.names.size(); ++number) numbers_.emplace(audited.names[number], number);
  for (const RecordedTransform& transform : audited.transforms) add(transform);
  for (const std::string& name : audited.free_frames) {
    if (const auto number = numberOf(name)) frames_[*number].free = true;
  }
  for (Frame& frame : frames_) finish(frame);
}

/// Returns the index of a frame in frames_; empty if no transform contains this name.
std::optional<std::size_t> RecordedFrames::numberOf(const std::string& name) const {
  const auto found = numbers_.find(name);
  if (found == numbers_.end()) return std::nullopt;
  return found->second;
}

void RecordedFrames::add(const RecordedTransform& transform) {
  Frame& frame = frames_[transform.child];
  if (transform.parent == transform.child || audited_.names[transform.parent].empty() ||
      audited_.names[transform.child].empty() || !isValid(transform, audited_.max_future)) {
    frame.doubtful = true;
    return;
  }
  const auto& n = transform.numbers;
  Sample sample;
  sample.stamp = transform.stamp;
  sample.parent = transform.parent;
  sample.rotation = Eigen::Quaterniond(n[6], n[3], n[4], n[5]).normalized();
  sample.translation = Eigen::Vector3d(n[0], n[1], n[2]);
  if (!frame.samples.empty() && frame.publisher != transform.publisher) frame.doubtful = true;
  frame.publisher = transform.publisher;
  (transform.is_static ? frame.fixed : frame.moves) = true;
  if (transform.is_static) frame.samples.clear();  // only the newest static transform counts
  frame.samples.push_back(sample);
}

void RecordedFrames::finish(Frame& frame) {
  if (frame.fixed && frame.moves) frame.doubtful = true;
  if (frame.free && !frame.moves) frame.samples.clear();  // its static pose says nothing
  if (!frame.moves) return;
  const auto earlier = [](const Sample& a, const Sample& b) { return a.stamp < b.stamp; };
  const auto same = [](const Sample& a, const Sample& b) { return a.stamp == b.stamp; };
  std::stable_sort(frame.samples.begin(), frame.samples.end(), earlier);
  frame.samples.erase(std::unique(frame.samples.begin(), frame.samples.end(), same), frame.samples.end());
  for (const Sample& sample : frame.samples)
    frame.doubtful = frame.doubtful || sample.parent != frame.samples[0].parent;
}

/// Returns a frame, its parent, the parent of this parent, and so on. Returns an empty list if they form a loop.
std::vector<std::size_t> RecordedFrames::ancestors(std::size_t frame) const {
  std::vector<std::size_t> result{frame};
  while (!frames_[result.back()].samples.empty()) {
    if (result.size() > frames_.size()) return {};
    result.push_back(frames_[result.back()].samples.back().parent);
  }
  return result;
}

std::optional<RecordedFrames::Chain> RecordedFrames::chain(const std::string& target, const std::string& frame) const {
  Chain chain;
  if (target == frame) return chain;
  const auto from = numberOf(target), to = numberOf(frame);
  if (!from || !to) return std::nullopt;
  chain.up = ancestors(*from);
  chain.down = ancestors(*to);
  if (chain.up.empty() || chain.down.empty() || chain.up.back() != chain.down.back()) return std::nullopt;
  while (!chain.up.empty() && !chain.down.empty() && chain.up.back() == chain.down.back()) {
    chain.up.pop_back();
    chain.down.pop_back();
  }
  for (const auto* side : {&chain.up, &chain.down}) {
    for (const std::size_t number : *side) {
      chain.doubtful = chain.doubtful || frames_[number].doubtful;
      chain.moves = chain.moves || frames_[number].moves;
    }
  }
  return chain;
}

/// Returns the pose of a frame in its parent at a time. Empty: the pose is not known at this time.
std::optional<Pose> RecordedFrames::edgeAt(std::size_t number, Time time) const {
  const Frame& frame = frames_[number];
  const auto poseOf = [](const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation) {
    Pose pose = Pose::Identity();
    pose.linear() = rotation.toRotationMatrix();
    pose.translation() = translation;
    return pose;
  };
  if (!frame.moves) return poseOf(frame.samples.back().rotation, frame.samples.back().translation);
  const auto after = std::lower_bound(frame.samples.begin(), frame.samples.end(), time,
                                      [](const Sample& sample, Time wanted) { return sample.stamp < wanted; });
  if (after == frame.samples.end()) return std::nullopt;
  if (after->stamp == time) return poseOf(after->rotation, after->translation);
  if (after == frame.samples.begin()) return std::nullopt;
  const Sample& before = *(after - 1);
  const double part = seconds(time - before.stamp) / seconds(after->stamp - before.stamp);
  return poseOf(before.rotation.slerp(part, after->rotation),
                before.translation + part * (after->translation - before.translation));
}

std::optional<Pose> RecordedFrames::poseAt(const Chain& chain, Time time) const {
  Pose ancestor_from_frame = Pose::Identity(), ancestor_from_target = Pose::Identity();
  for (const std::size_t number : chain.down) {
    const auto edge = edgeAt(number, time);
    if (!edge) return std::nullopt;
    ancestor_from_frame = *edge * ancestor_from_frame;
  }
  for (const std::size_t number : chain.up) {
    const auto edge = edgeAt(number, time);
    if (!edge) return std::nullopt;
    ancestor_from_target = *edge * ancestor_from_target;
  }
  return ancestor_from_target.inverse() * ancestor_from_frame;
}

Time RecordedFrames::newestTime(const Chain& chain) const {
  Time newest = Time::max();
  for (const auto* side : {&chain.up, &chain.down}) {
    for (const std::size_t number : *side) {
      if (frames_[number].moves) newest = std::min(newest, frames_[number].samples.back().stamp);
    }
  }
  return newest;
}

std::optional<Time> RecordedFrames::sampledUpTo(const Chain& chain, Time time) const {
  Time result = time;
  for (const auto* side : {&chain.up, &chain.down}) {
    for (const std::size_t number : *side) {
      const Frame& frame = frames_[number];
      if (!frame.moves) continue;
      const auto after = std::upper_bound(frame.samples.begin(), frame.samples.end(), time,
                                          [](Time wanted, const Sample& sample) { return wanted < sample.stamp; });
      if (after == frame.samples.begin()) return std::nullopt;
      result = std::min(result, (after - 1)->stamp);
    }
  }
  return result;
}

}  // namespace hgrid
