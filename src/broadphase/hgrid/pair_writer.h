// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <atomic>
#include <vector>

#include "broadphase/kernels/kernels.h"
#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {

/// Leaves out the pairs of two fixed boxes, then the pairs that the overlap filter does not keep.
struct CombinedFilter {
  const OverlapFilter& overlaps;
  const std::vector<bool>* fixed;  // by id; null if all fixed boxes are in the fixed layer

  /// Filters the pairs with indices from .. end - 1 and moves the kept pairs together, from index `from` on.
  /// @returns the end of the kept pairs
  std::size_t keep(std::vector<ProxyPair>& pairs, std::size_t from, std::size_t end) const {
    ProxyPair *const first = pairs.data() + from, *last = pairs.data() + end;
    if (fixed != nullptr) last = OverlapFilter::of<notBothFixed>(fixed)(first, last);
    return static_cast<std::size_t>(overlaps(first, last) - pairs.data());
  }

 private:
  static bool notBothFixed(const void* fixed, ProxyId first, ProxyId second) {
    const auto& is = *static_cast<const std::vector<bool>*>(fixed);
    return !(first < is.size() && is[first] && second < is.size() && is[second]);
  }
};

/// Counts the pairs and overlaps that all threads of a search find. Says whether they exceed the bound.
class Tally {
 public:
  /// @param pairs, overlaps  numbers of pairs and overlaps that were found before this search and count as well
  Tally(const PairBound& bound, std::size_t pairs, std::size_t overlaps)
      : bound_(bound),
        pairs_(pairs),
        overlaps_(overlaps),
        exceeded_(pairs > bound.pairs || overlaps > bound.overlaps) {}

  void add(std::size_t pairs, std::size_t overlaps) {
    const std::size_t all_pairs = pairs_.fetch_add(pairs, std::memory_order_relaxed) + pairs;
    const std::size_t all_overlaps = overlaps_.fetch_add(overlaps, std::memory_order_relaxed) + overlaps;
    if (all_pairs > bound_.pairs || all_overlaps > bound_.overlaps) exceeded_.store(true, std::memory_order_relaxed);
  }
  bool exceeded() const { return exceeded_.load(std::memory_order_relaxed); }
  std::size_t overlaps() const { return overlaps_.load(std::memory_order_relaxed); }
  const PairBound& bound() const { return bound_; }

 private:
  const PairBound bound_;
  std::atomic<std::size_t> pairs_, overlaps_;
  std::atomic<bool> exceeded_;
};

/// Lets kernels write pairs into a vector, after the first `used` pairs.
///
/// The vector grows until it has room for kRoom pairs more than the bound allows. When the vector is full, the pairs
/// are filtered to make room. When the pairs exceed the bound, Sink::full asks the kernels to stop. PairWriter never
/// shrinks the vector.
class PairWriter {
 public:
  PairWriter(std::vector<ProxyPair>& pairs, std::size_t used, const CombinedFilter& filter, Tally& tally)
      : pairs_(pairs), wanted_end_(used), filter_(filter), tally_(tally) {
    if (pairs_.size() < used + kLeast) pairs_.resize(used + kLeast);
    sink_.owner = this;
    sink_.grow = grow;
    point(used);
  }
  PairWriter(const PairWriter&) = delete;
  PairWriter& operator=(const PairWriter&) = delete;

  kernels::PairSink* sink() { return &sink_; }
  /// Filters the pairs that were written since the last call.
  /// @returns the end of the kept pairs; meaningless if the bound is exceeded
  std::size_t filter() {
    if (tally_.exceeded()) return wanted_end_;
    const std::size_t end = used(), begin = wanted_end_;
    wanted_end_ = filter_.keep(pairs_, begin, end);
    tally_.add(wanted_end_ - begin, end - begin);
    return wanted_end_;
  }

 private:
  static constexpr std::size_t kRoom = 65536;  // least number of pairs that fit in between two calls of filter()
  static constexpr std::size_t kLeast = 16;    // a kernel needs room for so many pairs before it writes

  kernels::Pair* data() const { return reinterpret_cast<kernels::Pair*>(pairs_.data()); }
  std::size_t used() const { return static_cast<std::size_t>(sink_.next - data()); }
  void point(std::size_t used) {
    sink_.next = data() + used;
    sink_.limit = data() + pairs_.size();
  }
  void makeRoom() {
    const std::size_t bound = tally_.bound().pairs;
    const std::size_t largest = bound < PairBound::kNone - kRoom ? bound + kRoom : PairBound::kNone;
    if (pairs_.size() + kLeast <= largest) {
      const std::size_t end = used();
      // Stays within the capacity if it can, so nothing is allocated. Does not use all of it at once, because resize()
      // writes zeros.
      const std::size_t most = pairs_.capacity() - pairs_.size() >= kLeast ? pairs_.capacity() : largest;
      pairs_.resize(std::min({2 * pairs_.size(), most, largest}));
      return point(end);
    }
    point(filter());
    if (!tally_.exceeded()) return;
    sink_.full = true;
    point(0);
  }
  static void grow(kernels::PairSink* sink) { static_cast<PairWriter*>(sink->owner)->makeRoom(); }

  std::vector<ProxyPair>& pairs_;
  std::size_t wanted_end_;  // all pairs before this index are filtered and counted
  const CombinedFilter& filter_;
  Tally& tally_;
  kernels::PairSink sink_{};
};

}  // namespace hgrid
