// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests the oracle itself: compares its distances, depths and inside tests with formulas.
#include <gtest/gtest.h>

#include "test/support/shapes.h"
#include "test/support/solid_oracle.h"
#include "test/support/solids.h"

namespace hgrid {
namespace test {
namespace {

constexpr double kClose = 1e-10;  // [m] greatest allowed error, and greatest allowed width of an interval
constexpr int kTrials = 2000;

Eigen::Vector3d randomPoint(Random& random, double far) { return randomPose(random, far).translation(); }

/// Returns the distance of (x, y) from the rectangle [0, width] x [-half, half].
double fromRectangle(double x, double y, double width, double half) {
  return std::hypot(std::max(0.0, x - width), std::max(0.0, std::abs(y) - half));
}

double fromSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double along = (p - a).dot(b - a) / (b - a).squaredNorm();
  return (p - a - std::min(1.0, std::max(0.0, along)) * (b - a)).norm();
}

/// Returns the distance of a point from a sphere, capsule, box, cylinder or cone; 0 inside. `p` is in the shape's
/// frame.
double pointDistance(const Shape& shape, const Eigen::Vector3d& p) {
  const std::vector<double> size = shape.dimensions();
  const double beside = std::hypot(p.x(), p.y());
  switch (shape.kind()) {
    case ShapeKind::sphere:
      return std::max(0.0, p.norm() - size[0]);
    case ShapeKind::capsule:
      return std::max(0.0, fromRectangle(beside, p.z(), 0.0, 0.5 * size[0]) - size[1]);
    case ShapeKind::box:
      return (p.cwiseAbs() - 0.5 * Eigen::Vector3d(size[0], size[1], size[2])).cwiseMax(0.0).norm();
    case ShapeKind::cylinder:
      return fromRectangle(beside, p.z(), size[1], 0.5 * size[0]);
    default:
      break;
  }
  const Eigen::Vector2d q(beside, p.z()), axis(0, -0.5 * size[0]), rim(size[1], -0.5 * size[0]), tip(0, 0.5 * size[0]);
  const bool inside = q.y() >= axis.y() && (tip - rim).x() * (q - rim).y() - (tip - rim).y() * (q - rim).x() >= 0.0;
  return inside ? 0.0 : std::min(fromSegment(q, axis, rim), fromSegment(q, rim, tip));
}

/// Returns the distance of `p` from the triangle `t`. If the projection of `p` is inside the triangle, this is the
/// distance from its plane. Otherwise it is the distance from the nearest side.
double fromTriangle(const Eigen::Vector3d& p, const std::array<Eigen::Vector3d, 3>& t) {
  const Eigen::Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  double nearest = std::numeric_limits<double>::infinity();
  bool within = true;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d a = t[i], side = t[(i + 1) % 3] - a;
    within = within && normal.dot(side.cross(p - a)) >= 0.0;
    const double along = std::min(1.0, std::max(0.0, (p - a).dot(side) / side.squaredNorm()));
    nearest = std::min(nearest, (p - a - along * side).norm());
  }
  return within ? std::abs(normal.dot(p - t[0])) : nearest;
}

TEST(DistanceOracle, MeasuresFromAPointAsTheFormulasDo) {
  Random random(1);
  for (const ShapeKind kind :
       {ShapeKind::sphere, ShapeKind::box, ShapeKind::cylinder, ShapeKind::cone, ShapeKind::capsule}) {
    SCOPED_TRACE(name(kind));
    for (int i = 0; i < kTrials; ++i) {
      const Shape shape = randomSolid(random, kind);
      const Pose pose = randomPose(random, 2.0);
      const Eigen::Vector3d point = randomPoint(random, 1.5 * shape.reach());
      const double padding = random.chance(0.5) ? 0.0 : random.uniform(0.0, 0.1), radius = random.logUniform(1e-3, 1.0);
      Pose ball = Pose::Identity();
      ball.translation() = pose * point;
      const Interval found = distanceOf(Convex(shape, pose, padding), Convex(Shape::sphere(radius), ball, 0.0));
      const double expected = std::max(0.0, pointDistance(shape, point) - padding - radius);
      ASSERT_LE(found.width(), kClose);
      ASSERT_LE(found.errorOf(expected), kClose)
          << expected << " is not within " << found.lower << " .. " << found.upper;
    }
  }
}

TEST(DistanceOracle, MeasuresFromATriangleAsTheFormulaDoes) {
  Random random(2);
  for (int i = 0; i < kTrials; ++i) {
    std::array<Eigen::Vector3d, 3> corners;
    for (Eigen::Vector3d& corner : corners) corner = randomPoint(random, 1.0);
    const Eigen::Vector3d point = randomPoint(random, 2.0);
    const Pose pose = randomPose(random, 2.0);
    const Interval found = distanceOf(Convex(corners, pose, 0.0), Convex(Eigen::Vector3d(pose * point)));
    ASSERT_LE(found.width(), kClose);
    ASSERT_LE(found.errorOf(fromTriangle(point, corners)), kClose);
  }
}

TEST(DistanceOracle, MeasuresBetweenBoxesAsTheirSidesDo) {
  Random random(3);
  for (int i = 0; i < kTrials; ++i) {
    const Shape a = randomSolid(random, ShapeKind::box), b = randomSolid(random, ShapeKind::box);
    Pose world_from_a = Pose::Identity(), world_from_b = Pose::Identity();
    world_from_b.translation() = randomPoint(random, 1.5);
    Eigen::Vector3d gap;
    for (int k = 0; k < 3; ++k) {
      gap[k] = std::abs(world_from_b.translation()[k]) - 0.5 * (a.dimensions()[k] + b.dimensions()[k]);
    }
    const Pose turn = randomPose(random, 1.0);
    const Convex first(a, turn * world_from_a, 0.0), second(b, turn * world_from_b, 0.0);
    const Interval distance = distanceOf(first, second), depth = depthOf(first, second);
    ASSERT_LE(distance.width(), kClose);
    ASSERT_LE(distance.errorOf(gap.cwiseMax(0.0).norm()), kClose);
    ASSERT_LE(depth.errorOf(std::max(0.0, -gap.maxCoeff())), kClose);
  }
}

// There is no formula for two curved shapes. But each bound is proved, so it is enough that the bounds are close
// together.
TEST(DistanceOracle, KnowsEveryPairOfKindsClosely) {
  Random random(4);
  for (int i = 1; i <= 6; ++i) {
    for (int j = i; j <= 6; ++j) {
      SCOPED_TRACE(std::string(name(ShapeKind(i))) + ", " + name(ShapeKind(j)));
      for (int k = 0; k < kTrials / 4; ++k) {
        const Shape a = randomSolid(random, ShapeKind(i)), b = randomSolid(random, ShapeKind(j));
        const double far = a.reach() + b.reach();
        const Convex first(a, randomPose(random, far), 0.0), second(b, randomPose(random, far), 0.0);
        const Interval forth = distanceOf(first, second), back = distanceOf(second, first);
        ASSERT_LE(forth.width(), kClose);
        ASSERT_LE(std::max(forth.lower, back.lower), std::min(forth.upper, back.upper) + 1e-15);
      }
    }
  }
}

TEST(DepthOracle, MeasuresHowDeepAPointLiesInACylinder) {
  Random random(5);
  int unknown = 0;
  for (int i = 0; i < kTrials / 4; ++i) {
    const Shape shape = randomSolid(random, ShapeKind::cylinder);
    const double half = 0.5 * shape.dimensions()[0], radius = shape.dimensions()[1];
    const double angle = random.uniform(0, 6.28), beside = random.uniform(0, radius), z = random.uniform(-half, half);
    const Eigen::Vector3d point(beside * std::cos(angle), beside * std::sin(angle), z);
    const Pose pose = randomPose(random, 2.0);
    const double expected = std::min(radius - beside, half - std::abs(z));
    const Interval depth = depthOf(Convex(shape, pose, 0.0), Convex(Eigen::Vector3d(pose * point)), 0.5 * expected);
    ASSERT_LE(depth.errorOf(expected), kClose);
    unknown += depth.lower <= 0.5 * expected;
  }
  EXPECT_LE(unknown, kTrials / 400);
}

// Moves a shape into another shape that it touches. The lower bound must not exceed the move. It is seldom unknown.
TEST(DepthOracle, SeesWhatOverlaps) {
  Random random(6);
  for (int i = 2; i <= 6; ++i) {
    for (int j = i; j <= 6; ++j) {
      if (ShapeKind(i) == ShapeKind::capsule && ShapeKind(j) == ShapeKind::capsule) continue;
      SCOPED_TRACE(std::string(name(ShapeKind(i))) + ", " + name(ShapeKind(j)));
      int unseen = 0;
      for (int k = 0; k < 100; ++k) {
        const Shape a = randomSolid(random, ShapeKind(i)), b = randomSolid(random, ShapeKind(j));
        const Pose world_from_a = randomPose(random, 1.0);
        Pose world_from_b = randomPose(random, 1.0);
        const Convex first(a, world_from_a, 0.0);
        const CoreDistance apart = coreDistance(first, Convex(b, world_from_b, 0.0));
        if (apart.lower < 1e-6L) continue;
        const double push = random.logUniform(1e-4, 1e-2);
        const Vector3r way = (apart.on_first - apart.on_second) / apart.upper;
        const Real radii = first.radius() + Convex(b, world_from_b, 0.0).radius();
        world_from_b.translation() += ((apart.upper - radii + push) * way).cast<double>();
        const Interval depth = depthOf(first, Convex(b, world_from_b, 0.0), 1e-5);
        ASSERT_LE(depth.lower, push + kClose);
        unseen += depth.lower <= 1e-5 && depth.upper > 1e-5;
      }
      EXPECT_LE(unseen, 3);
    }
  }
}

TEST(SolidOracle, KnowsTheInsideOfABoxAndOfABall) {
  Random random(7);
  const Eigen::Vector3d size(1.0, 2.0, 0.3);
  for (const TriangleMesh& mesh : {boxMesh(size), unwelded(boxMesh(size))}) {
    for (int i = 0; i < kTrials; ++i) {
      const Pose pose = randomPose(random, 10.0);
      const SolidOracle solid(meshOf(mesh), pose, 0.0);
      ASSERT_TRUE(solid.isClosed());
      const Eigen::Vector3d point = randomPoint(random, 1.2);
      const double out = (point.cwiseAbs() - 0.5 * size).maxCoeff();
      if (std::abs(out) < 1e-9) continue;
      ASSERT_EQ(solid.encloses((pose * point).cast<Real>()), out < 0.0);
      ASSERT_LE(distanceOf(solid, Eigen::Vector3d(pose * point)).errorOf(pointDistance(Shape::box(size), point)),
                kClose);
    }
  }
  const SolidOracle ball(meshOf(ballMesh(1)), Pose::Identity(), 0.0);
  ASSERT_TRUE(ball.isClosed());
  for (int i = 0; i < kTrials; ++i) {
    const Eigen::Vector3d point = randomPoint(random, 1.5);
    if (point.norm() > 0.9 && point.norm() < 1.0) continue;  // skips points between the triangles and the sphere
    ASSERT_EQ(ball.encloses(point.cast<Real>()), point.norm() < 0.95);
  }
}

TEST(SolidOracle, TakesNoNoticeOfTrianglesWithoutAnArea) {
  TriangleMesh mesh = boxMesh({1, 1, 1});
  mesh.triangles.push_back({0, 1, 0});
  mesh.triangles.push_back({5, 5, 5});
  const SolidOracle solid(meshOf(mesh), Pose::Identity(), 0.0);
  EXPECT_TRUE(solid.isClosed());
  EXPECT_TRUE(solid.encloses({0.1L, 0.2L, 0.3L}));
  EXPECT_FALSE(solid.encloses({0.1L, 0.2L, 0.7L}));
}

TEST(SolidOracle, SeesWhetherAMeshIsClosed) {
  Random random(8);
  for (const TriangleMesh& mesh : {boxMesh({1, 2, 3}), ballMesh(0), ballMesh(2), lumpMesh(random, {1, 2, 3})}) {
    const auto closed = [](const TriangleMesh& m) { return SolidOracle(meshOf(m), Pose::Identity(), 0.0).isClosed(); };
    EXPECT_TRUE(closed(mesh));
    EXPECT_TRUE(closed(unwelded(mesh)));
    for (std::size_t hole = 0; hole < mesh.triangles.size(); ++hole) EXPECT_FALSE(closed(without(mesh, hole)));
  }
}

// The triangles of the test meshes must face outward, like those of a solid mesh.
TEST(SolidOracle, MeshesOfTheTestsFaceOutward) {
  Random random(9);
  for (const TriangleMesh& mesh : {boxMesh({1, 2, 3}), ballMesh(0), ballMesh(2), lumpMesh(random, {1, 2, 3})}) {
    for (const auto& [a, b, c] : mesh.triangles) {
      EXPECT_GT(mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])), 0.0);
    }
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
