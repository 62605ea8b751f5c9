// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Searches the tiers of a LevelSet for the levels, or the ranges of boxes, that a search needs.
// This is a part of kernels_body.h, which explains the type Simd.
#pragma once

#include "broadphase/kernels/kernels.h"

namespace hgrid {
namespace kernels {
namespace {

/// Calls visit(number) for each leaf that passes the test, in ascending order. `number` is the index of the leaf.
/// Considers only the boxes begin .. end - 1 of the given tier and the boxes below them. Tests kWidth boxes at once.
/// @param test  called as uint32_t test(const Columns&, position, count). Bit k of the result says whether the box at
///              position + k passes. Bit k is 0 for k >= count and for k >= kWidth.
template <class Test, class Visit>
void visitTier(const LevelSet& set, int tier, std::uint32_t begin, std::uint32_t end, const Test& test,
               const Visit& visit) {
  const Tier& boxes = set.tiers[tier];
  for (std::uint32_t j = begin; j < end; j += Simd::kWidth) {
    for (std::uint32_t bits = test(boxes, j, end - j); bits != 0; bits &= bits - 1) {
      const std::uint32_t number = j + static_cast<std::uint32_t>(__builtin_ctz(bits));
      if (tier == 0) {
        visit(number);
      } else {
        const std::uint32_t first = number * Tier::kFan, below = set.tiers[tier - 1].count;
        visitTier(set, tier - 1, first, first + Tier::kFan < below ? first + Tier::kFan : below, test, visit);
      }
    }
  }
}

/// Calls visit(number) for each leaf of a set that passes the test, in ascending order. If the set has no tiers, calls
/// it for every level.
template <class Test, class Visit>
inline void visitLeaves(const LevelSet& set, const Test& test, const Visit& visit) {
  if (set.tier_count > 0) {
    return visitTier(set, set.tier_count - 1, 0, set.tiers[set.tier_count - 1].count, test, visit);
  }
  for (std::uint32_t number = 0; number < set.count; ++number) visit(number);
}

/// A range of positions of boxes in a level.
struct PositionRange {
  std::uint32_t begin, end;
};

/// Returns the positions of the boxes that a leaf contains. per_leaf of the set must not be 0.
inline PositionRange rangeOf(const LevelSet& set, std::uint32_t number) {
  const std::uint32_t begin = number * set.per_leaf, end = set.levels->end;
  return {begin, end - begin < set.per_leaf ? end : begin + set.per_leaf};
}

}  // namespace
}  // namespace kernels
}  // namespace hgrid
