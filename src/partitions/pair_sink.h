// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {
namespace book {

/// Collects the pairs of one search.
///
/// A partition passes each candidate pair to tryPair(), or to isPair() and then to add(). The sink tests whether the
/// boxes overlap and leaves out pairs of two fixed boxes. It applies the overlap filter to blocks of pairs. It notices
/// when a search exceeds the bound.
class PairSink {
 public:
  /// All parameters must outlive the sink. `boxes` and `fixed` are indexed by id.
  PairSink(const std::vector<Aabb>& boxes, const std::vector<char>& fixed, const OverlapFilter& filter,
           const PairBound& bound, std::vector<ProxyPair>& pairs)
      : boxes_(boxes.data()), fixed_(fixed.data()), filter_(filter), bound_(bound), pairs_(pairs) {
    pairs_.clear();
  }

  bool isFixed(ProxyId id) const { return fixed_[id] != 0; }
  /// Whether the bound is exceeded. The search should then end. The sink ignores pairs that are still added.
  bool isFull() const { return full_; }
  /// Whether two boxes overlap and are not both fixed. The ids must differ.
  bool isPair(ProxyId a, ProxyId b) const {
    return overlap(boxes_[a], boxes_[b]) && !(fixed_[a] != 0 && fixed_[b] != 0);
  }

  /// Adds a pair that isPair() accepts. No pair may be added twice.
  void add(ProxyId a, ProxyId b) {
    if (full_) return;
    if (overlaps_++ >= bound_.overlaps) {
      full_ = true;
      return;
    }
    pairs_.push_back(a < b ? ProxyPair{a, b} : ProxyPair{b, a});
    if (pairs_.size() - filtered_ >= kChunk) filter();
  }
  /// Adds two boxes if isPair() accepts them. A partition must not try the same two boxes twice.
  void tryPair(ProxyId a, ProxyId b) {
    if (isPair(a, b)) add(a, b);
  }
  /// Calls visit(a, b) for each combination of two of the ids, unless both boxes are fixed. Changes the order of the
  /// ids. Many fixed boxes in one cell cost little: the time is proportional to the ids plus the calls.
  template <class Visit>
  void visitPairs(std::vector<ProxyId>& ids, Visit&& visit) {
    const auto fixed = std::partition(ids.begin(), ids.end(), [&](ProxyId id) { return !isFixed(id); });
    for (auto a = ids.begin(); a != fixed && !full_; ++a) {
      for (auto b = a + 1; b != ids.end(); ++b) visit(*a, *b);
    }
  }
  /// Applies the filter to the last pairs. @returns whether all pairs were within the bound
  bool finish() {
    filter();
    return !full_;
  }

 private:
  static constexpr std::size_t kChunk = 4096;  // pairs per call of the filter; they stay in the cache

  void filter() {
    ProxyPair* const first = pairs_.data();
    pairs_.resize(static_cast<std::size_t>(filter_(first + filtered_, first + pairs_.size()) - first));
    filtered_ = pairs_.size();
    if (filtered_ > bound_.pairs) full_ = true;
  }

  const Aabb* boxes_;
  const char* fixed_;
  const OverlapFilter& filter_;
  PairBound bound_;
  std::vector<ProxyPair>& pairs_;
  std::size_t overlaps_ = 0;  // pairs that were added, before the filter
  std::size_t filtered_ = 0;  // the filter has already been applied to this many pairs
  bool full_ = false;
};

}  // namespace book
}  // namespace hgrid
