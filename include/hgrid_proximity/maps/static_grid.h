// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Geometry>
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

class Bricks;

/// The voxel that a segment touches first, and where [m] along the segment.
struct VoxelTouch {
  Voxel voxel;
  double along = 0.0;
};

/// The occupied voxels of a map: a hierarchical grid (Ericson 2005, 7.2) whose cells are bits.
///
/// - A brick is a cube of 4 x 4 x 4 cells, stored as 64 bits. A cell of one level is a brick of the level below, whose
///   cells are four times finer.
/// - A voxel is stored on the level of its edge: as one cell, or as a block of 2 x 2 x 2 cells if its edge is twice
/// that
///   of a cell. So each depth of an octree has its level.
/// - Empty space costs no more than a bit of the brick around it. Three ANDs mask the bits of a cell range.
/// - Cells are stored in Morton order, and the bricks below a brick follow each other. So there are no keys to compare
///   and no hashes, and one pass in Morton order builds the grid.
///
/// Coordinates are in the map's frame [m]. An answer contains every voxel that touches, and may contain voxels that
/// miss by less than 1e-9 of the coordinates. Immutable: any number of threads may ask at the same time. Copies share
/// memory.
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
  /// The same for a sphere.
  bool overlapping(const Sphere& sphere, std::size_t most, std::vector<Voxel>& found) const;
  /// Whether the sphere touches any voxel.
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
  double finest_edge_;
  std::size_t size_;
  Eigen::AlignedBox3d bounds_;
  std::shared_ptr<const Bricks> bricks_;
};

}  // namespace hgrid
