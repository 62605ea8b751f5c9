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

/// A mesh as FCL stores it (a tree of boxes and swept spheres), together with the space that it encloses. All solids of
/// one mesh share it.
class FclMesh {
 public:
  explicit FclMesh(const std::shared_ptr<const TriangleMesh>& source);

  const TriangleMesh& source() const { return *source_; }
  const Enclosure& enclosure() const { return enclosure_; }
  const fcl::BVHModel<fcl::OBBRSSd>& model() const { return model_; }

  /// Returns the gap between the triangles and a convex core, with points in the frame of the mesh. It is infinite if
  /// it is larger than `up_to` [m].
  CoreGap gapTo(const ConvexCore& core, const fcl::OBBRSSd& core_volume, const Pose& mesh_from_core,
                double up_to) const;

  /// Receives the gap of two parts, in the frame of this mesh. @returns whether the search should continue
  using Met = std::function<bool(const CoreGap&)>;
  /// Calls `met` for each triangle that is within `reach` [m] of the core. @returns false if a call returned false
  bool meetings(const ConvexCore& core, const fcl::OBBRSSd& core_volume, const Pose& mesh_from_core, double reach,
                const Met& met) const;
  /// Calls `met` for each triangle of this mesh and each triangle of the other mesh that are within `reach` [m] of each
  /// other. @returns false if a call returned false
  bool meetings(const FclMesh& other, const Pose& mesh_from_other, double reach, const Met& met) const;

 private:
  std::array<Eigen::Vector3d, 3> triangle(const fcl::BVNode<fcl::OBBRSSd>& leaf) const;
  /// Searches the tree below a node for a triangle that is nearer to the core than `best`.
  void visit(int node, double bound, const ConvexCore& core, const fcl::OBBRSSd& core_volume,
             const Pose& mesh_from_core, CoreGap& best) const;

  std::shared_ptr<const TriangleMesh> source_;  // kept, so that no other mesh gets its address
  Enclosure enclosure_;
  fcl::BVHModel<fcl::OBBRSSd> model_;
};

}  // namespace hgrid
