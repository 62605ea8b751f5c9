// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <limits>

#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {

/// Limits for the numbers of pairs in a tick, computed from SceneOptions::max_pairs.
struct PairLimits {
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  std::size_t listed = kNone;      ///< pairs of bodies that a snapshot lists
  std::size_t remembered = kNone;  ///< pairs of bodies that the scene remembers from tick to tick
  std::size_t collected = kNone;   ///< pairs of two boxes, or of a box and a map, that a tick collects before sorting

  /// Computes the limits for a value of SceneOptions::max_pairs. @param max_pairs  0: no limits
  static PairLimits of(std::size_t max_pairs) {
    if (max_pairs == 0) return {};
    // A tick must collect more pairs than it lists, for two reasons: a pair of bodies can have several pairs of boxes,
    // and the tick lists only the nearest of the collected pairs. kFloor costs little memory. Without it, a small
    // max_pairs would stop the search too early.
    constexpr std::size_t kShare = 4, kFloor = 65536, kMost = std::size_t{1} << 40;
    const std::size_t listed = std::min(max_pairs, kMost);
    return {listed, kShare * listed, std::max(kShare * listed, kFloor)};
  }

  /// Returns the bound of a search for pairs among this number of boxes. The bound of PairBound::overlaps also limits
  /// the time if many boxes overlap and all their pairs are switched off.
  PairBound boundOf(std::size_t boxes) const {
    if (collected == kNone) return {};
    return {collected, 16 * collected + 32 * boxes};
  }
};

}  // namespace hgrid
