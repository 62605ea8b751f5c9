// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Bullet's search for the nearest points of two convex shapes. This file is compiled twice: for the library that has
// floats, which is the usual one, and with BT_USE_DOUBLE_PRECISION for the one that has doubles.
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <algorithm>
#include <memory>

#include "bench/exactness/bullet_double.h"
#include "bench/exactness/exactness_peer.h"

namespace hgrid {
namespace bench {
namespace {

btVector3 toBullet(const Eigen::Vector3d& v) { return {btScalar(v.x()), btScalar(v.y()), btScalar(v.z())}; }

btTransform toBullet(const Pose& pose) {
  const Eigen::Matrix<btScalar, 3, 3> r = pose.linear().cast<btScalar>();
  const btMatrix3x3 rotation(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2));
  return btTransform(rotation, toBullet(pose.translation()));
}

std::unique_ptr<btConvexShape> coreOf(const Shape& shape) {
  const std::vector<double> size = shape.dimensions();
  const auto at = [&](std::size_t i) { return btScalar(size[i]); };
  switch (shape.kind()) {
    case ShapeKind::sphere:
      return std::make_unique<btSphereShape>(at(0));
    case ShapeKind::box:
      return std::make_unique<btBoxShape>(btVector3(at(0), at(1), at(2)) / 2);
    case ShapeKind::cylinder:
      return std::make_unique<btCylinderShapeZ>(btVector3(at(1), at(1), at(0) / 2));
    case ShapeKind::cone:
      return std::make_unique<btConeShapeZ>(at(1), at(0));
    case ShapeKind::capsule:
      return std::make_unique<btCapsuleShapeZ>(at(1), at(0));
    default: {
      auto hull = std::make_unique<btConvexHullShape>();
      for (const Eigen::Vector3d& vertex : shape.mesh()->vertices) hull->addPoint(toBullet(vertex));
      return hull;
    }
  }
}

/// Returns a shape without a margin. A margin is a radius around the shape: a hull or cone with it is larger than it
/// should be, and a box or cylinder has round edges. That of a sphere and of a capsule is its radius, and stays.
std::unique_ptr<btConvexShape> bulletShape(const Shape& shape) {
  std::unique_ptr<btConvexShape> core = coreOf(shape);
  if (shape.kind() != ShapeKind::sphere) core->setMargin(0);
  return core;
}

ExactnessAnswer measure(const test::Case& placed) {
  const auto first = bulletShape(placed.first_shape), second = bulletShape(placed.second_shape);
  btVoronoiSimplexSolver simplex;
  btGjkEpaPenetrationDepthSolver depth_solver;
  btGjkPairDetector detector(first.get(), second.get(), &simplex, &depth_solver);
  btGjkPairDetector::ClosestPointInput input;
  input.m_transformA = toBullet(placed.world_from_first);
  input.m_transformB = toBullet(placed.world_from_second);
  btPointCollector found;
  detector.getClosestPoints(input, found, nullptr);
  ExactnessAnswer answer;
  answer.given = found.m_hasResult;
  if (!answer.given) return answer;
  answer.touches = found.m_distance <= 0;
  answer.distance = std::max<double>(0.0, found.m_distance);
  const btVector3& normal = found.m_normalOnBInWorld;
  answer.normal = -Eigen::Vector3d(normal.x(), normal.y(), normal.z());
  if (answer.touches) answer.depth = -found.m_distance;
  return answer;
}

}  // namespace

#ifndef BT_USE_DOUBLE_PRECISION
ExactnessAnswer measureWithBulletFloat(const test::Case& placed) { return measure(placed); }
#endif

}  // namespace bench
}  // namespace hgrid

#ifdef BT_USE_DOUBLE_PRECISION
void hgridBenchBulletDouble(const hgrid::test::Case& placed, hgrid::bench::ExactnessAnswer& answer) {
  answer = hgrid::bench::measure(placed);
}
#endif
