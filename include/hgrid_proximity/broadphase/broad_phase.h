// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <limits>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase_reader.h"

namespace hgrid {

/// Selects the overlapping pairs that a broad phase reports.
///
/// Any thread may call it. The broad phase may remember the answer for a pair while neither box moves, so the answer
/// for a pair must not change. (PairFilter is something else: it decides which pairs of bodies exist.)
struct OverlapFilter {
  /// Moves the kept ones of `count` pairs to the front, in their order, and returns their number. Null keeps all.
  std::size_t (*keep)(const void* context, ProxyPair* pairs, std::size_t count) = nullptr;
  const void* context = nullptr;

  /// The same for the pairs from `begin` to `end`. @returns the end of the kept ones
  ProxyPair* operator()(ProxyPair* begin, ProxyPair* end) const {
    return keep == nullptr ? end : begin + keep(context, begin, static_cast<std::size_t>(end - begin));
  }

  /// A filter that calls a function for each pair.
  template <bool (*isKept)(const void* context, ProxyId first, ProxyId second)>
  static OverlapFilter of(const void* context) {
    return {[](const void* context, ProxyPair* pairs, std::size_t count) {
              std::size_t kept = 0;
              for (std::size_t i = 0; i < count; ++i) {
                const ProxyPair pair = pairs[i];
                pairs[kept] = pair;  // Store unconditionally and advance by 0 or 1: a branch would be mispredicted.
                kept += isKept(context, pair.first, pair.second) ? 1 : 0;
              }
              return kept;
            },
            context};
  }
};

/// Bounds the work and the memory of BroadPhaseReader::boundedPairs().
///
/// A search that would exceed the bound collects pairs in a fixed order instead. It goes through the boxes that are not
/// fixed, in the order of their ids. For each box it looks at the overlapping boxes that are fixed or have a larger id,
/// in the order of their ids. Pairs of two fixed boxes do not count.
struct PairBound {
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  std::size_t pairs = kNone;     ///< largest number of pairs that a search returns
  std::size_t overlaps = kNone;  ///< largest number of overlapping pairs that it looks at before the overlap filter
};

/// A set of boxes that can be changed.
///
/// One thread may change it at a time. Wrong use throws std::invalid_argument. A change that throws, also for lack of
/// memory, has changed nothing. A box is valid if isValid() accepts it.
///
/// What a new partition has to implement: single and bulk changes, the three settings, and the questions of
/// BroadPhaseReader that have no default.
class BroadPhase : public BroadPhaseReader {
 public:
  /// @throws std::invalid_argument if `id` is stored already or the box is not valid.
  virtual void insert(ProxyId id, const Aabb& box) = 0;
  /// Moves a box. @throws std::invalid_argument if `id` is not stored or the box is not valid.
  virtual void update(ProxyId id, const Aabb& box) = 0;
  /// @throws std::invalid_argument if `id` is not stored.
  virtual void remove(ProxyId id) = 0;
  /// Removes all boxes. The settings stay.
  virtual void clear() = 0;

  /// Bulk update: afterwards exactly these boxes are stored, boxes[i] under ids[i]. The ids ascend.
  /// @throws std::invalid_argument if the arrays differ in length, the ids do not ascend or a box is not valid.
  virtual void update(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) = 0;
  /// Bulk move: the box of ids[i] becomes boxes[i]; all other boxes stay. The ids ascend. HGrid's cost depends on the
  /// number of boxes that move, not on the number that is stored.
  /// @throws std::invalid_argument as above, or if an id is not stored.
  virtual void move(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) = 0;

  /// Sets which boxes make no pairs among each other. The ids ascend. They need not be stored yet.
  /// @throws std::invalid_argument if the ids do not ascend.
  virtual void setFixed(const std::vector<ProxyId>& ids) = 0;
  /// Sets the filter of all later searches for pairs.
  virtual void setOverlapFilter(const OverlapFilter& filter) = 0;
  /// Sets the bound of all later calls of boundedPairs(). Initially there is none.
  virtual void setPairBound(const PairBound& bound) = 0;
};

}  // namespace hgrid
