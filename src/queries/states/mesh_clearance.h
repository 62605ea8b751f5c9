// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/bodies/body.h"
#include "narrow/mesh_solid.h"
#include "queries/states/cover_clearance.h"

namespace hgrid {

/// Tells quickly which shapes are surely far from a mesh of the robot, although they may be in its box. Compares the
/// spheres of a SphereCover with the bounds of a DistanceLattice.
class MeshClearance {
 public:
  /// @param shape  must outlive this object. Nothing is far from it unless it is a closed mesh of the package's own
  /// narrow phase
  explicit MeshClearance(const BodyShape& shape);

  /// Returns whether the shape is such a mesh.
  bool exists() const { return mesh_ != nullptr; }
  /// Returns one bit for each of four states: whether another shape is surely farther than `reach` [m] from the mesh.
  /// @param mesh, other  where the mesh and the other shape are
  /// @param cover        of the other shape
  /// @param lanes        bit i: whether the result matters for state i
  unsigned farther(const FourShapes& mesh, const FourShapes& other, const SphereCover& cover, const Four& reach,
                   unsigned lanes) const;
  /// Counts a measurement of the mesh that found no contact, see PreparedMesh::countApart(). exists() must be true.
  void countApart() const { mesh_->countApart(); }

 private:
  const MeshSolid* mesh_;
  Eigen::Vector3d center_;  // [m, mesh frame] center of the box around the shape
  float padding_;           // [m]
};

}  // namespace hgrid
