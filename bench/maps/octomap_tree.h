// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <octomap/OcTree.h>

#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/geometry/voxel.h"

namespace hgrid {
namespace bench {

/// Reads a .bt file with OctoMap. @throws std::runtime_error if OctoMap cannot read the file
std::shared_ptr<const octomap::OcTree> ocTreeOf(const std::string& file);

/// Returns the occupied leaves of the tree, found with OctoMap's iterator.
std::vector<Voxel> leavesOf(const octomap::OcTree& tree);

}  // namespace bench
}  // namespace hgrid
