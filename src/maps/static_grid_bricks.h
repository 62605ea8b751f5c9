// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hgrid_proximity/geometry/aabb.h"
#include "hgrid_proximity/geometry/voxel.h"
#include "maps/brick.h"

namespace hgrid {

/// Returns the box of a voxel in keys, relative to the origin of the map.
inline Aabb keysOf(const Voxel& voxel) {
  const auto along = static_cast<float>(keysAlong(voxel));
  constexpr int kOrigin = Voxel::kOriginKey;
  const Eigen::Vector3i key(voxel.x - kOrigin, voxel.y - kOrigin, voxel.z - kOrigin);
  const Eigen::Vector3f min = key.cast<float>();  // a float holds every key exactly
  return {min, min + Eigen::Vector3f::Constant(along)};
}

constexpr int kBrickLevels = Voxel::kLevels / 2;

/// All bricks of one level. The cells of these bricks have an edge of 4^level finest edges. Each array has one element
/// per brick.
struct BrickLevel {
  std::vector<std::uint64_t> cells;  // bit set of the cells that are not empty
  // Bit set of the cells that are voxels. Every other cell in `cells` is a brick of the level below. This array is
  // empty on level 0, because all cells of level 0 are voxels.
  std::vector<std::uint64_t> full;
  std::vector<std::uint32_t> first_below;  // index of the first brick inside this brick; empty on level 0
  std::vector<std::uint8_t> blocks;        // bit b is set if the cells 8 b .. 8 b + 7 together are one voxel
};

/// A brick, given by its level, its index in the arrays of this level, and its corner.
struct Brick {
  int level;
  std::uint32_t number;
  std::array<std::int32_t, 3> corner;  // minimum corner in keys, relative to the origin of the map
};

/// The storage of a StaticGrid. Everything is inline, because searches spend most of their time here.
class Bricks {
 public:
  /// Returns the cells of a brick that are not empty, as a bit set.
  std::uint64_t cellsOf(const Brick& brick) const {
    return levels[static_cast<std::size_t>(brick.level)].cells[brick.number];
  }
  /// Returns the cells of a brick that are voxels, as a bit set.
  std::uint64_t fullOf(const Brick& brick) const;
  /// Returns the brick of the level below that fills a cell of `brick`.
  Brick below(const Brick& brick, unsigned cell) const;
  /// Returns the voxel that a full cell belongs to.
  Voxel voxelAt(const Brick& brick, unsigned cell) const;
  /// Returns all cells of the voxel that a full cell belongs to, as a bit set.
  std::uint64_t cellsOfVoxel(const Brick& brick, unsigned cell) const;

  bool is_whole = false;  ///< whether one voxel is the whole map; it is stored as eight blocks
  std::array<BrickLevel, kBrickLevels> levels;
  /// The smallest brick that contains all voxels. Searches start here.
  Brick start{kBrickLevels - 1, 0, {-Voxel::kOriginKey, -Voxel::kOriginKey, -Voxel::kOriginKey}};
};

inline std::uint64_t Bricks::fullOf(const Brick& brick) const {
  const BrickLevel& level = levels[static_cast<std::size_t>(brick.level)];
  return brick.level == 0 ? level.cells[brick.number] : level.full[brick.number];
}

inline Brick Bricks::below(const Brick& brick, unsigned cell) const {
  const BrickLevel& level = levels[static_cast<std::size_t>(brick.level)];
  const std::uint64_t with_brick = level.cells[brick.number] & ~level.full[brick.number];
  const auto before = static_cast<std::uint32_t>(bitCount(with_brick & ((std::uint64_t{1} << cell) - 1)));
  Brick result{brick.level - 1, level.first_below[brick.number] + before, brick.corner};
  for (int axis = 0; axis < 3; ++axis)
    result.corner[static_cast<std::size_t>(axis)] += cellAlong(cell, axis) << 2 * brick.level;
  return result;
}

inline Voxel Bricks::voxelAt(const Brick& brick, unsigned cell) const {
  if (is_whole) return {0, 0, 0, Voxel::kLevels};
  const bool is_block = levels[static_cast<std::size_t>(brick.level)].blocks[brick.number] >> cell / 8 & 1u;
  if (is_block) cell &= ~7u;
  const auto key = [&](int axis) {
    return static_cast<std::uint16_t>(brick.corner[static_cast<std::size_t>(axis)] + Voxel::kOriginKey +
                                      (cellAlong(cell, axis) << 2 * brick.level));
  };
  return {key(0), key(1), key(2), static_cast<std::uint8_t>(2 * brick.level + (is_block ? 1 : 0))};
}

inline std::uint64_t Bricks::cellsOfVoxel(const Brick& brick, unsigned cell) const {
  if (is_whole) return ~std::uint64_t{0};
  const bool is_block = levels[static_cast<std::size_t>(brick.level)].blocks[brick.number] >> cell / 8 & 1u;
  return is_block ? std::uint64_t{0xff} << (cell & ~7u) : std::uint64_t{1} << cell;
}

}  // namespace hgrid
