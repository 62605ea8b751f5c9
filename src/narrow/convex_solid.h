// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "narrow/gjk.h"
#include "narrow/ordered_solid.h"

namespace hgrid {

/// A convex shape made ready to be measured.
class ConvexSolid : public OrderedSolid {
 public:
  /// @param shape  not a mesh
  explicit ConvexSolid(const Shape& shape);
  /// What a question is made of (a point, a needle, a block), with the measures by which it is sorted.
  ConvexSolid(const ConvexCore& core, const std::vector<double>& size)
      : OrderedSolid(size, core.reach()), core_(core) {}

  const ConvexCore& core() const { return core_; }
  /// A point of the core, in the shape's frame.
  const Eigen::Vector3d& somePoint() const { return some_point_; }
  /// Whether it was made of a Shape, not for a question. Contacts with questions are not described: nobody reads them.
  bool isShape() const { return is_shape_; }

 private:
  ConvexCore core_;
  Eigen::Vector3d some_point_ = Eigen::Vector3d::Zero();
  bool is_shape_ = false;
};

}  // namespace hgrid
