// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <vector>

#include "narrow/box_tree.h"
#include "narrow/convex_solid.h"
#include "narrow/mesh_hull.h"
#include "narrow/triangle_gap.h"

namespace hgrid {

/// The triangles of a mesh in a tree of boxes, for exact distances. Immutable, except that makeHulls() makes it faster.
///
/// The boxes are floats and only decide which triangles are measured. The distances of triangles are computed in
/// double.
class MeshTree {
 public:
  /// @param mesh  must have at least one triangle
  explicit MeshTree(const TriangleMesh& mesh);

  const std::vector<Triangle>& triangles() const { return triangles_; }
  const BoxTree& boxes() const { return boxes_; }
  /// Returns a point of the triangles that is farthest in the given direction, in the frame of the mesh [m].
  Eigen::Vector3d support(const Eigen::Vector3d& direction) const;

  /// Makes the convex hulls of the parts of the mesh, at the first call. They often prove that two meshes are apart
  /// although their boxes overlap, so that gapTo() of two trees with hulls takes less time. For each thousand
  /// triangles, this takes some milliseconds; for more than kMostTriangles, no hulls are made. Any thread may call
  /// this.
  void makeHulls() const;
  static constexpr std::size_t kMostTriangles = 4096;  ///< of a mesh that has hulls

  /// Returns the gap between the triangles and the core of a convex solid, with points in the frame of the mesh. It is
  /// infinite if it is larger than GapLimits::enough.
  CoreGap gapTo(const ConvexSolid& solid, const Pose& mesh_from_solid, const GapLimits& limits) const;
  /// Returns the gap between the triangles of two meshes, in the same way.
  CoreGap gapTo(const MeshTree& other, const Pose& mesh_from_other, const GapLimits& limits) const;

  /// Receives the gap of two parts, in the frame of this mesh. @returns whether the search should continue
  using Met = std::function<bool(const CoreGap&)>;
  /// Calls `met` for each triangle that is within GapLimits::enough of the core of the solid, until a call returns
  /// false.
  void meetings(const ConvexSolid& solid, const Pose& mesh_from_solid, const GapLimits& limits, const Met& met) const;
  /// Calls `met` for each triangle of this mesh and each triangle of the other mesh that are within GapLimits::enough
  /// of each other, until a call returns false.
  void meetings(const MeshTree& other, const Pose& mesh_from_other, const GapLimits& limits, const Met& met) const;

 private:
  std::vector<Triangle> triangles_;
  BoxTree boxes_;
  mutable std::once_flag hulls_made_;
  mutable std::vector<MeshHull> hulls_;                        // for each node of boxes_
  mutable std::atomic<const MeshHull*> known_hulls_{nullptr};  // those of hulls_, when it is complete
};

}  // namespace hgrid
