// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <cmath>

#include "bench/exactness/exactness_peer.h"
#include "bench/exactness/hull_faces.h"

namespace hgrid {
namespace bench {
namespace {

struct FclShape {
  std::shared_ptr<fcl::CollisionGeometryd> geometry;
  fcl::Transform3d world_from_shape;
};

FclShape fclShape(const Shape& shape, const Pose& pose) {
  const std::vector<double> size = shape.dimensions();
  const fcl::Transform3d world_from_shape(pose.matrix());
  switch (shape.kind()) {
    case ShapeKind::sphere:
      return {std::make_shared<fcl::Sphered>(size[0]), world_from_shape};
    case ShapeKind::box:
      return {std::make_shared<fcl::Boxd>(size[0], size[1], size[2]), world_from_shape};
    case ShapeKind::cylinder:
      return {std::make_shared<fcl::Cylinderd>(size[1], size[0]), world_from_shape};
    case ShapeKind::cone:
      return {std::make_shared<fcl::Coned>(size[1], size[0]), world_from_shape};
    case ShapeKind::capsule:
      return {std::make_shared<fcl::Capsuled>(size[1], size[0]), world_from_shape};
    default: {
      const HullFaces hull = hullFacesOf(shape.mesh()->vertices);
      auto faces = std::make_shared<std::vector<int>>();
      for (const auto& [a, b, c] : hull.faces) faces->insert(faces->end(), {3, a, b, c});
      const auto corners = std::make_shared<const std::vector<Eigen::Vector3d>>(hull.corners);
      return {std::make_shared<fcl::Convexd>(corners, int(hull.faces.size()), faces),
              world_from_shape * Eigen::Translation3d(hull.center)};
    }
  }
}

/// FCL documents one tolerance for distances and one for contacts, both 1e-6 by default. Smaller ones than kTolerance
/// do not make its answers better.
ExactnessAnswer measure(const test::Case& placed, fcl::GJKSolverType solver) {
  constexpr double kDistanceTolerance = 1e-14, kContactTolerance = 1e-12;
  const FclShape first = fclShape(placed.first_shape, placed.world_from_first),
                 second = fclShape(placed.second_shape, placed.world_from_second);
  ExactnessAnswer answer;
  fcl::CollisionRequestd touch;
  touch.enable_contact = true;
  touch.gjk_solver_type = solver;
  touch.gjk_tolerance = kContactTolerance;
  fcl::CollisionResultd contacts;
  fcl::collide(first.geometry.get(), first.world_from_shape, second.geometry.get(), second.world_from_shape, touch,
               contacts);
  answer.touches = contacts.isCollision();
  if (answer.touches) {
    answer.depth = std::abs(contacts.getContact(0).penetration_depth);  // GST_INDEP tells it with the other sign
    answer.normal = contacts.getContact(0).normal;
  }
  fcl::DistanceRequestd request;
  request.gjk_solver_type = solver;
  request.distance_tolerance = kDistanceTolerance;
  fcl::DistanceResultd result;
  fcl::distance(first.geometry.get(), first.world_from_shape, second.geometry.get(), second.world_from_shape, request,
                result);
  answer.distance = std::max(0.0, result.min_distance);
  answer.given = true;
  return answer;
}

}  // namespace

ExactnessAnswer measureWithFclLibccd(const test::Case& placed) { return measure(placed, fcl::GST_LIBCCD); }
ExactnessAnswer measureWithFclIndep(const test::Case& placed) { return measure(placed, fcl::GST_INDEP); }

}  // namespace bench
}  // namespace hgrid
