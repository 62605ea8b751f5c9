// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "freshness_model.h"

#include <algorithm>
#include <cmath>

namespace hgrid {
namespace test {
namespace {

constexpr double kOverlap = 0.6;         // [s] sources whose statements are this close in time may be in a dispute
constexpr double kOfAnotherTime = -1e9;  // [s] stamp from before a jump of the ROS clock
constexpr double kLongestGap = 10.0;     // [s] as ~tf_cache; between statements farther apart nothing is known
constexpr double kMemory = 4.0;          // [s] a dispute lasts at most this long after the last change of the source
constexpr double kNotice = 0.5;          // [s] longest time that the node needs to notice that two sources fight
constexpr std::ptrdiff_t kFight = 4;     // two sources fight if the source changes at least this often in each kNotice

}  // namespace

void FreshnessModel::noteSource(Frame& frame, const Statement& statement, double now) {
  const std::string source = statement.is_static ? "/tf_static" : statement.publisher;
  const bool same_parent = !frame.last || frame.last->parent == statement.parent;
  const bool other = !frame.source.empty() && frame.source != source;
  if ((other || (!same_parent && !statement.is_static)) &&
      now - frame.heard < std::max(kOverlap, 2.5 * frame.longest_period)) {
    if (other || frame.former_parent == statement.parent) frame.turns.push_back(now);
    if (other) frame.disputed_until = std::max(frame.disputed_until, now + kMemory);
  }
  const bool on_both =
      (other && (statement.is_static || frame.source == "/tf_static")) || (frame.fixed && !statement.is_static);
  if (on_both) frame.disputed_until = 1e9;
  if (!same_parent) {
    // If a parent that was replaced a short time ago comes back, the parents alternate, whoever publishes them.
    if (frame.former_parent == statement.parent) frame.disputed_until = std::max(frame.disputed_until, now + kMemory);
    frame.former_parent = frame.last->parent;
  }
  frame.source = source;
  frame.heard = now;
  frame.last = statement;
}

void FreshnessModel::hear(const Statement& statement, double now) {
  Frame& frame = heard_[statement.frame];
  noteSource(frame, statement, now);
  if (statement.is_static) {
    frame.fixed = statement;
    frame.all_fixed.push_back(statement);
    return;
  }
  frame.all.push_back(statement);
  frame.by_claim[{statement.publisher, statement.parent}].emplace(statement.stamp, statement);
  if (statement.stamp < frame.claim_begin) return;  // another publisher held the frame at that time
  const auto stored = frame.statements.emplace(statement.stamp, statement);
  if (!stored.second) {  // of two statements with the same stamp, the first counts
    if (stored.first->second.parent != statement.parent) frame.disputed_until = now + kMemory;
    return;
  }
  const bool older = frame.newest && statement.stamp <= *frame.newest;
  // An older statement with another parent contradicts the stored statements.
  if (older && frame.statements.at(*frame.newest).parent != statement.parent) {
    frame.disputed_until = std::max(frame.disputed_until, now + kMemory);
  }
  if (older) return;
  if (frame.newest) {
    // The shorter of two successive steps between stamps counts as a period. A single long step is an outage.
    const double step = statement.stamp - *frame.newest;
    frame.longest_period = std::max(frame.longest_period, std::min(frame.step, step));
    frame.step = step;
    const Statement& before = frame.statements.at(*frame.newest);
    const bool same = before.publisher == statement.publisher && before.parent == statement.parent;
    if (!same || statement.stamp - before.stamp > kLongestGap) frame.claim_begin = statement.stamp;
  }
  frame.newest = statement.stamp;
}

void FreshnessModel::hearRefused(const std::string& frame, double now) {
  heard_[frame].disputed_until = std::max(heard_[frame].disputed_until, now + kMemory);
}

void FreshnessModel::forgetStamps(double jump) {
  for (auto& named : known_) named.second.stamp = kOfAnotherTime;
  for (auto& named : heard_) {
    named.second.statements.clear();
    named.second.newest.reset();
    named.second.claim_begin = -1e18;
    named.second.heard = -1e9;  // long ago, since the old time is not comparable
    named.second.turns.clear();
    if (named.second.disputed_until < 1e8) named.second.disputed_until += jump;
  }
}

/// Interpolates the statement at a time from the statements before and after it. Empty if one of them is missing.
std::optional<Statement> FreshnessModel::interpolated(const ByStamp& statements, double time) {
  const auto after = statements.lower_bound(time);
  if (after == statements.end()) return std::nullopt;
  if (after->first == time) return after->second;
  if (after == statements.begin()) return std::nullopt;
  return between(std::prev(after)->second, after->second, time);
}

std::optional<Statement> FreshnessModel::between(const Statement& from, const Statement& to, double time) {
  const bool one_claim =
      from.publisher == to.publisher && from.parent == to.parent && to.stamp - from.stamp <= kLongestGap;
  if (!one_claim || !(from.stamp < to.stamp) || time < from.stamp || time > to.stamp) return std::nullopt;
  Statement result = to;
  result.stamp = time;
  result.x = from.x + (to.x - from.x) * (time - from.stamp) / (to.stamp - from.stamp);
  return result;
}

std::optional<Statement> FreshnessModel::statementAt(const Frame& frame, double time) const {
  if (frame.fixed) return frame.fixed;
  if (!frame.newest || time > *frame.newest) return std::nullopt;
  return interpolated(frame.statements, time);
}

std::optional<double> FreshnessModel::positionAt(const std::string& frame, double time) const {
  if (frame == "base") return 0.0;
  const auto found = heard_.find(frame);
  if (found == heard_.end()) return std::nullopt;
  const std::optional<Statement> statement = statementAt(found->second, time);
  if (!statement) return std::nullopt;
  const std::optional<double> parent = positionAt(statement->parent, time);
  if (!parent) return std::nullopt;
  return *parent + statement->x;
}

/// Whether the positions of all frames of the current chain are known at a time, with the same parents as now.
bool FreshnessModel::isChainKnown(const std::string& frame, double time) const {
  if (frame == "base") return true;
  if (!positionAt(frame, time)) return false;
  const Frame& heard = heard_.at(frame);
  if (heard.fixed) return isChainKnown(heard.fixed->parent, time);
  if (!heard.newest) return false;
  const std::string& parent = heard.statements.at(*heard.newest).parent;
  for (auto since = heard.statements.find(*heard.newest); since->first > time; --since) {
    if (since->second.parent != parent) return false;
    if (since == heard.statements.begin()) break;
  }
  return statementAt(heard, time)->parent == parent && isChainKnown(parent, time);
}

/// The newest time, at most `time`, for which all frames of the chain have statements. Empty if the chain does not lead
/// to the world frame.
std::optional<double> FreshnessModel::newestTime(const std::string& frame, double time) const {
  if (frame == "base") return time;
  const auto found = heard_.find(frame);
  if (found == heard_.end()) return std::nullopt;
  const Frame& heard = found->second;
  if (heard.fixed) return newestTime(heard.fixed->parent, time);
  if (!heard.newest) return std::nullopt;
  return newestTime(heard.statements.at(*heard.newest).parent, std::min(time, *heard.newest));
}

/// Fills in the flags of `known` that follow from the frames of the current chain.
void FreshnessModel::look(const std::string& name, double now, Known& known) const {
  if (name == "base") {
    known.connected = true;
    return;
  }
  const auto found = heard_.find(name);
  if (found == heard_.end()) return;
  const Frame& frame = found->second;
  known.disputed = known.disputed || now < frame.disputed_until;
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
    look(frame.statements.at(*frame.newest).parent, now, known);
  }
}

void FreshnessModel::tick(double time, double now, double elapsed) {
  for (const std::string& name : frames_) {
    Known& known = known_[name];
    const bool moved_before = known.moves, was_disputed = known.disputed;
    known.age += elapsed;
    if (known.stamp == kOfAnotherTime) known.stamp = now - known.age;
    known.period = 0.0;
    known.at_tick = known.moves = known.disputed = known.fought = known.connected = false;
    look(name, now, known);
    if (known.disputed) known.moves = true;
    std::optional<double> stamp = time;
    std::optional<double> x = positionAt(name, time);
    known.at_tick = x.has_value() && known.connected && isChainKnown(name, time);
    if (!known.at_tick) {
      stamp = newestTime(name, known.placed ? time : 1e9);
      x = stamp && known.connected && isChainKnown(name, *stamp) ? positionAt(name, *stamp) : std::nullopt;
    }
    if (!known.at_tick && was_disputed) known.disputed = true;  // the pose in use may come from the dispute
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
  const auto supports = [&](const Statement& statement) {
    return isSupported(statement.parent, x - statement.x, stamp);
  };
  if (std::any_of(heard.all_fixed.begin(), heard.all_fixed.end(), supports)) return true;
  for (const Statement& from : heard.all) {
    for (const Statement& to : heard.all) {
      const std::optional<Statement> statement = between(from, to, stamp);
      if (statement && supports(*statement)) return true;
    }
  }
  return std::any_of(heard.by_claim.begin(), heard.by_claim.end(), [&](const auto& claim) {
    const std::optional<Statement> statement = interpolated(claim.second, stamp);
    return statement && supports(*statement);
  });
}

}  // namespace test
}  // namespace hgrid
