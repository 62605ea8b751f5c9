// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadphase/kernels/kernels.h"
#include "hgrid_proximity/geometry/aabb.h"

namespace hgrid {

/// Returns whether a box contains another one.
inline bool contains(const kernels::Box& outer, const Aabb& inner) {
  bool all = true;
  for (int axis = 0; axis < 3; ++axis) {
    all = all && outer.min[axis] <= inner.min[axis] && outer.max[axis] >= inner.max[axis];
  }
  return all;
}

/// A hierarchy of the bounds of a layer's levels, or of the bounds of the boxes of one level. A search uses it to find
/// quickly the few levels or boxes that it needs.
///
/// The hierarchy is a tree of bounding volumes (Ericson 2005, chapter 6), stored in tiers. The boxes of the first tier
/// are called leaves. Each leaf is the bounds of a level, or contains up to kPerLeaf successive boxes of the one level.
/// Each box of a higher tier contains 16 successive boxes of the tier below. These boxes are near each other, because
/// successive levels belong to neighboring regions, and successive boxes of a row are in neighboring cells.
class BoundsTree {
 public:
  /// Largest number of a level's boxes in one leaf, see setBoxes().
  static constexpr std::uint32_t kPerLeaf = 32;

  /// Allocates the memory that setLevels() needs for this number of levels.
  void reserveLevels(std::size_t levels) { reserve(levels); }
  /// Allocates the memory that setBoxes() needs for a level with this number of boxes.
  void reserveBoxes(std::size_t boxes) { reserve(leavesFor(boxes)); }
  /// Computes the hierarchy for these levels. Allocates nothing after reserveLevels() for at least as many levels.
  void setLevels(const std::vector<kernels::Level>& levels);
  /// Computes the hierarchy for the boxes of a level that begins at position 0. Allocates nothing after reserveBoxes()
  /// for at least as many boxes. Boxes that are withdrawn later stay in the bounds.
  void setBoxes(const kernels::Level& level);

  /// Returns `levels` together with the hierarchy. They must be the levels that were passed to setLevels(), or
  /// only the level that was passed to setBoxes().
  kernels::LevelSet over(const std::vector<kernels::Level>& levels) const {
    return {levels.data(), static_cast<std::uint32_t>(levels.size()), tiers_.data(), tier_count_, per_leaf_};
  }

  /// Returns a leaf of the hierarchy, which must not be empty.
  kernels::Box leaf(std::uint32_t number) const { return boxAt(tiers_[0], number); }

  /// Calls visit(index, box) for each leaf that passes the test, in ascending order.
  /// @param test  called as bool test(const kernels::Box&). If it accepts a box, it must accept every box that contains
  ///              this box.
  template <class Test, class Visit>
  void visit(const Test& test, const Visit& visit) const {
    if (tier_count_ > 0)
      visitTier(tier_count_ - 1, 0, tiers_[static_cast<std::size_t>(tier_count_ - 1)].count, test, visit);
  }

  std::size_t bytes() const { return bounds_.capacity() * sizeof(float); }

 private:
  static constexpr int kMostTiers = 8;            // enough for 16^8 leaves
  static constexpr std::size_t kReadBeyond = 16;  // floats that a kernel may read beyond the last box

  static std::size_t leavesFor(std::size_t boxes) { return (boxes + kPerLeaf - 1) / kPerLeaf; }
  static std::size_t valuesFor(std::size_t leaves);
  static kernels::Box boxAt(const kernels::Tier& tier, std::uint32_t number) {
    const float* const bound = tier.bounds + number;
    return {{bound[0], bound[tier.stride], bound[2 * tier.stride]},
            {bound[3 * tier.stride], bound[4 * tier.stride], bound[5 * tier.stride]}};
  }
  void reserve(std::size_t leaves);
  template <class LeafAt>
  void build(std::size_t leaves, const LeafAt& leaf_at);

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

  std::vector<float> bounds_;  // [m] the boxes of all tiers; may be larger than they need
  std::array<kernels::Tier, kMostTiers> tiers_{};
  int tier_count_ = 0;
  std::uint32_t per_leaf_ = 0;  // number of a level's boxes in a leaf; 0: each leaf is the bounds of a level
};

}  // namespace hgrid
