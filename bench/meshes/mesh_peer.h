// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>

#include "hgrid_proximity/geometry/pose.h"
#include "hgrid_proximity/geometry/shape.h"

namespace hgrid {
namespace bench {

/// Two meshes, as a library has prepared them.
class MeshPeer {
 public:
  virtual ~MeshPeer() = default;
  /// Returns the distance of the triangles [m]: 0 if they meet, infinite if the distance is larger than `up_to`.
  virtual double distance(const Pose& first_from_second, double up_to) const = 0;
};

std::unique_ptr<MeshPeer> makeHgridMeshes(const TriangleMesh& first, const TriangleMesh& second);
/// Uses fcl::distance() of two BVHModel<OBBRSS>. Returns null if FCL was not found.
std::unique_ptr<MeshPeer> makeFclMeshes(const TriangleMesh& first, const TriangleMesh& second);

}  // namespace bench
}  // namespace hgrid
