// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "hgrid_proximity/geometry/segment.h"
#include "hgrid_proximity/geometry/sphere.h"
#include "hgrid_proximity/geometry/voxel.h"

namespace hgrid {

/// A voxel, and how far it is from what was asked [m].
struct NearVoxel {
  Voxel voxel;
  double distance = 0.0;
};

/// The voxel that a segment touches first, and where [m] along the segment.
struct VoxelTouch {
  Voxel voxel;
  double along = 0.0;
};

/// The occupied voxels of a map: a hierarchical grid (Ericson 2005, 7.2) of cells that are bits.
///
/// A brick is a cube of 4 x 4 x 4 cells, 64 bits. A cell of one level is a brick of the level below, whose cells are
/// four times finer. A voxel stands on the level of its edge: as one cell, or as a block of 2 x 2 x 2 where its edge is
/// twice that of a cell, so that each depth of an octree has its place. What is empty costs no more than a bit of the
/// brick around it; the bits in a range of cells are had by three ands. Cells stand in Morton order, bricks below a
/// brick beside each other, so that there are no keys to compare, no hashes, and one pass in Morton order builds it.
///
/// Coordinates are those of the map's frame [m]. Answers count what touches; what misses by less than 1e-9 of the
/// coordinates may be among them, nothing that touches is ever lost. Immutable: any number of threads may ask.
class StaticGrid {
 public:
  /// @param finest_edge  [m] of a voxel of level 0
  /// @param voxels       disjoint, in Morton order, keys multiples of their edges: as readers of OctoMaps give them
  /// @throws Refusal out_of_range (finest_edge not positive), bad_geometry (voxels that are not as said, with number)
  StaticGrid(double finest_edge, const std::vector<Voxel>& voxels);

  double finestEdge() const { return finest_edge_; }
  std::size_t size() const { return size_; }              ///< voxels
  std::size_t bytes() const;                              ///< of memory
  Eigen::AlignedBox3d bounds() const { return bounds_; }  ///< [m] around all voxels; empty if there are none

  /// All voxels in Morton order.
  std::vector<Voxel> voxels() const;
  /// Voxels that the box touches, in Morton order. @returns whether that is all; false: there are more than `most`
  bool overlapping(const Eigen::AlignedBox3d& box, std::size_t most, std::vector<Voxel>& found) const;
  /// The same for a ball.
  bool overlapping(const Sphere& sphere, std::size_t most, std::vector<Voxel>& found) const;
  /// Whether the ball touches any voxel.
  bool touches(const Sphere& sphere) const;
  /// The voxel that a segment, a capsule if it has a radius, touches first.
  std::optional<VoxelTouch> firstAlong(const Segment& segment) const;
  /// The `count` voxels nearest to a box (a point is one, too) within `limit` [m], nearest first; of equally near ones
  /// those that were found first.
  void nearest(const Eigen::AlignedBox3d& box, std::size_t count, double limit, std::vector<NearVoxel>& found) const;

  /// How far it is worth looking [m] from now on, told of a voxel that is `distance` from the box.
  using Look = std::function<double(const Voxel& voxel, double distance)>;
  /// Shows voxels within `limit` [m] of a box, the nearer ones mostly first, until nothing that is left is within what
  /// `look` returned last.
  void visitNear(const Eigen::AlignedBox3d& box, double limit, const Look& look) const;

 private:
  static constexpr int kBrickLevels = Voxel::kLevels / 2;

  /// Bricks whose cells have an edge of 4^level finest ones. Arrays by brick.
  struct BrickLevel {
    std::vector<std::uint64_t> cells;        // those that hold something
    std::vector<std::uint64_t> full;         // of them: voxels, the others have a brick; not on level 0, where all are
    std::vector<std::uint32_t> first_below;  // number of the brick below the first cell that has one; not on level 0
    std::vector<std::uint8_t> blocks;        // bit b: cells 8 b .. 8 b + 7 are one voxel
  };
  /// A brick and where it is.
  struct Brick {
    int level;
    std::uint32_t number;
    std::array<std::int32_t, 3> corner;  // keys, counted from the map's origin
  };
  class Builder;
  class Search;
  class LineSearch;

  std::uint64_t cellsOf(const Brick& brick) const {
    return levels_[static_cast<std::size_t>(brick.level)].cells[brick.number];
  }
  std::uint64_t fullOf(const Brick& brick) const;
  Brick below(const Brick& brick, unsigned cell) const;
  Voxel voxelAt(const Brick& brick, unsigned cell) const;
  std::uint64_t restOfVoxel(const Brick& brick, unsigned cell) const;

  double finest_edge_;
  std::size_t size_ = 0;
  bool is_whole_ = false;  // one voxel is the whole map: eight of half its edge, as it is stored
  Eigen::AlignedBox3d bounds_;
  std::array<BrickLevel, kBrickLevels> levels_;
  /// The deepest brick that holds everything: where searches start.
  Brick start_{kBrickLevels - 1, 0, {-Voxel::kOriginKey, -Voxel::kOriginKey, -Voxel::kOriginKey}};
};

}  // namespace hgrid
