// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "test/support/shapes.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace {

using test::Random;
using Wide = Eigen::Matrix<long double, 3, 1>;

const double kInfinity = std::numeric_limits<double>::infinity();

/// Returns how far [m] a shape extends from its origin in a direction (its support function), in extended precision.
long double extent(const Shape& shape, const Wide& direction) {
  const long double across = std::sqrt(direction[0] * direction[0] + direction[1] * direction[1]);
  const std::vector<double> d = shape.dimensions();
  switch (shape.kind()) {
    case ShapeKind::sphere:
      return d[0];
    case ShapeKind::box:
      return 0.5L * (std::abs(direction[0]) * d[0] + std::abs(direction[1]) * d[1] + std::abs(direction[2]) * d[2]);
    case ShapeKind::cylinder:
      return 0.5L * d[0] * std::abs(direction[2]) + d[1] * across;
    case ShapeKind::cone:
      return std::max(0.5L * d[0] * direction[2], d[1] * across - 0.5L * d[0] * direction[2]);
    case ShapeKind::capsule:
      return 0.5L * d[0] * std::abs(direction[2]) + d[1];
    default:
      break;
  }
  long double most = -std::numeric_limits<long double>::infinity();
  for (const Eigen::Vector3d& vertex : shape.mesh()->vertices) {
    most = std::max(most, direction.dot(vertex.cast<long double>()));
  }
  return most;
}

/// Returns the signed distance [m] of a padded shape from a padded plane, in extended precision.
long double height(const Shape& shape, const Pose& world_from_shape, double padding, const Pose& world_from_plane,
                   double plane_padding) {
  const Wide normal = world_from_plane.linear().col(2).cast<long double>();
  const Wide down = -(world_from_shape.linear().cast<long double>().transpose() * normal);
  const Wide between =
      world_from_shape.translation().cast<long double>() - world_from_plane.translation().cast<long double>();
  return normal.dot(between) - extent(shape, down) - padding - plane_padding;
}

/// A random plane and a random shape near it.
struct Case {
  explicit Case(unsigned seed) : random(seed), shape(test::randomShape(random, 1.0)) {
    const double far = random.chance(0.3) ? 1e6 : 10.0;
    plane = test::randomPose(random, far);
    pose = test::randomPose(random, 2.0);
    pose.translation() += plane.translation();
    if (random.chance(0.5)) padding = random.uniform(0.0, 0.3);
    if (random.chance(0.5)) plane_padding = random.uniform(0.0, 0.3);
    exact = double(height(shape, pose, padding, plane, plane_padding));
    tolerance = 1e-14 * far + 1e-12;
  }
  Random random;
  Shape shape;
  Pose plane = Pose::Identity(), pose = Pose::Identity();
  double padding = 0.0, plane_padding = 0.0;
  double exact = 0.0;      // [m] the signed distance
  double tolerance = 0.0;  // [m]
};

TEST(PlanePair, DistanceAndDepthAreThoseOfTheDeepestPoint) {
  const std::shared_ptr<NarrowPhase> phase = makeCoreNarrowPhase();
  const auto plane = phase->solidOf(Shape::plane());
  int apart = 0, contacts = 0;
  for (unsigned seed = 1; seed <= 5000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Case c(seed);
    const auto solid = phase->solidOf(c.shape);
    const PlacedSolid floor{*plane, c.plane, c.plane_padding}, other{*solid, c.pose, c.padding};
    const Proximity found = phase->measure(floor, other, kInfinity);
    const Eigen::Vector3d normal = c.plane.linear().col(2);
    ASSERT_NEAR(found.distance, std::max(0.0, c.exact), c.tolerance);
    ASSERT_EQ(found.normal, normal);
    if (found.status == Measure::apart) {
      ++apart;
      ASSERT_NEAR((found.on_second - found.on_first).dot(normal), c.exact, 2.0 * c.tolerance);
    } else {
      ++contacts;
      ASSERT_EQ(found.status, Measure::contact);
      ASSERT_NEAR(found.depth, -c.exact, c.tolerance);
      Pose moved = c.pose;
      moved.translation() += (found.depth + 4.0 * c.tolerance) * normal;
      ASSERT_EQ(phase->measure(floor, {*solid, moved, c.padding}, kInfinity).status, Measure::apart);
    }
    ASSERT_NEAR(normal.dot(found.on_first - c.plane.translation()), c.plane_padding, c.tolerance);
    const Proximity exchanged = phase->measure(other, floor, kInfinity);
    ASSERT_EQ(exchanged.distance, found.distance);
    ASSERT_EQ(exchanged.normal, -found.normal);
    ASSERT_EQ(exchanged.on_first, found.on_second);
    ASSERT_EQ(exchanged.on_second, found.on_first);
    const double limit = 0.5 * found.distance;
    if (limit > c.tolerance) {
      ASSERT_EQ(phase->measure(floor, other, limit).distance, kInfinity);
    }
  }
  EXPECT_GT(apart, 1000);
  EXPECT_GT(contacts, 1000);
}

