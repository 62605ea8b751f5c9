// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hgrid {

/// Remembers which bodies changed in the last commits. With it, a commit brings an earlier snapshot object up to date
/// without a visit of all bodies.
///
/// Commits are numbered from 1. A body is named by its slot.
class RecentChanges {
 public:
  /// Makes room for this number of bodies. Then note() allocates no memory.
  void reserve(std::size_t bodies) {
    const auto reserveIn = [bodies](std::vector<std::uint32_t>& list) {
      if (list.capacity() < bodies) list.reserve(std::max(bodies, 2 * list.capacity()));
    };
    reserveIn(now_);
    for (std::vector<std::uint32_t>& list : lists_) reserveIn(list);
  }
  /// Notes that a body has changed since the last commit. Call this once for each such body.
  void note(std::uint32_t slot) { now_.push_back(slot); }
  /// Returns the bodies that have changed since the last commit.
  const std::vector<std::uint32_t>& now() const { return now_; }
  /// Whether all changes after this commit are remembered.
  bool covers(std::uint64_t commit) const { return commit + kRemembered >= commits_; }
  /// Returns how many bodies visitSince() and now() visit. Call this only if covers().
  std::size_t countSince(std::uint64_t commit) const {
    std::size_t count = now_.size();
    for (std::uint64_t number = commit + 1; number <= commits_; ++number) count += lists_[number % kRemembered].size();
    return count;
  }
  /// Calls `visit` with each body that changed after this commit, up to the last commit. It may visit a body several
  /// times. Call this only if covers().
  template <class Visit>
  void visitSince(std::uint64_t commit, Visit&& visit) const {
    for (std::uint64_t number = commit + 1; number <= commits_; ++number) {
      for (const std::uint32_t slot : lists_[number % kRemembered]) visit(slot);
    }
  }
  /// Ends a commit: the noted changes are those of this commit. Allocates no memory.
  void accept() {
    ++commits_;
    lists_[commits_ % kRemembered].swap(now_);
    now_.clear();
  }

 private:
  static constexpr std::size_t kRemembered = 8;

  std::uint64_t commits_ = 0;  // number of the last commit
  std::vector<std::uint32_t> now_;
  std::array<std::vector<std::uint32_t>, kRemembered> lists_;  // by the number of the commit, modulo kRemembered
};

}  // namespace hgrid
