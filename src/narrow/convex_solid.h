// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "narrow/box_tree.h"
#include "narrow/gjk.h"
#include "narrow/ordered_solid.h"

namespace hgrid {

/// A convex shape that is prepared for measuring.
class ConvexSolid final : public OrderedSolid {
 public:
  /// @param shape  must not be a mesh or a plane
  explicit ConvexSolid(const Shape& shape);
  /// Creates a solid for queries: a point, a needle or a block. OrderedSolid::before() compares `size`.
  ConvexSolid(const ConvexCore& core, const std::vector<double>& size);

  const ConvexCore& core() const { return core_; }
  /// Returns a tree with one box, that of the core.
  const BoxTree& box() const { return box_; }
  /// Returns a point of the core, in the frame of the shape [m].
  const Eigen::Vector3d& somePoint() const { return some_point_; }

 private:
  ConvexCore core_;
  BoxTree box_;
  Eigen::Vector3d some_point_ = Eigen::Vector3d::Zero();
};

}  // namespace hgrid