TEST(PlanePair, ContactsAreThereExactlyIfTheShapesMeet) {
  const std::shared_ptr<NarrowPhase> phase = makeCoreNarrowPhase();
  const auto plane = phase->solidOf(Shape::plane());
  for (unsigned seed = 1; seed <= 3000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Case c(seed);
    if (std::abs(c.exact) < 1e-8) continue;
    const auto solid = phase->solidOf(c.shape);
    const PlacedSolid floor{*plane, c.plane, c.plane_padding}, other{*solid, c.pose, c.padding};
    const std::vector<Contact> found = phase->contacts(floor, other, 100), exchanged = phase->contacts(other, floor, 1);
    ASSERT_EQ(found.empty(), c.exact > 0.0);
    ASSERT_EQ(exchanged.empty(), c.exact > 0.0);
    if (found.empty()) continue;
    ASSERT_NEAR(found.front().depth, -c.exact, c.tolerance);  // the deepest is first
    ASSERT_EQ(found.front().normal, Eigen::Vector3d(c.plane.linear().col(2)));
    ASSERT_EQ(exchanged.front().normal, -found.front().normal);
    ASSERT_TRUE(found.size() == 1u || c.shape.kind() == ShapeKind::mesh);
    const Contact whole = phase->measureContact(floor, other), swapped = phase->measureContact(other, floor);
    ASSERT_NEAR(whole.depth, -c.exact, c.tolerance);
    ASSERT_EQ(whole.normal, found.front().normal);
    ASSERT_EQ(swapped.normal, -whole.normal);
    ASSERT_EQ(swapped.point, whole.point);
    const Pose at(Eigen::Translation3d(whole.point));
    const PlacedSolid point{*phase->point(), at, 1e-6};
    ASSERT_TRUE(isContact(phase->measure(point, floor, 0.0).status));
    ASSERT_TRUE(isContact(phase->measure(point, other, 0.0).status));
  }
}

/// Claim: far from the plane's origin, where rounding alone makes it a contact, the contact is in the list as well.
TEST(PlanePair, AMeshInContactIsInTheListAlsoFarAway) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{0, 0, 0}, {1, 0, 0.1}, {0, 1, 0.1}};
  mesh->triangles = {{0, 1, 2}};
  const std::shared_ptr<NarrowPhase> phase = makeCoreNarrowPhase();
  const auto plane = phase->solidOf(Shape::plane()), solid = phase->solidOf(Shape::mesh(mesh));
  for (const double gap : {0.0, 2e-9, 5e-9, 8e-9, 2e-8}) {
    const PlacedSolid floor{*plane, Pose::Identity(), 0.0};
    const PlacedSolid corner{*solid, Pose(Eigen::Translation3d(1e6, 0.0, gap)), 0.0};
    const bool touches = gap < 1e-8;  // the bound of the rounding errors there
    EXPECT_EQ(isContact(phase->measure(floor, corner, 1.0).status), touches) << gap;
    EXPECT_EQ(phase->contacts(floor, corner, 9).size(), touches ? 1u : 0u) << gap;
  }
}

TEST(PlanePair, VerticesThatNoTriangleUsesDoNotCountInAMesh) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -50}};
  mesh->triangles = {{0, 1, 2}};
  const std::shared_ptr<NarrowPhase> phase = makeCoreNarrowPhase();
  const auto plane = phase->solidOf(Shape::plane()), solid = phase->solidOf(Shape::mesh(mesh));
  const Pose above(Eigen::Translation3d(0, 0, 2));
  EXPECT_DOUBLE_EQ(phase->measure({*plane, Pose::Identity(), 0.0}, {*solid, above, 0.0}, kInfinity).distance, 2.0);
}

TEST(PlanePair, QuerySolidsAreMeasuredAsWell) {
  const std::shared_ptr<NarrowPhase> phase = makeCoreNarrowPhase();
  const Pose at(Eigen::Translation3d(0, 0, -1));
  const PlacedSolid floor{*phase->plane(), Pose::Identity(), 0.0};
  EXPECT_NEAR(phase->measure({*phase->point(), at, 0.0}, floor, kInfinity).depth, 1.0, 1e-12);
  EXPECT_NEAR(phase->measure({*phase->needle(2.0), at, 0.5}, floor, kInfinity).depth, 2.5, 1e-12);
  EXPECT_NEAR(phase->measure({*phase->block({1, 1, 4}), at, 0.0}, floor, kInfinity).depth, 3.0, 1e-12);
}

TEST(PlanePair, TwoPlanesCountAsInContact) {
  const std::shared_ptr<NarrowPhase> phase = makeCoreNarrowPhase();
  const Pose up(Eigen::Translation3d(0, 0, 5));
  const PlacedSolid low{*phase->plane(), Pose::Identity(), 0.0}, high{*phase->plane(), up, 0.0};
  EXPECT_EQ(phase->measure(low, high, kInfinity).status, Measure::contact);
  EXPECT_TRUE(std::isnan(phase->measure(low, high, kInfinity).depth));
  EXPECT_EQ(phase->contacts(low, high, 10).size(), 1u);
  EXPECT_TRUE(phase->measureContact(low, high).point.hasNaN() && std::isnan(phase->measureContact(low, high).depth));
}

}  // namespace
}  // namespace hgrid
