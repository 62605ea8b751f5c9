// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// How a StaticGrid is walked, brick by brick; inline, since every search does little else.
#pragma once

#include "hgrid_proximity/geometry/aabb.h"
#include "hgrid_proximity/maps/static_grid.h"
#include "maps/brick.h"

namespace hgrid {

/// A voxel in keys, counted from the map's origin.
inline Aabb keysOf(const Voxel& voxel) {
  const auto along = static_cast<float>(keysAlong(voxel));
  constexpr int kOrigin = Voxel::kOriginKey;
  const Eigen::Vector3i key(voxel.x - kOrigin, voxel.y - kOrigin, voxel.z - kOrigin);
  const Eigen::Vector3f min = key.cast<float>();  // exact, as all keys are
  return {min, min + Eigen::Vector3f::Constant(along)};
}

inline std::uint64_t StaticGrid::fullOf(const Brick& brick) const {
  const BrickLevel& level = levels_[static_cast<std::size_t>(brick.level)];
  return brick.level == 0 ? level.cells[brick.number] : level.full[brick.number];
}

inline StaticGrid::Brick StaticGrid::below(const Brick& brick, unsigned cell) const {
  const BrickLevel& level = levels_[static_cast<std::size_t>(brick.level)];
  const std::uint64_t with_brick = level.cells[brick.number] & ~level.full[brick.number];
  const auto before = static_cast<std::uint32_t>(bitCount(with_brick & ((std::uint64_t{1} << cell) - 1)));
  Brick result{brick.level - 1, level.first_below[brick.number] + before, brick.corner};
  for (int axis = 0; axis < 3; ++axis)
    result.corner[static_cast<std::size_t>(axis)] += cellAlong(cell, axis) << 2 * brick.level;
  return result;
}

inline Voxel StaticGrid::voxelAt(const Brick& brick, unsigned cell) const {
  if (is_whole_) return {0, 0, 0, Voxel::kLevels};
  const bool is_block = levels_[static_cast<std::size_t>(brick.level)].blocks[brick.number] >> cell / 8 & 1u;
  if (is_block) cell &= ~7u;
  const auto key = [&](int axis) {
    return static_cast<std::uint16_t>(brick.corner[static_cast<std::size_t>(axis)] + Voxel::kOriginKey +
                                      (cellAlong(cell, axis) << 2 * brick.level));
  };
  return {key(0), key(1), key(2), static_cast<std::uint8_t>(2 * brick.level + (is_block ? 1 : 0))};
}

/// The cells of the voxel that this one is of.
inline std::uint64_t StaticGrid::restOfVoxel(const Brick& brick, unsigned cell) const {
  if (is_whole_) return ~std::uint64_t{0};
  const bool is_block = levels_[static_cast<std::size_t>(brick.level)].blocks[brick.number] >> cell / 8 & 1u;
  return is_block ? std::uint64_t{0xff} << (cell & ~7u) : std::uint64_t{1} << cell;
}

}  // namespace hgrid
