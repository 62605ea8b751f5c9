// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <limits>

#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {

/// Limits of the numbers of pairs in a tick. All of them are computed from SceneOptions::max_pairs.
struct PairLimits {
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  std::size_t listed = kNone;      ///< pairs of bodies that a snapshot lists
  std::size_t remembered = kNone;  ///< pairs of bodies that the scene remembers from tick to tick
  std::size_t collected = kNone;   ///< pairs of two boxes, or of a box and a map, that a tick collects before sorting

  /// Computes the limits for a value of SceneOptions::max_pairs. @param max_pairs  0: no limits
  static PairLimits of(std::size_t max_pairs) {
    if (max_pairs == 0) return {};
    // A tick collects more pairs than it lists: a pair of bodies can have several pairs of boxes, and the nearest pairs
    // can only be chosen among more. kFloor costs little memory and keeps a small max_pairs from stopping the search.
    constexpr std::size_t kShare = 4, kFloor = 65536, kMost = std::size_t{1} << 40;
    const std::size_t listed = std::min(max_pairs, kMost);
    return {listed, kShare * listed, std::max(kShare * listed, kFloor)};
  }

  /// Returns the bound of a search for pairs among this number of boxes. It also limits the time for a pile of boxes
  /// whose pairs are all switched off.
  PairBound boundOf(std::size_t boxes) const {
    if (collected == kNone) return {};
    return {collected, 16 * collected + 32 * boxes};
  }
};

}  // namespace hgrid
