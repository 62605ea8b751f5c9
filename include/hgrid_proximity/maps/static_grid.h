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

/// A voxel and its distance.
struct NearVoxel {
  Voxel voxel;            ///< the voxel
  double distance = 0.0;  ///< [m] from the box of the query to the voxel
};

class Bricks;

/// The voxel that a segment touches first.
struct VoxelTouch {
  Voxel voxel;         ///< the voxel
  double along = 0.0;  ///< [m] distance along the segment to the first contact
};

/// Stores the occupied voxels of a map in a hierarchical grid (Ericson, Real-Time Collision Detection, 2005, section
/// 7.2) whose cells are single bits.
///
/// - A brick is a cube of 4 x 4 x 4 cells, stored as 64 bits. A cell that is only partly occupied is one brick of the
///   level below, whose cells are four times finer.
/// - The edge of a voxel selects its level. A voxel is stored as one cell, or as a block of 2 x 2 x 2 cells. So two
///   depths of an octree share one level.
/// - Empty space costs only one bit of the brick around it. Three ANDs, one for each axis, select a range of cells in a
///   brick.
/// - Bricks are stored in Morton order, and the bricks inside one brick are stored one after the other. So a search
///   compares no keys and computes no hashes, and one pass in Morton order builds the grid.
///
/// Coordinates are in the frame of the map [m]. A query never misses a voxel that it touches, and it may return voxels
/// that it misses by less than 1e-9 of the coordinates. The grid is immutable, so any number of threads may call it at
/// the same time. Copies share memory.
class StaticGrid {
 public:
  /// @param finest_edge  [m] edge of a voxel of level 0
  /// @param voxels       disjoint and in Morton order; all keys are multiples of the voxel's edge
  /// @throws Refusal with code out_of_range if `finest_edge` is not positive; bad_geometry for the first voxel that
  /// breaks a rule
  StaticGrid(double finest_edge, const std::vector<Voxel>& voxels);

  double finestEdge() const { return finest_edge_; }      ///< [m] edge of a voxel of level 0
  std::size_t size() const { return size_; }              ///< number of voxels
  std::size_t bytes() const;                              ///< [bytes] memory that the grid uses
  Eigen::AlignedBox3d bounds() const { return bounds_; }  ///< [m] box around all voxels; empty if there are none

  /// Returns all voxels in Morton order.
  std::vector<Voxel> voxels() const;
  /// Replaces `found` with the voxels that the box touches, in Morton order.
  /// @returns false if there are more than `most`; then `found` has only the first `most` of them
  bool overlapping(const Eigen::AlignedBox3d& box, std::size_t most, std::vector<Voxel>& found) const;
  /// Replaces `found` with the voxels that the sphere touches, in Morton order.
  /// @returns false if there are more than `most`; then `found` has only the first `most` of them
  bool overlapping(const Sphere& sphere, std::size_t most, std::vector<Voxel>& found) const;
  /// Whether the sphere touches any voxel.
  bool touches(const Sphere& sphere) const;
  /// Returns the voxel that the segment touches first, or nullopt if it touches none.
  /// @param error  [m] bound of the error of the segment; a voxel that the segment misses by less counts as touched
  std::optional<VoxelTouch> firstAlong(const Segment& segment, double error = 0.0) const;
  /// Replaces `found` with the `count` voxels that are nearest to the box and within `limit` [m], nearest first. The
  /// box may be a single point. If more than `count` voxels are equally near, the voxels that the search reaches first
  /// are kept.
  void nearest(const Eigen::AlignedBox3d& box, std::size_t count, double limit, std::vector<NearVoxel>& found) const;

  /// Receives a voxel and its distance from the box [m]. Returns the new limit [m] of the search.
  using Look = std::function<double(const Voxel& voxel, double distance)>;
  /// Calls `look` for voxels within `limit` [m] of a box, roughly in the order of their distance. Each call may lower
  /// the limit. The search ends when no remaining voxel is within the limit.
  void visitNear(const Eigen::AlignedBox3d& box, double limit, const Look& look) const;

 private:
  double finest_edge_;
  std::size_t size_;
  Eigen::AlignedBox3d bounds_;
  std::shared_ptr<const Bricks> bricks_;
};

}  // namespace hgrid
