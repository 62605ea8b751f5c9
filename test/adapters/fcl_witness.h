// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <memory>
#include <vector>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {
namespace test {

/// Converts a shape, without padding, to an FCL geometry. @throws std::invalid_argument for a hull
std::shared_ptr<fcl::CollisionGeometryd> fclGeometry(const Shape& shape);

/// A body as FCL represents it. Tests use it to compute reference distances. Each shape also has a bounding sphere,
/// which is computed here independently of the product.
///
/// The distances are without padding and never negative. They are computed in double with GST_LIBCCD, the only method
/// of FCL 0.7 that did not fail. The distance is 0 if the surfaces of two shapes intersect. It is not 0 if a shape is
/// completely inside a closed mesh, because FCL treats a mesh as a surface.
class FclBody {
 public:
  explicit FclBody(const Body& body);

  /// Returns the exact distance [m] of the two bodies; 0 if they touch. Returns `cutoff` if the distance is larger.
  friend double fclDistance(const FclBody& a, const Pose& world_from_a, const FclBody& b, const Pose& world_from_b,
                            double cutoff);

 private:
  struct Part {
    std::shared_ptr<fcl::CollisionGeometryd> geometry;
    Pose body_from_part;
    Eigen::Vector3d center;  // center of the bounding sphere, in the frame of the shape
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
