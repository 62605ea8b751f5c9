// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "hgrid_proximity/geometry/aabb.h"
#include "hgrid_proximity/geometry/segment.h"
#include "hgrid_proximity/geometry/sphere.h"
#include "hgrid_proximity/geometry/voxel.h"

namespace hgrid {
namespace bench {

/// A map as a file and as what is occupied in it.
struct Map {
  std::string name, file;     ///< the file is a .bt
  double resolution = 0.0;    ///< [m] edge of a voxel of level 0
  std::vector<Voxel> leaves;  ///< occupied, in Morton order
};

/// buildingOf(leaves), written to a file in this folder.
Map building(std::size_t leaves, const std::string& folder);

/// What our own reader finds in a .bt.
Map mapOfFile(const std::string& name, const std::string& file);

/// geb079.bt in the folder that HGRID_TEST_DATA names, else in ../shared/data beside the project; empty if it is not
/// there.
std::string fileOfGeb079();

/// One number for a leaf, where it is and how large.
inline std::uint64_t numberOf(const Voxel& leaf) { return mortonOf(leaf) << 5 | leaf.level; }

// In keys the corners of all leaves are whole numbers, which floats hold exactly: peers in float, and exact tests of
// boxes in float, see the very same leaves.

inline Aabb inKeys(const Voxel& leaf) {
  const Eigen::Vector3f min(leaf.x, leaf.y, leaf.z);
  return {min, min + Eigen::Vector3f::Constant(static_cast<float>(keysAlong(leaf)))};
}
inline Eigen::Vector3d inKeys(const Eigen::Vector3d& point, double resolution) {
  return (point / resolution).array() + static_cast<double>(Voxel::kOriginKey);
}
inline Sphere inKeys(const Sphere& sphere, double resolution) {
  return {inKeys(sphere.center, resolution), sphere.radius / resolution};
}
inline Segment inKeys(const Segment& segment, double resolution) {
  return {inKeys(segment.from, resolution), inKeys(segment.to, resolution), segment.radius / resolution};
}

}  // namespace bench
}  // namespace hgrid
