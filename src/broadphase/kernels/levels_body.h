// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The levels that a search needs.
// Part of kernels_body.h, which says what Simd is.
#pragma once

#include "broadphase/kernels/kernels.h"

namespace hgrid {
namespace kernels {
namespace {

/// Calls visit(number) for the levels below the boxes begin .. end - 1 of a tier whose bounds pass the test, in ascending
/// order. Boxes far from the search cost one test for as many as there are lanes.
/// @param test  as in uint32_t test(const Columns&, position, count): bit k says whether box position + k passes, for the
///              k below both `count` and kWidth
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

/// The same for all levels of a set.
template <class Test, class Visit>
inline void visitLevels(const LevelSet& set, const Test& test, const Visit& visit) {
  if (set.tier_count > 0) {
    return visitTier(set, set.tier_count - 1, 0, set.tiers[set.tier_count - 1].count, test, visit);
  }
  for (std::uint32_t number = 0; number < set.count; ++number) visit(number);
}

}  // namespace
}  // namespace kernels
}  // namespace hgrid
