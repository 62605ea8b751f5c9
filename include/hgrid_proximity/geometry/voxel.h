// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace hgrid {

/// A cube of an octree, given by integer keys as in OctoMap.
///
/// A key counts finest edges along an axis, where the finest edge is the edge of a voxel of level 0. `x`, `y`, `z` are
/// the keys of the minimum corner; each is a multiple of 2^level. The edge of the cube is finest edge * 2^level. Key
/// 32768 is at the origin of the map.
struct Voxel {
  static constexpr int kLevels = 16;          ///< level of the cube that is the whole map, 65536 finest edges long
  static constexpr int kOriginKey = 1 << 15;  ///< key of the coordinate 0

  std::uint16_t x = 0;     ///< key of the minimum corner along x
  std::uint16_t y = 0;     ///< key of the minimum corner along y
  std::uint16_t z = 0;     ///< key of the minimum corner along z
  std::uint8_t level = 0;  ///< 0 .. kLevels; equal to 16 - depth in an OctoMap

  /// Whether both are the same cube.
  bool operator==(const Voxel& other) const {
    return x == other.x && y == other.y && z == other.z && level == other.level;
  }
  /// Whether the cubes differ.
  bool operator!=(const Voxel& other) const { return !(*this == other); }
};
static_assert(sizeof(Voxel) == 8, "Voxel must stay small: maps have millions of voxels");

/// Returns the edge of the voxel, counted in finest edges: 1 .. 65536.
inline std::uint32_t keysAlong(const Voxel& voxel) { return std::uint32_t{1} << voxel.level; }

/// Returns the edge [m] of the voxel in a map with the given finest edge [m].
inline double edgeOf(const Voxel& voxel, double finest_edge) { return std::ldexp(finest_edge, voxel.level); }

/// Returns the coordinate [m, map frame] of a key 0 .. 65536. Key 65536 is the upper end of the map.
inline double coordinateOf(std::uint32_t key, double finest_edge) {
  return (static_cast<int>(key) - Voxel::kOriginKey) * finest_edge;
}

/// Returns the minimum corner of the voxel [m, map frame].
inline Eigen::Vector3d minCorner(const Voxel& voxel, double finest_edge) {
  return {coordinateOf(voxel.x, finest_edge), coordinateOf(voxel.y, finest_edge), coordinateOf(voxel.z, finest_edge)};
}
/// Returns the maximum corner of the voxel [m, map frame].
inline Eigen::Vector3d maxCorner(const Voxel& voxel, double finest_edge) {
  const std::uint32_t along = keysAlong(voxel);
  return {coordinateOf(voxel.x + along, finest_edge), coordinateOf(voxel.y + along, finest_edge),
          coordinateOf(voxel.z + along, finest_edge)};
}

/// Returns child 0 .. 7 of a cube of level 1 or more. Bits 0, 1, 2 of `child` select the upper half along x, y, z.
inline Voxel childOf(const Voxel& cube, unsigned child) {
  const unsigned level = cube.level - 1u;
  const auto half = [&](std::uint16_t key, unsigned axis) {
    return static_cast<std::uint16_t>(key | (child >> axis & 1u) << level);
  };
  return {half(cube.x, 0), half(cube.y, 1), half(cube.z, 2), static_cast<std::uint8_t>(level)};
}

/// Moves bit i of the key to bit 3 * i of the result.
inline std::uint64_t spreadByThree(std::uint16_t key) {
  std::uint64_t bits = key;
  bits = (bits | bits << 16) & 0x0000ff0000ff;
  bits = (bits | bits << 8) & 0x00f00f00f00f;
  bits = (bits | bits << 4) & 0x0c30c30c30c3;
  return (bits | bits << 2) & 0x249249249249;
}

/// Moves bit 3 * i of the argument to bit i of the result: the inverse of spreadByThree().
inline std::uint16_t gatheredByThree(std::uint64_t bits) {
  bits &= 0x249249249249;
  bits = (bits | bits >> 2) & 0x0c30c30c30c3;
  bits = (bits | bits >> 4) & 0x00f00f00f00f;
  bits = (bits | bits >> 8) & 0x0000ff0000ff;
  return static_cast<std::uint16_t>(bits | bits >> 16);
}

/// Returns the Morton code of the voxel: the 48 bits of its keys interleaved, with x lowest. An octree stores its
/// leaves in the order of these codes. A voxel with code m contains the voxels of level 0 with the codes m up to
/// m + 8^level - 1.
inline std::uint64_t mortonOf(const Voxel& voxel) {
  return spreadByThree(voxel.x) | spreadByThree(voxel.y) << 1 | spreadByThree(voxel.z) << 2;
}

/// Returns the voxel of level 0 that has this Morton code.
inline Voxel finestVoxelOf(std::uint64_t morton) {
  return {gatheredByThree(morton), gatheredByThree(morton >> 1), gatheredByThree(morton >> 2), 0};
}

}  // namespace hgrid
