// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/adapters/fcl_witness.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hgrid {
namespace test {
namespace {

std::shared_ptr<fcl::CollisionGeometryd> meshGeometry(const TriangleMesh& mesh) {
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  model->beginModel();
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  return model;
}

}  // namespace

std::shared_ptr<fcl::CollisionGeometryd> fclGeometry(const Shape& shape) {
  const std::vector<double> size = shape.dimensions();
  switch (shape.kind()) {
    case ShapeKind::sphere:
      return std::make_shared<fcl::Sphered>(size[0]);
    case ShapeKind::box:
      return std::make_shared<fcl::Boxd>(size[0], size[1], size[2]);
    case ShapeKind::cylinder:
      return std::make_shared<fcl::Cylinderd>(size[1], size[0]);
    case ShapeKind::cone:
      return std::make_shared<fcl::Coned>(size[1], size[0]);
    case ShapeKind::capsule:
      return std::make_shared<fcl::Capsuled>(size[1], size[0]);
    case ShapeKind::mesh:
      return meshGeometry(*shape.mesh());
    case ShapeKind::hull:
    case ShapeKind::plane:
      break;
  }
  throw std::invalid_argument("FCL has no geometry for a hull");
}

FclBody::FclBody(const Body& body) {
  for (const BodyShape& shape : body.shapes) {
    Part part{fclGeometry(shape.shape), shape.body_from_shape, Eigen::Vector3d::Zero(), 0.0};
    if (shape.shape.mesh()) {
      const auto& vertices = shape.shape.mesh()->vertices;
      Eigen::Vector3d low = vertices.front(), high = vertices.front();
      for (const Eigen::Vector3d& v : vertices) {
        low = low.cwiseMin(v);
        high = high.cwiseMax(v);
      }
      part.center = (low + high) / 2;
      for (const Eigen::Vector3d& v : vertices) part.radius = std::max(part.radius, (v - part.center).norm());
    } else {
      const std::vector<double> size = shape.shape.dimensions();
      if (shape.shape.kind() == ShapeKind::sphere)
        part.radius = size[0];
      else if (shape.shape.kind() == ShapeKind::box)
        part.radius = Eigen::Vector3d(size[0], size[1], size[2]).norm() / 2;
      else
        part.radius = size[0] / 2 + size[1];
    }
    parts_.push_back(std::move(part));
  }
}

double FclBody::partDistance(const Part& a, const Pose& world_from_a, const Part& b, const Pose& world_from_b,
                             double cutoff) {
  const fcl::Transform3d pose_a(world_from_a.matrix()), pose_b(world_from_b.matrix());
  fcl::DistanceRequestd request;
  request.enable_nearest_points = false;
  request.enable_signed_distance = false;
  request.distance_tolerance = 1e-10;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  fcl::DistanceResultd result(cutoff);  // FCL skips everything that is farther away than `cutoff`
  fcl::distance(a.geometry.get(), pose_a, b.geometry.get(), pose_b, request, result);
  if (result.min_distance <= 0.0) return 0.0;
  fcl::CollisionRequestd touch;
  touch.gjk_solver_type = fcl::GST_LIBCCD;
  fcl::CollisionResultd contacts;
  fcl::collide(a.geometry.get(), pose_a, b.geometry.get(), pose_b, touch, contacts);
  return contacts.isCollision() ? 0.0 : std::min(result.min_distance, cutoff);
}

double fclDistance(const FclBody& a, const Pose& world_from_a, const FclBody& b, const Pose& world_from_b,
                   double cutoff) {
  double least = cutoff;
  for (const FclBody::Part& part_a : a.parts_) {
    const Pose world_from_part_a = world_from_a * part_a.body_from_part;
    for (const FclBody::Part& part_b : b.parts_) {
      const Pose world_from_part_b = world_from_b * part_b.body_from_part;
      const double centers = (world_from_part_a * part_a.center - world_from_part_b * part_b.center).norm();
      if (centers - part_a.radius - part_b.radius > least + 1e-9) continue;
      least = FclBody::partDistance(part_a, world_from_part_a, part_b, world_from_part_b, least);
      if (least <= 0.0) return 0.0;
    }
  }
  return least;
}

}  // namespace test
}  // namespace hgrid
