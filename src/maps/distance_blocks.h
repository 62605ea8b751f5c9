// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "geometry/four_lanes.h"
#include "hgrid_proximity/maps/static_grid.h"

namespace hgrid {

/// Tells quickly that points are far from all voxels of a map.
///
/// It has one number for each cell, a cube with the edge of the finest voxels: the square of the distance [half edges]
/// from the center of the cell to the nearest voxel. Distances above kFarthest are stored as kFarthest. A block of 8 x
/// 8 x 8 cells is computed when a point in it is first asked for, in about 10 us. Each block is computed along x, then
/// y, then z (Felzenszwalb and Huttenlocher 2012, "Distance transforms of sampled functions"). Blocks that are far from
/// all voxels share memory.
///
/// Any number of threads may ask at the same time. A thread that needs a new block waits while another thread computes
/// one. After kMostBlocks blocks, no more are computed, and bounds in the others are 0.
class DistanceBlocks {
 public:
  static constexpr float kFarthest = 6.5f;              ///< [finest edges] largest distance that is stored
  static constexpr std::size_t kMostBlocks = 1u << 15;  ///< so many blocks are kept, which takes 16 MiB

  /// @param grid  the map; a copy is kept, which shares memory
  explicit DistanceBlocks(const StaticGrid& grid);
  ~DistanceBlocks();
  DistanceBlocks(const DistanceBlocks&) = delete;
  DistanceBlocks& operator=(const DistanceBlocks&) = delete;

  /// Returns whether the map has few enough blocks. If not, all bounds are 0.
  bool isKnown() const { return block_counts_[0] > 0 || grid_.size() == 0; }
  /// Returns the point [m, map frame] to which points are relative. It is near the voxels, which keeps rounding errors
  /// small.
  const Eigen::Vector3d& corner() const { return corner_; }
  /// Returns the unit of lengths [m].
  double edge() const { return grid_.finestEdge(); }
  /// Returns for four points a lower bound of the distance to the nearest voxel, in finest edges.
  /// @param points  for each axis: coordinates relative to corner(), in finest edges
  Four lowerBounds(const Four (&points)[3]) const;

 private:
  static constexpr std::int32_t kEdge = 8;    // cells along an edge of a block
  static constexpr std::int32_t kMargin = 6;  // cells around a block whose voxels are looked at
  struct Block;

  std::size_t places() const;
  std::atomic<const Block*>* table() const;
  const Block* made(std::size_t number) const;
  bool fill(const std::array<std::int32_t, 3>& first, Block& block) const;

  StaticGrid grid_;
  std::array<std::int32_t, 3> first_cell_{};    // cell at corner_, in keys from the origin of the map
  std::array<std::int32_t, 3> block_counts_{};  // number of blocks along each axis; 0: no block is ever made
  std::array<float, 3> cell_counts_{};          // number of cells along each axis
  Eigen::Vector3d corner_ = Eigen::Vector3d::Zero();
  mutable std::mutex mutex_;                                        // held while blocks are made
  mutable std::atomic<std::atomic<const Block*>*> table_{nullptr};  // blocks_; null until it is needed
  mutable std::atomic<bool> full_{false};                           // whether kMostBlocks blocks are kept
  mutable std::unique_ptr<std::atomic<const Block*>[]> blocks_;     // an element is null until its block is made
  mutable std::vector<std::unique_ptr<const Block>> made_;
};

}  // namespace hgrid
