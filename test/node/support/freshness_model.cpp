// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "freshness_model.h"

#include <algorithm>
#include <cmath>

namespace hgrid {
namespace test {
namespace {

constexpr double kOverlap = 0.6;   // [s] sources that speak within this of each other may be in a dispute
constexpr double kMemory = 4.0;    // [s] how long a dispute lasts at most after its last turn
constexpr double kTurns = 1.0;     // [s] in which turns are counted
constexpr std::size_t kFight = 6;  // as many turns within that time are a fight

}  // namespace

void FreshnessModel::noteSource(Frame& frame, const Segment1d& segment, double now) {
  const std::string source = segment.is_static ? "/tf_static" : segment.publisher;
  const bool same_parent = frame.segments.empty() || frame.segments.back().parent == segment.parent;
  const bool other = !frame.source.empty() && frame.source != source;
  const bool on_both = frame.fixed && !segment.is_static;
  if ((other || (!same_parent && !segment.is_static)) && now - frame.heard < kOverlap) {
    if (other || frame.former_parent == segment.parent) frame.turns.push_back(now);
    if (other) frame.disputed_until = now + kMemory;
  }
  if (other && (segment.is_static || frame.source == "/tf_static")) frame.disputed_until = 1e9;
  if (on_both) frame.disputed_until = 1e9;
  if (!same_parent) {
    // A parent that was left a short while ago and comes again is an alternation, whoever says it.
    if (frame.former_parent == segment.parent) frame.disputed_until = std::max(frame.disputed_until, now + kMemory);
    frame.former_parent = frame.segments.back().parent;
  }
  frame.source = source;
  frame.heard = now;
}

void FreshnessModel::hear(const Segment1d& segment, double stamp, double now) {
  Frame& frame = heard_[segment.frame];
  noteSource(frame, segment, now);
  if (frame.segments.empty() || frame.segments.back().number != segment.number) frame.segments.push_back(segment);
  if (segment.is_static) {
    frame.fixed = segment;
    return;
  }
  if (!frame.statements.emplace(stamp, segment).second) return;  // of two with one stamp the first counts
  const bool newer = !frame.newest || stamp > *frame.newest;
  const bool from_ahead = frame.newest && *frame.newest > now && stamp <= now;
  if (newer || from_ahead) frame.newest = stamp;
}

void FreshnessModel::hearRefused(const std::string& frame, double now) {
  heard_[frame].disputed_until = std::max(heard_[frame].disputed_until, now + kMemory);
}

void FreshnessModel::forgetStamps(double jump) {
  for (auto& named : heard_) {
    named.second.statements.clear();
    named.second.newest.reset();
    named.second.heard = -1e9;  // of another time
    named.second.turns.clear();
    if (named.second.disputed_until < 1e8) named.second.disputed_until += jump;
  }
}

/// The segment that says where the frame is at a time: one that spoke before it and after it, nobody in between.
const Segment1d* FreshnessModel::segmentAt(const Frame& frame, double time) const {
  if (frame.fixed) return &*frame.fixed;
  if (!frame.newest || time > *frame.newest) return nullptr;
  const auto after = frame.statements.lower_bound(time);
  if (after == frame.statements.end()) return nullptr;
  if (after->first == time) return &after->second;
  if (after == frame.statements.begin()) return nullptr;
  const auto before = std::prev(after);
  return before->second.number == after->second.number ? &after->second : nullptr;
}

std::optional<double> FreshnessModel::positionAt(const std::string& frame, double time) const {
  if (frame == "base") return 0.0;
  const auto found = heard_.find(frame);
  if (found == heard_.end()) return std::nullopt;
  const Segment1d* segment = segmentAt(found->second, time);
  if (segment == nullptr) return std::nullopt;
  const std::optional<double> parent = positionAt(segment->parent, time);
  if (!parent) return std::nullopt;
  return *parent + segment->at(segment->is_static ? 0.0 : time);
}

/// The newest time, at most `time`, at which the newest statements of all the chain reach. Empty: it leads nowhere.
std::optional<double> FreshnessModel::newestTime(const std::string& frame, double time) const {
  if (frame == "base") return time;
  const auto found = heard_.find(frame);
  if (found == heard_.end()) return std::nullopt;
  const Frame& heard = found->second;
  if (heard.fixed) return newestTime(heard.fixed->parent, time);
  if (!heard.newest) return std::nullopt;
  return newestTime(heard.statements.at(*heard.newest).parent, std::min(time, *heard.newest));
}

/// What else there is to say of the chain that the newest statements make.
void FreshnessModel::look(const std::string& name, double now, Known& known) const {
  if (name == "base") {
    known.connected = true;
    return;
  }
  const auto found = heard_.find(name);
  if (found == heard_.end()) return;
  const Frame& frame = found->second;
  known.disputed = known.disputed || now < frame.disputed_until;
  const auto recent = std::count_if(frame.turns.begin(), frame.turns.end(),
                                    [&](double turn) { return turn > now - kTurns && turn <= now; });
  known.fought = known.fought || static_cast<std::size_t>(recent) >= kFight;
  if (frame.fixed) {
    look(frame.fixed->parent, now, known);
  } else if (frame.newest) {
    known.moves = true;
    look(frame.statements.at(*frame.newest).parent, now, known);
  }
}

void FreshnessModel::tick(double time, double now, double elapsed) {
  for (const std::string& name : frames_) {
    Known& known = known_[name];
    const bool moved_before = known.moves;
    known.age += elapsed;
    known.at_tick = known.moves = known.disputed = known.fought = known.connected = false;
    look(name, now, known);
    if (known.disputed) known.moves = true;
    std::optional<double> stamp = time;
    std::optional<double> x = positionAt(name, time);
    known.at_tick = x.has_value() && known.connected;
    if (!known.at_tick) {
      stamp = newestTime(name, known.placed ? time : 1e9);
      x = stamp && known.connected ? positionAt(name, *stamp) : std::nullopt;
    }
    if (!x || !stamp || (!known.placed && !known.connected)) {
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
  const auto& segments = found->second.segments;
  return std::any_of(segments.begin(), segments.end(), [&](const Segment1d& segment) {
    return isSupported(segment.parent, x - segment.at(segment.is_static ? 0.0 : stamp), stamp);
  });
}

}  // namespace test
}  // namespace hgrid
