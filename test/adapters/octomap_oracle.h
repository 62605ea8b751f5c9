// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/adapters/octomap.h"

namespace hgrid {
namespace test {

/// Checks a map that was read with these options. The voxels must be aligned, disjoint and in Morton order, and the map
/// must respect the limits. Also writes the occupied voxels and reads them again; this must give the same voxels.
/// @returns what is wrong with the map; empty if nothing is wrong
std::string flawOf(const Octomap& map, const OctomapOptions& options);

/// Returns the `.bt` nodes of a map with exactly these occupied leaves. @param voxels  disjoint, in Morton order
std::string binaryNodesOf(const std::vector<Voxel>& voxels);

}  // namespace test
}  // namespace hgrid
