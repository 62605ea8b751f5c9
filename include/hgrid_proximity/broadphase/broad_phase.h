// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <limits>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase_reader.h"

namespace hgrid {

/// Selects the overlapping pairs that a broad phase reports.
///
/// The broad phase may call the filter on any thread, also in the middle of a search. So the filter must not search
/// itself. The broad phase may remember the answer for a pair while neither box moves, so the filter must always give
/// the same answer for the same pair. Do not confuse it with PairFilter, which decides which pairs of bodies are
/// reported.
struct OverlapFilter {
  /// Selects among `count` pairs: moves the pairs that it keeps to the front, in their original order, and returns
  /// their number. Null: all pairs are kept.
  std::size_t (*keep)(const void* context, ProxyPair* pairs, std::size_t count) = nullptr;
  const void* context = nullptr;  ///< passed to `keep` in every call; not owned

  /// Applies `keep` to the pairs from `begin` to `end`. @returns the end of the pairs that are kept
  ProxyPair* operator()(ProxyPair* begin, ProxyPair* end) const {
    return keep == nullptr ? end : begin + keep(context, begin, static_cast<std::size_t>(end - begin));
  }

  /// Creates a filter that calls `isKept` for each pair and keeps the pairs for which it returns true.
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
/// A search that would exceed the bound collects pairs in the following order, until it reaches the bound. It goes
/// through the boxes that are not fixed, in the order of their ids. For each of them it looks at the overlapping boxes
/// that are fixed or have a larger id, in the order of their ids. Pairs of two fixed boxes do not count.
struct PairBound {
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();  ///< stands for "no bound"

  std::size_t pairs = kNone;     ///< largest number of pairs that a search returns
  std::size_t overlaps = kNone;  ///< largest number of overlapping pairs that a search looks at, before it filters them
};

/// A broad phase whose boxes can be changed.
///
/// Only one thread at a time may change it. Wrong use throws std::invalid_argument. A call that throws leaves the broad
/// phase unchanged, even if memory ran out. A box is valid if isValid() accepts it.
///
/// A new kind of broad phase has to implement the single and bulk changes, the three settings, and the queries of
/// BroadPhaseReader that have no default.
class BroadPhase : public BroadPhaseReader {
 public:
  /// @throws std::invalid_argument if `id` is stored already or the box is not valid.
  virtual void insert(ProxyId id, const Aabb& box) = 0;
  /// Moves a box. @throws std::invalid_argument if `id` is not stored or the box is not valid.
  virtual void update(ProxyId id, const Aabb& box) = 0;
  /// @throws std::invalid_argument if `id` is not stored.
  virtual void remove(ProxyId id) = 0;
  /// Removes all boxes and keeps the settings.
  virtual void clear() = 0;

  /// Bulk update: stores exactly these boxes, boxes[i] under ids[i], and removes all others. The ids must ascend.
  /// @throws std::invalid_argument if the arrays differ in length, the ids do not ascend or a box is not valid.
  virtual void update(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) = 0;
  /// Bulk move: replaces the box of ids[i] by boxes[i] and keeps all other boxes as they are. The ids must ascend. In
  /// an HGrid, the cost depends on the number of boxes that move, not on the number of stored boxes.
  /// @throws std::invalid_argument in the same cases as the bulk update, and if an id is not stored.
  virtual void move(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) = 0;

  /// Sets which boxes are fixed: two fixed boxes never form a pair. The ids must ascend. They need not be stored yet.
  /// @throws std::invalid_argument if the ids do not ascend.
  virtual void setFixed(const std::vector<ProxyId>& ids) = 0;
  /// Sets the filter that all later searches for pairs apply.
  virtual void setOverlapFilter(const OverlapFilter& filter) = 0;
  /// Sets the bound of all later calls of boundedPairs(). Initially there is no bound.
  virtual void setPairBound(const PairBound& bound) = 0;
};

}  // namespace hgrid
