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

/// OctoMap's own tree, read by OctoMap. @throws std::runtime_error if it does not take the file
std::shared_ptr<const octomap::OcTree> ocTreeOf(const std::string& file);

/// Its occupied leaves, by its own iterator.
std::vector<Voxel> leavesOf(const octomap::OcTree& tree);

}  // namespace bench
}  // namespace hgrid
