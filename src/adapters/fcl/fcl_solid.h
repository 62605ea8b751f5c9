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

/// A convex solid, with what FCL needs to measure it against meshes and to describe its contacts.
class FclConvexSolid final : public ConvexSolid {
 public:
  explicit FclConvexSolid(const Shape& shape);
  /// What a question is made of.
  FclConvexSolid(const ConvexCore& core, const std::vector<double>& size);

  /// A volume around the core.
  const fcl::OBBRSSd& volume() const { return volume_; }
  /// The core as FCL has it. Only if isShape(); null otherwise.
  const fcl::CollisionGeometryd* geometry() const { return geometry_.get(); }

 private:
  fcl::OBBRSSd volume_;
  std::unique_ptr<const fcl::CollisionGeometryd> geometry_;
};

/// A mesh, with the tree that FCL makes of it.
class FclMeshSolid final : public OrderedSolid {
 public:
  FclMeshSolid(const Shape& shape, std::shared_ptr<const FclMesh> mesh) : OrderedSolid(shape), mesh_(std::move(mesh)) {}
  const FclMesh& mesh() const { return *mesh_; }

 private:
  std::shared_ptr<const FclMesh> mesh_;
};

}  // namespace hgrid
