// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadphase/kernels/kernels.h"

namespace hgrid {

/// A hierarchy of the bounds of a layer's levels. A search finds the few levels that it needs in it, although a divided
/// layer may have thousands of levels.
///
/// It is a tree of bounding volumes (Ericson 2005, chapter 6) that is stored by tiers: 16 levels, or 16 boxes of a tier,
/// share one box of the next tier. Levels that follow each other belong to neighboring regions.
class LevelBounds {
 public:
  /// Allocates what set() of `levels` levels needs.
  void reserve(std::size_t levels);
  /// Sets the bounds of the levels. Allocates nothing after reserve() of as many levels.
  void set(const std::vector<kernels::Level>& levels);

  /// The levels with their bounds.
  kernels::LevelSet over(const std::vector<kernels::Level>& levels) const {
    return {levels.data(), static_cast<std::uint32_t>(levels.size()), tiers_.data(), tier_count_};
  }

  /// Calls visit(number) for the levels whose bounds pass the test, in ascending order.
  /// @param test  as in bool test(const kernels::Box&); if it holds for a box, then also for all boxes that contain it
  template <class Test, class Visit>
  void visit(const Test& test, const Visit& visit) const {
    if (tier_count_ > 0) visitTier(tier_count_ - 1, 0, tiers_[static_cast<std::size_t>(tier_count_ - 1)].count, test, visit);
  }

  std::size_t bytes() const { return bounds_.capacity() * sizeof(float); }

 private:
  static constexpr int kMostTiers = 8;  // 16^8 levels
  static constexpr std::size_t kReadBeyond = 16;

  static std::size_t valuesFor(std::size_t levels);
  static kernels::Box boxAt(const kernels::Tier& tier, std::uint32_t number) {
    const float* const bound = tier.bounds + number;
    return {{bound[0], bound[tier.stride], bound[2 * tier.stride]},
            {bound[3 * tier.stride], bound[4 * tier.stride], bound[5 * tier.stride]}};
  }

  template <class Test, class Visit>
  void visitTier(int tier, std::uint32_t begin, std::uint32_t end, const Test& test, const Visit& visit) const {
    for (std::uint32_t number = begin; number < end; ++number) {
      if (!test(boxAt(tiers_[static_cast<std::size_t>(tier)], number))) continue;
      if (tier == 0) {
        visit(number);
      } else {
        const std::uint32_t first = number * kernels::Tier::kFan;
        const std::uint32_t below = tiers_[static_cast<std::size_t>(tier - 1)].count;
        visitTier(tier - 1, first, std::min(first + kernels::Tier::kFan, below), test, visit);
      }
    }
  }

  std::vector<float> bounds_;  // of all tiers
  std::array<kernels::Tier, kMostTiers> tiers_{};
  int tier_count_ = 0;
};

}  // namespace hgrid
