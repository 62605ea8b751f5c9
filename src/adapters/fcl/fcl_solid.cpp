// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "adapters/fcl/fcl_solid.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/utility.h>

#include <array>

namespace hgrid {

using Vector = Eigen::Vector3d;

FclSolid::FclSolid(const Shape& shape, std::shared_ptr<const FclMesh> mesh)
    : kind_(shape.kind()), size_(shape.dimensions()), source_(shape.mesh()), mesh_(std::move(mesh)) {
  switch (kind_) {
    case ShapeKind::sphere:
      radius_ = size_[0];
      core_ = ConvexCore::point();
      geometry_ = std::make_unique<fcl::Sphered>(0.0);
      break;
    case ShapeKind::box:
      core_ = ConvexCore::box({size_[0], size_[1], size_[2]});
      geometry_ = std::make_unique<fcl::Boxd>(size_[0], size_[1], size_[2]);
      break;
    case ShapeKind::cylinder:
      core_ = ConvexCore::cylinder(size_[0], size_[1]);
      geometry_ = std::make_unique<fcl::Cylinderd>(size_[1], size_[0]);
      break;
    case ShapeKind::cone:
      core_ = ConvexCore::cone(size_[0], size_[1]);
      geometry_ = std::make_unique<fcl::Coned>(size_[1], size_[0]);
      break;
    case ShapeKind::capsule:
      radius_ = size_[1];
      core_ = ConvexCore::segment(size_[0]);
      geometry_ = std::make_unique<fcl::Capsuled>(0.0, size_[0]);
      break;
    case ShapeKind::hull:
      core_ = ConvexCore::hull(source_->vertices.data(), source_->vertices.size());
      // Without faces: FCL then goes through all vertices, which is right whatever they are.
      geometry_ = std::make_unique<fcl::Convexd>(std::make_shared<const std::vector<Vector>>(source_->vertices), 0,
                                                 std::make_shared<const std::vector<int>>());
      some_point_ = source_->vertices.front();
      break;
    case ShapeKind::mesh:
      break;
  }
  finish(shape.reach());
}

FclSolid::FclSolid(const ConvexCore& core, const std::vector<double>& size)
    : kind_(ShapeKind::box), size_(size), core_(core), geometry_(nullptr) {
  finish(core.reach());
}

bool FclSolid::before(const FclSolid& other) const {
  if (kind_ != other.kind_) return kind_ > other.kind_;  // meshes go first
  if (size_ != other.size_) return size_ < other.size_;
  if (source_ == other.source_ || !source_ || !other.source_) return false;
  const auto &v = source_->vertices, &w = other.source_->vertices;
  const auto less = [](const Vector& a, const Vector& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  if (std::lexicographical_compare(v.begin(), v.end(), w.begin(), w.end(), less)) return true;
  if (std::lexicographical_compare(w.begin(), w.end(), v.begin(), v.end(), less)) return false;
  return source_->triangles < other.source_->triangles;
}

void FclSolid::finish(double reach) {
  reach_ = reach;
  if (mesh_) return;
  Vector low, high;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = core_.support(-Vector::Unit(axis))[axis];
    high[axis] = core_.support(Vector::Unit(axis))[axis];
  }
  std::array<Vector, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] = {i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z()};
  }
  fcl::fit(corners.data(), static_cast<int>(corners.size()), volume_);
}

}  // namespace hgrid
