// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <memory>
#include <vector>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {
namespace test {

/// A shape as described, to FCL. @throws std::invalid_argument for a hull
std::shared_ptr<fcl::CollisionGeometryd> fclGeometry(const Shape& shape);

/// A body as FCL sees it: its shapes, and a ball round each that the product knows nothing of.
///
/// Distances are those of the shapes as described, in double (by GST_LIBCCD, unsigned: the only way of FCL
/// 0.7 without failures). What the surfaces of two shapes cut counts as 0; a shape wholly inside a closed
/// mesh does not: FCL takes the mesh for a surface.
class FclBody {
 public:
  explicit FclBody(const Body& body);

  /// The exact distance [m] of the two bodies, 0 if they touch, or `cutoff` if it is that much or more.
  friend double fclDistance(const FclBody& a, const Pose& world_from_a, const FclBody& b, const Pose& world_from_b,
                            double cutoff);

 private:
  struct Part {
    std::shared_ptr<fcl::CollisionGeometryd> geometry;
    Pose body_from_part;
    Eigen::Vector3d center;  // of the ball, in the part's frame
    double radius;
  };
  static double partDistance(const Part& a, const Pose& world_from_a, const Part& b, const Pose& world_from_b,
                             double cutoff);

  std::vector<Part> parts_;
};

double fclDistance(const FclBody& a, const Pose& world_from_a, const FclBody& b, const Pose& world_from_b,
                   double cutoff);

}  // namespace test
}  // namespace hgrid
