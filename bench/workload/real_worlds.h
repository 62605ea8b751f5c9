// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {
namespace bench {

/// A world of boxes that was recorded, and not made for this benchmark.
struct RealWorld {
  std::string name;
  std::vector<Aabb> before;         ///< boxes at the beginning
  std::vector<Aabb> boxes;          ///< boxes after one step, in which all of them move
  std::vector<ProxyPair> required;  ///< pairs of `boxes` that an exact computation says must be found; may be empty
};

/// Reads all worlds of a folder. A file NAME.txt is a world whose boxes have six numbers a line: the lowest corner,
/// then the highest corner; before the step, each box is up to 5 % of its size beside its place. A folder
/// mesh_in_motion/NAME holds two frames of a mesh, FIRST.ply and SECOND.ply, and the pairs that must be found between
/// them, FIRSTee.json (edges with edges) and FIRSTvf.json (vertices with faces). Its boxes are the vertices, then the
/// edges, then the faces, each around both frames; before the step, around the second frame only.
/// @throws std::runtime_error with the file that cannot be read
std::vector<RealWorld> realWorlds(const std::string& folder);

}  // namespace bench
}  // namespace hgrid
