// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {
namespace book {

/// Collects the pairs of a search: tests the boxes, leaves out pairs of two fixed boxes, applies the overlap filter and
/// notices when the bound is reached.
class PairSink {
 public:
  /// All parameters must outlive the sink. `boxes` and `fixed` are indexed by id.
  PairSink(const std::vector<Aabb>& boxes, const std::vector<char>& fixed, const OverlapFilter& filter,
           const PairBound& bound, std::vector<ProxyPair>& pairs)
      : boxes_(boxes.data()), fixed_(fixed.data()), filter_(filter), bound_(bound), pairs_(pairs) {
    pairs_.clear();
  }

  bool isFixed(ProxyId id) const { return fixed_[id] != 0; }
  /// Whether the bound is reached. The search may then end; what it still adds is dropped.
  bool isFull() const { return full_; }
  /// Whether two different boxes overlap and are not both fixed.
  bool isPair(ProxyId a, ProxyId b) const {
    return overlap(boxes_[a], boxes_[b]) && !(fixed_[a] != 0 && fixed_[b] != 0);
  }

  /// Adds a pair that isPair() accepts. Each pair must be added once.
  void add(ProxyId a, ProxyId b) {
    if (full_) return;
    if (overlaps_++ >= bound_.overlaps) {
      full_ = true;
      return;
    }
    pairs_.push_back(a < b ? ProxyPair{a, b} : ProxyPair{b, a});
    if (pairs_.size() - filtered_ >= kChunk) filter();
  }
  /// Adds two boxes if they are a pair. Each two boxes must be tried at most once.
  void tryPair(ProxyId a, ProxyId b) {
    if (isPair(a, b)) add(a, b);
  }
  /// Calls visit(a, b) for each two of the ids of which at least one is not fixed. Reorders the ids. Takes time
  /// proportional to the number of ids plus the number of calls.
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
  static constexpr std::size_t kChunk = 4096;

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
  std::size_t overlaps_ = 0, filtered_ = 0;
  bool full_ = false;
};

}  // namespace book
}  // namespace hgrid
