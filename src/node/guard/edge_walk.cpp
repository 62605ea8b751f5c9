// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/guard/edge_walk.h"

#include <algorithm>

namespace hgrid {
namespace {

// advance() begins with kFewestEdges, because checkEdges() examines four edges at a time. The number then doubles up to
// kMostEdges, so that an early conflict wastes little work.
constexpr std::size_t kFewestEdges = 4, kMostEdges = 64;

/// Returns a time in seconds as nanoseconds.
Time duration(double seconds) { return std::chrono::duration_cast<Time>(std::chrono::duration<double>(seconds)); }

}  // namespace

std::string EdgeWalk::advance(const StateChecker& checker, std::size_t& first) {
  request_.any_contact = true;
  request_.contacts = false;
  for (std::size_t count = kFewestEdges; first + 1 < times_.size(); count = std::min(2 * count, kMostEdges)) {
    check(checker, first, count);
    for (const EdgeAnswer& edge : found_.edges) {
      if (edge.verdict == Verdict::hit) {
        return checker.snapshot().structure().bodies[found_.pairs[edge.first_pair].first].robot;
      }
      if (edge.verdict != Verdict::clear) return {};
      ++first;
    }
  }
  return {};
}

PathAnswer EdgeWalk::clearUntil(std::size_t end) const {
  PathAnswer answer;
  answer.verdict = Verdict::clear;
  answer.free_for = seconds(times_[end] - times_.front());
  return answer;
}

void EdgeWalk::extend(PathAnswer& answer, const StateChecker& checker, std::size_t first) {
  request_.any_contact = false;
  request_.contacts = true;
  std::size_t count = 1;  // 1: in most cases, the first edge has the conflict
  for (; first + 1 < times_.size() && !answer.conflict; count = std::min(2 * count, kMostEdges)) {
    check(checker, first, count);
    for (std::size_t i = 0; i < edges_.size() && !answer.conflict; ++i) add(answer, checker, i);
    first += edges_.size();
  }
}

void EdgeWalk::check(const StateChecker& checker, std::size_t first, std::size_t count) {
  edges_.clear();
  for (std::size_t i = first; i + 1 < times_.size() && edges_.size() < count; ++i) {
    edges_.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i + 1)});
  }
  checker.checkEdges(batch_, edges_, request_, scratch_, found_);
}

/// Adds the result of edges_[i] to the answer.
void EdgeWalk::add(PathAnswer& answer, const StateChecker& checker, std::size_t i) const {
  const EdgeAnswer& edge = found_.edges[i];
  const Time begin = times_[edges_[i].from];
  const double length = seconds(times_[edges_[i].to] - begin);
  if (answer.verdict == Verdict::clear) {
    const double part = edge.verdict == Verdict::clear ? 1.0 : edge.free_until;
    answer.free_for = seconds(begin - times_.front()) + part * length;
    answer.reason = checker.sentenceOf(batch_, found_, i);
  }
  if (edge.verdict == Verdict::clear) return;
  answer.verdict = edge.verdict;
  if (edge.verdict != Verdict::hit) return;
  answer.reason.clear();
  const StatePair& pair = found_.pairs[edge.first_pair];
  const BodyList& bodies = checker.snapshot().structure().bodies;
  answer.conflict =
      PathConflict{bodies[pair.first].name, bodies[pair.second].name, pair.contact, begin + duration(edge.at * length)};
}

}  // namespace hgrid
