// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <limits>

#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {

/// How many pairs a tick works with; all limits follow from SceneOptions::max_pairs.
struct PairLimits {
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  std::size_t listed = kNone;      ///< pairs of bodies that a snapshot lists
  std::size_t remembered = kNone;  ///< pairs of bodies that are remembered from tick to tick
  std::size_t collected = kNone;  ///< pairs of boxes, and of boxes with maps, that are collected before they are sorted

  /// @param max_pairs  0: no limits
  static PairLimits of(std::size_t max_pairs) {
    if (max_pairs == 0) return {};
    // Bodies have several boxes, and there must be more pairs than are listed to choose the nearest of them. The floor
    // costs little and makes small limits cut as late as large ones.
    constexpr std::size_t kShare = 4, kFloor = 65536, kMost = std::size_t{1} << 40;
    const std::size_t listed = std::min(max_pairs, kMost);
    return {listed, kShare * listed, std::max(kShare * listed, kFloor)};
  }

  /// The bound of the search for pairs of so many boxes. A pile of boxes whose pairs are all switched off costs no more
  /// than a few searches that meet the limit.
  PairBound boundOf(std::size_t boxes) const {
    if (collected == kNone) return {};
    return {collected, 16 * collected + 32 * boxes};
  }
};

}  // namespace hgrid
