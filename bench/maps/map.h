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

/// A map of the benchmark: its file and its occupied leaves.
struct Map {
  std::string name, file;     ///< `file` is the path of an OctoMap .bt file
  double resolution = 0.0;    ///< [m] edge of a leaf of level 0
  std::vector<Voxel> leaves;  ///< occupied leaves in Morton order
};

/// Returns the map of buildingOf(leaves), and writes the map to a file in `folder`.
Map building(std::size_t leaves, const std::string& folder);

/// Reads a .bt file with hgrid's reader and returns it as a map.
Map mapOfFile(const std::string& name, const std::string& file);

/// Returns the path of octomap/geb079.bt in the folder that HGRID_TEST_DATA names. If HGRID_TEST_DATA is not set, the
/// folder is ../shared/data beside the project. Returns an empty string if there is no such file.
std::string fileOfGeb079();

/// Returns a number that contains the position and the level of a leaf.
inline std::uint64_t numberOf(const Voxel& leaf) { return mortonOf(leaf) << 5 | leaf.level; }

// inKeys() converts to coordinates in units of voxel keys. In these units, the corners of all leaves are integers,
// which float represents exactly. Therefore peers and tests that use float see exactly the same leaves.

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
