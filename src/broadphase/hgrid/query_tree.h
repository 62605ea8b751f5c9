// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "broadphase/hgrid/layer.h"
#include "broadphase/kernels/kernels.h"

namespace hgrid {

/// A tree over the boxes of a layer, for many queries between two changes. It has copies of the boxes, so it is valid
/// until the layer changes. See kernels::BoxTree.
///
/// The tree is built from the root down. If a node has more than 512 boxes, they are divided into up to 16 parts where
/// this makes the bounds of the parts small, by the surface area heuristic (Goldsmith and Salmon, "Automatic Creation
/// of Object Hierarchies for Ray Tracing", 1987) with bins along the longest axis (Wald, "On fast Construction of
/// SAH-based Bounding Volume Hierarchies", 2007). The boxes below the root are divided into up to 32 parts if this
/// saves time. At most 512 boxes are divided at medians, so that all leaves of such a part but the last are full.
///
/// A "slot" is the place of a box in the leaves.
class QueryTree {
 public:
  /// Builds the tree for the boxes of a layer that are not withdrawn. If this throws, the tree must not be used.
  /// @throws std::bad_alloc
  void build(const Layer& layer);

  /// Returns the tree for the kernels.
  const kernels::BoxTree& view() const { return view_; }
  /// Returns the box in a slot.
  Aabb boxAt(std::uint32_t slot) const {
    return boxIn(leaves_[slot / kernels::TreeBlock::kBoxes], slot % kernels::TreeBlock::kBoxes);
  }
  /// Returns the id of the box in a slot.
  ProxyId idAt(std::uint32_t slot) const {
    return leaves_[slot / kernels::TreeBlock::kBoxes].below[slot % kernels::TreeBlock::kBoxes];
  }
  /// Returns the allocated memory [bytes].
  std::size_t bytes() const { return (inner_.capacity() + leaves_.capacity()) * sizeof(kernels::TreeBlock); }

  /// @param layer  the layer that build() received, unchanged
  /// @throws std::logic_error that names the first violated invariant
  void checkInvariants(const Layer& layer) const;

 private:
  static Aabb boxIn(const kernels::TreeBlock& block, std::uint32_t lane) {
    return {{block.bounds[0][lane], block.bounds[1][lane], block.bounds[2][lane]},
            {block.bounds[3][lane], block.bounds[4][lane], block.bounds[5][lane]}};
  }

  std::vector<kernels::TreeBlock> inner_, leaves_;
  kernels::BoxTree view_{};
};

}  // namespace hgrid
