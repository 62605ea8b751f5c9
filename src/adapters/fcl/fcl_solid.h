// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <memory>

#include "narrow/convex_solid.h"

namespace hgrid {

/// A convex solid, with the data that FCL needs to describe its contacts.
class FclConvexSolid final : public ConvexSolid {
 public:
  explicit FclConvexSolid(const Shape& shape);

  /// Returns the core as an FCL geometry.
  const fcl::CollisionGeometryd* geometry() const { return geometry_.get(); }

 private:
  std::unique_ptr<const fcl::CollisionGeometryd> geometry_;
};

}  // namespace hgrid
