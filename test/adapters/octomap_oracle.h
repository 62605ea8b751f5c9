// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/adapters/octomap.h"

namespace hgrid {
namespace test {

/// What is wrong with a map that was read with these options; empty if nothing is: keys are multiples of the edges,
/// voxels disjoint and in Morton order, limits kept, and the occupied voxels written again are read as the same.
std::string flawOf(const Octomap& map, const OctomapOptions& options);

/// The nodes of a `.bt` that has these leaves and no others. @param voxels  disjoint, in Morton order
std::string binaryNodesOf(const std::vector<Voxel>& voxels);

}  // namespace test
}  // namespace hgrid
