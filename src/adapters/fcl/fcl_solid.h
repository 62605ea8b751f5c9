// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <fcl/geometry/collision_geometry.h>
#include <fcl/math/bv/OBBRSS.h>

#include <memory>
#include <vector>

#include "adapters/fcl/fcl_mesh.h"
#include "narrow/convex_solid.h"

namespace hgrid {

/// A convex solid, with the data that FCL needs to measure its distance to meshes and to describe its contacts.
class FclConvexSolid final : public ConvexSolid {
 public:
  explicit FclConvexSolid(const Shape& shape);
  /// Creates a solid for queries.
  FclConvexSolid(const ConvexCore& core, const std::vector<double>& size);

  /// Returns a bounding volume of the core.
  const fcl::OBBRSSd& volume() const { return volume_; }
  /// Returns the core as an FCL geometry, or null if isShape() is false.
  const fcl::CollisionGeometryd* geometry() const { return geometry_.get(); }

 private:
  fcl::OBBRSSd volume_;
  std::unique_ptr<const fcl::CollisionGeometryd> geometry_;
};

/// A mesh as a solid. It shares the FCL tree of the mesh.
class FclMeshSolid final : public OrderedSolid {
 public:
  FclMeshSolid(const Shape& shape, std::shared_ptr<const FclMesh> mesh) : OrderedSolid(shape), mesh_(std::move(mesh)) {}
  const FclMesh& mesh() const { return *mesh_; }

 private:
  std::shared_ptr<const FclMesh> mesh_;
};

}  // namespace hgrid
