// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <fcl/geometry/collision_geometry.h>
#include <fcl/math/bv/OBBRSS.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "adapters/fcl/fcl_mesh.h"
#include "hgrid_proximity/narrow/narrow_phase.h"
#include "narrow/gjk.h"

namespace hgrid {

/// A shape ready to be measured: a convex core or a mesh, and a radius around it.
class FclSolid final : public Solid {
 public:
  FclSolid(const Shape& shape, std::shared_ptr<const FclMesh> mesh);
  /// What questions are made of.
  FclSolid(const ConvexCore& core, const std::vector<double>& size);

  const ConvexCore& core() const { return core_; }                             // of all but meshes
  const fcl::OBBRSSd& volume() const { return volume_; }                       // around the core
  const fcl::CollisionGeometryd* geometry() const { return geometry_.get(); }  // for contacts; null: there are none
  const FclMesh* mesh() const { return mesh_.get(); }
  double radius() const { return radius_; }
  double reach() const { return reach_; }
  ShapeKind kind() const { return kind_; }

  /// An order of solids that differ.
  bool before(const FclSolid& other) const;

  /// Whether a part of the core, told by some points in its frame, is as asked.
  template <class Ask>
  bool anyPart(const Ask& ask) const {
    if (!mesh_) return ask(&some_point_, &some_point_ + 1);
    const std::vector<Enclosure::Part>& parts = mesh_->enclosure().parts();
    return std::any_of(parts.begin(), parts.end(),
                       [&](const Enclosure::Part& part) { return ask(part.data(), part.data() + part.size()); });
  }

 private:
  void finish(double reach);

  ShapeKind kind_;
  std::vector<double> size_;
  std::shared_ptr<const TriangleMesh> source_;  // of hull and mesh
  double reach_ = 0.0, radius_ = 0.0;
  ConvexCore core_ = ConvexCore::point();
  fcl::OBBRSSd volume_;
  std::unique_ptr<const fcl::CollisionGeometryd> geometry_;
  std::shared_ptr<const FclMesh> mesh_;
  Eigen::Vector3d some_point_ = Eigen::Vector3d::Zero();
};

}  // namespace hgrid
