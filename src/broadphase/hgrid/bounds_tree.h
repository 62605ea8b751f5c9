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

/// A hierarchy of the bounds of a layer's levels, or of the boxes of one level. With it, a search quickly finds the
/// few levels or boxes that it needs.
///
/// The hierarchy is a tree of bounding volumes (Ericson 2005, chapter 6), stored in tiers. The boxes of the first tier
/// are the bounds of the levels, or each contains kPerBlock successive boxes of the level. Each box of a higher tier
/// contains 16 successive boxes of the tier below. These boxes are near each other, because successive levels belong to
/// neighboring regions, and successive boxes of a row are in neighboring cells.
class BoundsTree {
 public:
  /// How many boxes of a level a box of the first tier contains, see setBlocks().
  static constexpr std::uint32_t kPerBlock = 32;

  /// Allocates the memory that set() needs for this number of levels.
  void reserve(std::size_t levels);
  /// Allocates the memory that setBlocks() needs for a level with this number of boxes.
  void reserveBlocks(std::size_t boxes) { reserve((boxes + kPerBlock - 1) / kPerBlock); }
  /// Computes the hierarchy for these levels. Allocates nothing after reserve() for at least as many levels.
  void set(const std::vector<kernels::Level>& levels);
  /// Computes the hierarchy for the boxes of a level that begins at position 0. Allocates nothing after
  /// reserveBlocks() for at least as many boxes. Boxes that are withdrawn later stay in the bounds.
  void setBlocks(const kernels::Level& level);

  /// Returns `levels` together with the hierarchy. They must be the levels that were passed to set(), or only the level
  /// that was passed to setBlocks().
  kernels::LevelSet over(const std::vector<kernels::Level>& levels) const {
    return {levels.data(), static_cast<std::uint32_t>(levels.size()), tiers_.data(), tier_count_, per_box_};
  }

  /// Calls visit(index, box) for each box of the first tier that passes the test, in ascending order.
  /// @param test  called as bool test(const kernels::Box&). If it accepts a box, it must accept every box that contains
  ///              this box.
  template <class Test, class Visit>
  void visit(const Test& test, const Visit& visit) const {
    if (tier_count_ > 0)
      visitTier(tier_count_ - 1, 0, tiers_[static_cast<std::size_t>(tier_count_ - 1)].count, test, visit);
  }

  std::size_t bytes() const { return bounds_.capacity() * sizeof(float); }

 private:
  static constexpr int kMostTiers = 8;            // enough for 16^8 boxes in the first tier
  static constexpr std::size_t kReadBeyond = 16;  // floats that a kernel may read beyond the last box

  static std::size_t valuesFor(std::size_t boxes);
  static kernels::Box boxAt(const kernels::Tier& tier, std::uint32_t number) {
    const float* const bound = tier.bounds + number;
    return {{bound[0], bound[tier.stride], bound[2 * tier.stride]},
            {bound[3 * tier.stride], bound[4 * tier.stride], bound[5 * tier.stride]}};
  }
  template <class BoxOf>
  void build(std::size_t boxes, const BoxOf& box_of);

  template <class Test, class Visit>
  void visitTier(int tier, std::uint32_t begin, std::uint32_t end, const Test& test, const Visit& visit) const {
    for (std::uint32_t number = begin; number < end; ++number) {
      const kernels::Box box = boxAt(tiers_[static_cast<std::size_t>(tier)], number);
      if (!test(box)) continue;
      if (tier == 0) {
        visit(number, box);
      } else {
        const std::uint32_t first = number * kernels::Tier::kFan;
        const std::uint32_t below = tiers_[static_cast<std::size_t>(tier - 1)].count;
        visitTier(tier - 1, first, std::min(first + kernels::Tier::kFan, below), test, visit);
      }
    }
  }

  std::vector<float> bounds_;  // [m] the boxes of all tiers
  std::array<kernels::Tier, kMostTiers> tiers_{};
  int tier_count_ = 0;
  std::uint32_t per_box_ = 0;  // boxes of the level in each box of the first tier; 0: it is the bounds of a level
};

}  // namespace hgrid
