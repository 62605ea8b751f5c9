// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

namespace hgrid {

/// A cube of an octree, told by whole numbers: its edge is finest edge * 2^level, and `x`, `y`, `z` are its least
/// corner in finest edges, each a multiple of 2^level. Key 32768 is the map's origin, as OctoMap counts.
struct Voxel {
  static constexpr int kLevels = 16;          ///< a cube of this level is the whole map: 65536 finest edges long
  static constexpr int kOriginKey = 1 << 15;  ///< key of the coordinate 0

  std::uint16_t x = 0, y = 0, z = 0;
  std::uint8_t level = 0;  ///< 0..kLevels; in an OctoMap 16 - depth

  bool operator==(const Voxel& other) const {
    return x == other.x && y == other.y && z == other.z && level == other.level;
  }
  bool operator!=(const Voxel& other) const { return !(*this == other); }
};
static_assert(sizeof(Voxel) == 8, "maps have millions of them");

/// Finest edges along one side of the voxel: 1..65536.
inline std::uint32_t keysAlong(const Voxel& voxel) { return std::uint32_t{1} << voxel.level; }

/// Edge of the voxel [m] in a map of this finest edge [m].
inline double edgeOf(const Voxel& voxel, double finest_edge) { return std::ldexp(finest_edge, voxel.level); }

/// Coordinate [m], in the map's frame, of a key 0..65536; the last is where the last cube ends.
inline double coordinateOf(std::uint32_t key, double finest_edge) {
  return (static_cast<int>(key) - Voxel::kOriginKey) * finest_edge;
}

/// Least and greatest corner [m] of the voxel in the map's frame.
inline Eigen::Vector3d minCorner(const Voxel& voxel, double finest_edge) {
  return {coordinateOf(voxel.x, finest_edge), coordinateOf(voxel.y, finest_edge), coordinateOf(voxel.z, finest_edge)};
}
inline Eigen::Vector3d maxCorner(const Voxel& voxel, double finest_edge) {
  const std::uint32_t along = keysAlong(voxel);
  return {coordinateOf(voxel.x + along, finest_edge), coordinateOf(voxel.y + along, finest_edge),
          coordinateOf(voxel.z + along, finest_edge)};
}

/// Child 0..7 of a cube of level 1 or more: bit 0 is the upper half along x, bit 1 along y, bit 2 along z.
inline Voxel childOf(const Voxel& cube, unsigned child) {
  const unsigned level = cube.level - 1u;
  const auto half = [&](std::uint16_t key, unsigned axis) {
    return static_cast<std::uint16_t>(key | (child >> axis & 1u) << level);
  };
  return {half(cube.x, 0), half(cube.y, 1), half(cube.z, 2), static_cast<std::uint8_t>(level)};
}

/// Bit i of the key becomes bit 3 i.
inline std::uint64_t spreadByThree(std::uint16_t key) {
  std::uint64_t bits = key;
  bits = (bits | bits << 16) & 0x0000ff0000ff;
  bits = (bits | bits << 8) & 0x00f00f00f00f;
  bits = (bits | bits << 4) & 0x0c30c30c30c3;
  return (bits | bits << 2) & 0x249249249249;
}

/// Bit 3 i of the bits becomes bit i: the reverse.
inline std::uint16_t gatheredByThree(std::uint64_t bits) {
  bits &= 0x249249249249;
  bits = (bits | bits >> 2) & 0x0c30c30c30c3;
  bits = (bits | bits >> 4) & 0x00f00f00f00f;
  bits = (bits | bits >> 8) & 0x0000ff0000ff;
  return static_cast<std::uint16_t>(bits | bits >> 16);
}

/// The 48 bits of the keys interleaved, x lowest: the order in which an octree has its leaves. The voxel covers the
/// codes from this one to the one before this + 8^level.
inline std::uint64_t mortonOf(const Voxel& voxel) {
  return spreadByThree(voxel.x) | spreadByThree(voxel.y) << 1 | spreadByThree(voxel.z) << 2;
}

/// The voxel of level 0 that has this code.
inline Voxel finestVoxelOf(std::uint64_t morton) {
  return {gatheredByThree(morton), gatheredByThree(morton >> 1), gatheredByThree(morton >> 2), 0};
}

}  // namespace hgrid
