// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>

#include <array>
#include <functional>
#include <memory>

#include "narrow/enclosure.h"
#include "narrow/gjk.h"

namespace hgrid {

/// What FCL makes of a mesh, a tree of boxes and swept spheres, and what the mesh encloses; equal meshes share it.
class FclMesh {
 public:
  explicit FclMesh(const std::shared_ptr<const TriangleMesh>& source);

  const TriangleMesh& source() const { return *source_; }
  const Enclosure& enclosure() const { return enclosure_; }
  const fcl::BVHModel<fcl::OBBRSSd>& model() const { return model_; }

  /// Of all triangles and a convex core, points in the mesh's frame. Infinite if they are farther apart than `up_to`
  /// [m].
  CoreGap gapTo(const ConvexCore& core, const fcl::OBBRSSd& core_volume, const Pose& mesh_from_core,
                double up_to) const;

  /// How a part of the one lies to a part of the other, told in the frame of the one. @returns whether to go on
  using Met = std::function<bool(const CoreGap&)>;
  /// Tells of each triangle that is within `reach` [m] of the core. @returns whether `met` wanted to go on
  bool meetings(const ConvexCore& core, const fcl::OBBRSSd& core_volume, const Pose& mesh_from_core, double reach,
                const Met& met) const;
  /// Tells of each two triangles of this mesh and of the other that are within `reach` [m] of each other.
  bool meetings(const FclMesh& other, const Pose& mesh_from_other, double reach, const Met& met) const;

 private:
  std::array<Eigen::Vector3d, 3> triangle(const fcl::BVNode<fcl::OBBRSSd>& leaf) const;
  void visit(int node, double bound, const ConvexCore& core, const fcl::OBBRSSd& core_volume,
             const Pose& mesh_from_core, CoreGap& best) const;

  std::shared_ptr<const TriangleMesh> source_;  // lives as long, so that its address is no other mesh's
  Enclosure enclosure_;
  fcl::BVHModel<fcl::OBBRSSd> model_;
};

}  // namespace hgrid
