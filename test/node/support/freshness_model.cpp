// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "freshness_model.h"

#include <algorithm>
#include <cmath>

namespace hgrid {
namespace test {
namespace {

constexpr double kOverlap = 0.6;         // [s] publishers contest a frame if their transforms arrive within this time
constexpr double kOfAnotherTime = -1e9;  // [s] marks a stamp that was taken before the ROS clock jumped
constexpr double kLongestGap = 10.0;     // [s] value of ~limits/tf_cache; longest time between two transforms of a known pose
constexpr double kMemory = 4.0;          // [s] how long a frame stays contested after a change of its publisher
constexpr double kNotice = 0.5;          // [s] longest time that the node needs to notice that two publishers alternate
constexpr std::ptrdiff_t kFight = 4;     // publishers alternate if they change this often in each kNotice

}  // namespace

void FreshnessModel::noteSource(Frame& frame, const PublishedTransform& transform, double now) {
  const std::string source = transform.is_static ? "/tf_static" : transform.publisher;
  const bool same_parent = !frame.last || frame.last->parent == transform.parent;
  const bool other = !frame.source.empty() && frame.source != source;
  if ((other || (!same_parent && !transform.is_static)) &&
      now - frame.heard < std::max(kOverlap, 2.5 * frame.longest_period)) {
    if (other || frame.former_parent == transform.parent) frame.turns.push_back(now);
    if (other) frame.contested_until = std::max(frame.contested_until, now + kMemory);
  }
  const bool on_both =
      (other && (transform.is_static || frame.source == "/tf_static")) || (frame.fixed && !transform.is_static);
  if (on_both) frame.contested_until = 1e9;
  if (!same_parent) {
    // If a parent comes back that was replaced a short time ago, the parents alternate. This holds for any publisher.
    if (frame.former_parent == transform.parent) frame.contested_until = std::max(frame.contested_until, now + kMemory);
    frame.former_parent = frame.last->parent;
  }
  frame.source = source;
  frame.heard = now;
  frame.last = transform;
}

void FreshnessModel::hear(const PublishedTransform& transform, double now) {
  Frame& frame = heard_[transform.frame];
  noteSource(frame, transform, now);
  if (transform.is_static) {
    frame.fixed = transform;
    frame.all_fixed.push_back(transform);
    return;
  }
  frame.all.push_back(transform);
  frame.by_claim[{transform.publisher, transform.parent}].emplace(transform.stamp, transform);
  if (transform.stamp < frame.claim_begin) return;  // another publisher held the frame at that time
  const auto stored = frame.transforms.emplace(transform.stamp, transform);
  if (!stored.second) {  // the first of two transforms with the same stamp counts
    if (stored.first->second.parent != transform.parent) frame.contested_until = now + kMemory;
    return;
  }
  const bool older = frame.newest && transform.stamp <= *frame.newest;
  // An older transform with another parent contradicts the stored transforms.
  if (older && frame.transforms.at(*frame.newest).parent != transform.parent) {
    frame.contested_until = std::max(frame.contested_until, now + kMemory);
  }
  if (older) return;
  if (frame.newest) {
    // Takes the shorter of two successive steps between stamps as the period, because one long step is an outage.
    const double step = transform.stamp - *frame.newest;
    frame.longest_period = std::max(frame.longest_period, std::min(frame.step, step));
    frame.step = step;
    const PublishedTransform& before = frame.transforms.at(*frame.newest);
    const bool same = before.publisher == transform.publisher && before.parent == transform.parent;
    if (!same || transform.stamp - before.stamp > kLongestGap) frame.claim_begin = transform.stamp;
  }
  frame.newest = transform.stamp;
}

void FreshnessModel::hearRefused(const std::string& frame, double now) {
  heard_[frame].contested_until = std::max(heard_[frame].contested_until, now + kMemory);
}

void FreshnessModel::forgetStamps(double jump) {
  for (auto& named : known_) named.second.stamp = kOfAnotherTime;
  for (auto& named : heard_) {
    named.second.transforms.clear();
    named.second.newest.reset();
    named.second.claim_begin = -1e18;
    named.second.heard = -1e9;  // long ago, because times before and after the jump are not comparable
    named.second.turns.clear();
    if (named.second.contested_until < 1e8) named.second.contested_until += jump;
  }
}

/// Interpolates the transform at a time between the transforms before and after it. Empty if one of them is missing.
std::optional<PublishedTransform> FreshnessModel::interpolated(const ByStamp& transforms, double time) {
  const auto after = transforms.lower_bound(time);
  if (after == transforms.end()) return std::nullopt;
  if (after->first == time) return after->second;
  if (after == transforms.begin()) return std::nullopt;
  return between(std::prev(after)->second, after->second, time);
}

std::optional<PublishedTransform> FreshnessModel::between(const PublishedTransform& from, const PublishedTransform& to,
                                                          double time) {
  const bool one_claim =
      from.publisher == to.publisher && from.parent == to.parent && to.stamp - from.stamp <= kLongestGap;
  if (!one_claim || !(from.stamp < to.stamp) || time < from.stamp || time > to.stamp) return std::nullopt;
  PublishedTransform result = to;
  result.stamp = time;
  result.x = from.x + (to.x - from.x) * (time - from.stamp) / (to.stamp - from.stamp);
  return result;
}

std::optional<PublishedTransform> FreshnessModel::transformAt(const Frame& frame, double time) const {
  if (frame.fixed) return frame.fixed;
  if (!frame.newest || time > *frame.newest) return std::nullopt;
  return interpolated(frame.transforms, time);
}

std::optional<double> FreshnessModel::positionAt(const std::string& frame, double time) const {
  if (frame == "base") return 0.0;
  const auto found = heard_.find(frame);
  if (found == heard_.end()) return std::nullopt;
  const std::optional<PublishedTransform> transform = transformAt(found->second, time);
  if (!transform) return std::nullopt;
  const std::optional<double> parent = positionAt(transform->parent, time);
  if (!parent) return std::nullopt;
  return *parent + transform->x;
}

/// Returns whether the positions of all frames of the current chain are known at a time, with the same parents as now.
bool FreshnessModel::isChainKnown(const std::string& frame, double time) const {
  if (frame == "base") return true;
  if (!positionAt(frame, time)) return false;
  const Frame& heard = heard_.at(frame);
  if (heard.fixed) return isChainKnown(heard.fixed->parent, time);
  if (!heard.newest) return false;
  const std::string& parent = heard.transforms.at(*heard.newest).parent;
  for (auto since = heard.transforms.find(*heard.newest); since->first > time; --since) {
    if (since->second.parent != parent) return false;
    if (since == heard.transforms.begin()) break;
  }
  return transformAt(heard, time)->parent == parent && isChainKnown(parent, time);
}

/// Returns the newest time, at most `time`, for which all frames of the chain have transforms. Empty if the chain does
/// not lead to the world frame.
std::optional<double> FreshnessModel::newestTime(const std::string& frame, double time) const {
  if (frame == "base") return time;
  const auto found = heard_.find(frame);
  if (found == heard_.end()) return std::nullopt;
  const Frame& heard = found->second;
  if (heard.fixed) return newestTime(heard.fixed->parent, time);
  if (!heard.newest) return std::nullopt;
  return newestTime(heard.transforms.at(*heard.newest).parent, std::min(time, *heard.newest));
}

/// Sets the members of `known` that depend only on the frames of the current chain.
void FreshnessModel::look(const std::string& name, double now, Known& known) const {
  if (name == "base") {
    known.connected = true;
    return;
  }
  const auto found = heard_.find(name);
  if (found == heard_.end()) return;
  const Frame& frame = found->second;
  known.contested = known.contested || now < frame.contested_until;
  const auto turnsIn = [&](double from, double to) {
    return std::count_if(frame.turns.begin(), frame.turns.end(),
                         [&](double turn) { return turn > from && turn <= to; });
  };
  known.fought = known.fought || (turnsIn(now - 3.0 * kNotice, now - 2.0 * kNotice) >= kFight &&
                                  turnsIn(now - 2.0 * kNotice, now - kNotice) >= kFight &&
                                  turnsIn(now - kNotice, now - 0.5 * kNotice) >= kFight / 2 &&
                                  turnsIn(now - 0.5 * kNotice, now) >= kFight / 2);
  if (frame.fixed) {
    look(frame.fixed->parent, now, known);
  } else if (frame.newest) {
    known.moves = true;
    known.period = std::max(known.period, frame.longest_period);
    look(frame.transforms.at(*frame.newest).parent, now, known);
  }
}

void FreshnessModel::tick(double time, double now, double elapsed) {
  for (const std::string& name : frames_) {
    Known& known = known_[name];
    const bool moved_before = known.moves, was_contested = known.contested;
    known.age += elapsed;
    if (known.stamp == kOfAnotherTime) known.stamp = now - known.age;
    known.period = 0.0;
    known.at_tick = known.moves = known.contested = known.fought = known.connected = false;
    look(name, now, known);
    if (known.contested) known.moves = true;
    std::optional<double> stamp = time;
    std::optional<double> x = positionAt(name, time);
    known.at_tick = x.has_value() && known.connected && isChainKnown(name, time);
    if (!known.at_tick) {
      stamp = newestTime(name, known.placed ? time : 1e9);
      x.reset();
      if (stamp && known.connected && isChainKnown(name, *stamp)) x = positionAt(name, *stamp);
    }
    if (!known.at_tick && was_contested) known.contested = true;  // the last pose may come from any of the publishers
    const bool older = x && stamp && known.placed && !known.at_tick && *stamp < known.stamp;
    if (!x || !stamp || older || (!known.placed && !known.connected)) {
      if (!moved_before && known.placed && !known.connected) known.moves = true;
      continue;
    }
    known.placed = true;
    known.x = *x;
    known.stamp = *stamp;
    known.age = known.moves ? std::max(0.0, now - *stamp) : 0.0;
  }
}

bool FreshnessModel::isSupported(const std::string& frame, double x, double stamp) const {
  if (frame == "base") return std::abs(x) < 1e-6;
  const auto found = heard_.find(frame);
  if (found == heard_.end()) return false;
  const Frame& heard = found->second;
  const auto supports = [&](const PublishedTransform& transform) {
    return isSupported(transform.parent, x - transform.x, stamp);
  };
  if (std::any_of(heard.all_fixed.begin(), heard.all_fixed.end(), supports)) return true;
  for (const PublishedTransform& from : heard.all) {
    for (const PublishedTransform& to : heard.all) {
      const std::optional<PublishedTransform> transform = between(from, to, stamp);
      if (transform && supports(*transform)) return true;
    }
  }
  return std::any_of(heard.by_claim.begin(), heard.by_claim.end(), [&](const auto& claim) {
    const std::optional<PublishedTransform> transform = interpolated(claim.second, stamp);
    return transform && supports(*transform);
  });
}

}  // namespace test
}  // namespace hgrid
