// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hgrid_proximity/geometry/sphere.h"
#include "hgrid_proximity/maps/static_grid.h"

namespace hgrid {

struct Brick;

/// Answers whether spheres touch a voxel of a map. For many small spheres it is faster than StaticGrid::touches().
///
/// The table is an array over the box around all voxels (a grid as in Ericson, Real-Time Collision Detection, 2005,
/// section 7.1.3). It has one element for each brick, a cube of 4 x 4 x 4 finest voxels. The element of a brick with
/// voxels leads to its occupied cells. The element of an empty brick is the distance to the nearest brick with voxels:
/// the largest of the distances along x, y and z, counted in bricks up to 5 (Rosenfeld and Pfaltz 1968, "Distance
/// functions on digital pictures"). So most spheres in free space need only one element.
///
/// The map itself answers for spheres with a diameter of 5 bricks or more. If the box has more than 2^24 bricks, there
/// is no table (see hasTable()), and the map answers for all spheres. An element takes 4 bytes, so the elements take at
/// most 64 MiB. The table is immutable, so any number of threads may call it at the same time.
class TouchTable {
 public:
  /// Takes time proportional to the number of voxels plus the number of bricks in the box around them.
  /// @param grid  the map; the table keeps a copy, which shares memory
  explicit TouchTable(const StaticGrid& grid);

  /// Whether the sphere [m, map frame] touches any voxel. Returns the same as StaticGrid::touches().
  bool touches(const Sphere& sphere) const;
  /// Replaces `touched` with one number for each sphere: 1 if it touches a voxel, otherwise 0.
  void touches(const std::vector<Sphere>& spheres, std::vector<std::uint8_t>& touched) const;

  const StaticGrid& grid() const { return grid_; }      ///< the map
  bool hasTable() const { return !elements_.empty(); }  ///< whether small spheres are answered without the map
  std::size_t bytes() const;                            ///< [bytes] memory of the table, without the map

 private:
  struct Span;
  bool spanOf(const Sphere& sphere, Span& span) const;
  bool touches(const Span& span) const;
  void fill(const Brick& brick);
  void writeDistances();

  StaticGrid grid_;
  std::array<std::int32_t, 3> corner_{};  // [finest edges] minimum corner of the array, from the origin of the map
  std::array<std::int32_t, 3> counts_{};  // number of bricks along each axis
  std::vector<std::uint32_t> elements_;   // for each brick; below 2^31: index into cells_; otherwise 2^31 + distance
  std::vector<std::uint64_t> cells_;      // sets of occupied cells, see maps/brick.h; first a full and an empty set
};

}  // namespace hgrid
