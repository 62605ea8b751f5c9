// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares distance fields of random worlds with a reference implementation that shares no code with the library.
#include "hgrid_proximity/queries/distance_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/queries/query.h"
#include "test/support/depth_oracle.h"
#include "test/support/maps.h"
#include "test/support/refusals.h"
#include "test/support/scenes.h"
#include "test/support/solid_oracle.h"
#include "test/support/solids.h"

namespace hgrid {
namespace test {
namespace {

const std::shared_ptr<NarrowPhase>& narrowPhase() {
  static const std::shared_ptr<NarrowPhase> shared = makeCoreNarrowPhase();
  return shared;
}

BodyShape solidShape(const Shape& shape, const Pose& body_from_shape, double padding) {
  BodyShape result = shapeOf(shape);
  result.body_from_shape = body_from_shape;
  result.padding = padding;
  result.solid = narrowPhase()->solidOf(shape);
  return result;
}

/// Returns bounds of the distance [m] of a point from the surface of a mesh, or from a convex core; 0 inside the core.
Interval coreDistanceOf(const SolidOracle& solid, const Eigen::Vector3d& point) {
  Interval nearest{1e9, 1e9};
  for (const Convex& piece : solid.pieces()) {
    const CoreDistance core = coreDistance(piece, Convex(point));
    nearest.lower = std::min(nearest.lower, double(core.lower));
    nearest.upper = std::min(nearest.upper, double(core.upper));
  }
  return nearest;
}

/// Returns bounds of the signed distance [m] of a point from a solid.
Interval signedDistanceOf(const SolidOracle& solid, ShapeKind kind, const Eigen::Vector3d& point) {
  const Interval core = coreDistanceOf(solid, point);
  const auto radius = double(solid.radius());
  if (kind == ShapeKind::mesh && solid.encloses(point.cast<Real>()))
    return {-core.upper - radius, -core.lower - radius};
  if (core.upper > 1e-12) return {core.lower - radius, core.upper - radius};
  const Interval depth = depthOf(solid.pieces().front(), Convex(point));
  return {-depth.upper, -depth.lower};
}

/// A random world with one shape per body, and the same shapes for the reference.
struct FieldWorld {
  explicit FieldWorld(unsigned seed, const std::vector<ShapeKind>& kinds) : random(seed) {
    SceneOptions options;
    options.origin << 0.5, -0.25, 2.0;
    Scene scene(options);
    for (int i = 0; i < 12; ++i) {
      const ShapeKind kind = kinds[std::size_t(random.below(int(kinds.size())))];
      const Shape shape = randomSolid(random, kind, {0.05, 1.0, 8.0});
      Body body = obstacle("o" + std::to_string(i));
      const double padding = random.chance(0.3) ? random.uniform(0.0, 0.1) : 0.0;
      body.shapes.push_back(solidShape(shape, randomPose(random, 0.2), padding));
      const Pose pose = randomPose(random, 1.2);
      put(scene, body, pose);
      solids.emplace_back(shape, pose * body.shapes.front().body_from_shape, padding);
      shape_kinds.push_back(kind);
    }
    snapshot = scene.commit(Time{1}, {});
    lattice.world_from_lattice = randomPose(random, 0.5);
    lattice.world_from_lattice.translation() -= lattice.world_from_lattice.linear() * Eigen::Vector3d::Constant(1.0);
    lattice.count = {7, 6, 5};
    lattice.resolution = 0.35;
  }
  DistanceField field(double most, bool gradients) const {
    return distanceField(*snapshot, lattice, {most, gradients}, *narrowPhase(), {});
  }
  Eigen::Vector3d pointAt(std::size_t index) const {
    const std::size_t x = index % lattice.count[0], y = index / lattice.count[0] % lattice.count[1],
                      z = index / lattice.count[0] / lattice.count[1];
    return lattice.world_from_lattice * (lattice.resolution * Eigen::Vector3d(double(x), double(y), double(z)));
  }
  Interval truth(const Eigen::Vector3d& point) const {
    Interval result{1e9, 1e9};
    for (std::size_t i = 0; i < solids.size(); ++i) {
      const Interval one = signedDistanceOf(solids[i], shape_kinds[i], point);
      result.lower = std::min(result.lower, one.lower);
      result.upper = std::min(result.upper, one.upper);
    }
    return result;
  }

  Random random;
  std::vector<SolidOracle> solids;
  std::vector<ShapeKind> shape_kinds;
  std::shared_ptr<const Snapshot> snapshot;
  Lattice lattice;
};

const std::vector<ShapeKind> kAllKinds{ShapeKind::sphere,  ShapeKind::box,  ShapeKind::cylinder, ShapeKind::cone,
                                       ShapeKind::capsule, ShapeKind::hull, ShapeKind::mesh};

TEST(DistanceField, EqualsTheSignedDistanceOfTheNearestShape) {
  int inside = 0, outside = 0, far = 0;
  for (unsigned seed = 1; seed <= 80; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const FieldWorld world(seed, kAllKinds);
    const double most = seed % 3 == 0 ? 0.4 : 3.0;
    const DistanceField field = world.field(most, false);
    ASSERT_EQ(field.distance.size(), 210u);
    EXPECT_TRUE(field.gradient.empty());
    EXPECT_EQ(field.unknown, 0u);
    for (std::size_t i = 0; i < field.distance.size(); ++i) {
      const Interval truth = world.truth(world.pointAt(i));
      const Interval clamped{std::max(-most, std::min(truth.lower, most)),
                             std::max(-most, std::min(truth.upper, most))};
      ASSERT_LT(clamped.errorOf(field.distance[i]), 1e-8)
          << "point " << i << ": " << field.distance[i] << " is not in " << clamped.lower << " .. " << clamped.upper;
      ++(truth.lower > most ? far : truth.upper > 0.0 ? outside : inside);
    }
  }
  EXPECT_GT(inside, 200);
  EXPECT_GT(outside, 1000);
  EXPECT_GT(far, 200);
}

// Claim: each gradient equals the central differences of the distance. Hulls are left out, because this narrow phase
// returns no depth inside them.
TEST(DistanceField, GradientsAreCentralDifferences) {
  int inside = 0, outside = 0, corners = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    FieldWorld world(seed, {ShapeKind::sphere, ShapeKind::box, ShapeKind::cylinder, ShapeKind::cone, ShapeKind::capsule,
                            ShapeKind::mesh});
    const DistanceField field = world.field(3.0, true);
    constexpr double kStep = 1e-5;
    for (std::size_t i = 0; i < field.distance.size(); ++i) {
      Lattice around = world.lattice;
      around.resolution = kStep;
      around.count = {3, 3, 3};
      around.world_from_lattice.translation() =
          world.pointAt(i) - kStep * world.lattice.world_from_lattice.linear() * Eigen::Vector3d::Ones();
      const std::vector<double> near =
          distanceField(*world.snapshot, around, {3.0, false}, *narrowPhase(), {}).distance;
      const Eigen::Vector3d difference =
          Eigen::Vector3d(near[14] - near[12], near[16] - near[10], near[22] - near[4]) / (2 * kStep);
      // Where two surfaces are equally near, the gradient is not continuous, and the central difference is shorter
      // than 1.
      if (std::abs(difference.norm() - 1.0) > 1e-6) {
        ++corners;
        continue;
      }
      ASSERT_LT((field.gradient[i] - difference).norm(), 1e-3) << "point " << i << " at " << field.distance[i];
      ++(field.distance[i] < 0.0 ? inside : outside);
    }
  }
  EXPECT_GT(inside, 60);
  EXPECT_GT(outside, 1000);
  EXPECT_LT(corners, (inside + outside) / 10);
}

TEST(DistanceField, GradientsAreZeroWhereTheDistanceIsCut) {
  const FieldWorld world(1, kAllKinds);
  const DistanceField field = world.field(0.3, true);
  int cut = 0;
  for (std::size_t i = 0; i < field.distance.size(); ++i) {
    if (field.distance[i] < 0.3) continue;
    ++cut;
    EXPECT_EQ(field.distance[i], 0.3);
    EXPECT_EQ(field.gradient[i], Eigen::Vector3d::Zero());
  }
  EXPECT_GT(cut, 10);
}

TEST(DistanceField, HasPlanesAndCellsOfMaps) {
  Scene scene{SceneOptions{}};
  put(scene, planeBody("floor", 0.1), at(0, 0, -1));
  const BodyId id = put(scene, mapBody("hall"), at(1, 0, 0));
  const std::uint16_t key = Voxel::kOriginKey, next = key + 2;
  scene.setCells(id, cellsOf(0.5, {{key, key, key, 0}, {next, key, key, 0}}));  // at x = 1.0 .. 1.5 and 2.0 .. 2.5
  const auto snapshot = scene.commit(Time{1}, {});
  Lattice line;
  line.world_from_lattice = at(0.7, 0.25, 0.25);
  line.resolution = 0.1;
  line.count = {21, 1, 1};
  const DistanceField field = distanceField(*snapshot, line, {1.2, true}, *narrowPhase(), {});
  for (std::size_t i = 0; i < 21; ++i) {
    const double x = 0.7 + 0.1 * double(i);
    const double first = std::max(1.0 - x, x - 1.5), second = std::max(2.0 - x, x - 2.5);
    double expected = std::min({first, second, 1.15});
    if (expected < 0.0) expected = std::max(expected, -0.25);
    EXPECT_NEAR(field.distance[i], expected, 1e-6) << x;
  }
  EXPECT_NEAR(field.gradient[0].x(), -1.0, 1e-9);
  EXPECT_NEAR(field.gradient[20].x(), 1.0, 1e-9);
  line.world_from_lattice = at(-3, 0, 0);
  line.count = {1, 1, 4};
  line.resolution = 0.5;
  const DistanceField above = distanceField(*snapshot, line, {9, true}, *narrowPhase(), {});
  EXPECT_NEAR(above.distance[0], 0.9, 1e-12);
  EXPECT_EQ(above.gradient[0], Eigen::Vector3d::UnitZ());
}

TEST(DistanceField, IsUnknownWhereSomethingUnseenMayBeNearer) {
  Scene scene{SceneOptions{}};
  Body body = obstacle("ball");
  body.shapes.push_back(solidShape(Shape::sphere(0.5), Pose::Identity(), 0.0));
  put(scene, body, at(0));
  Body old = body;
  old.name = "obstacle/old";
  old.max_speed = 1.0;
  const BodyId id = put(scene, old, at(10));
  scene.setState(id, Freshness::stale, 1.9);  // it may have moved by 1.9 m
  const auto snapshot = scene.commit(Time{1}, {});
  Lattice line;
  line.resolution = 1.0;
  line.count = {11, 1, 1};
  const DistanceField field = distanceField(*snapshot, line, {20, true}, *narrowPhase(), {});
  for (std::size_t i = 0; i < 11; ++i) {
    const double x = double(i);
    const double known = std::min(x, 10 - x) - 0.5, possible = 10 - x - 2.4;
    if (known > 0.0 && possible < known) {
      EXPECT_TRUE(std::isnan(field.distance[i])) << x;
      EXPECT_TRUE(field.gradient[i].hasNaN());
    } else {
      EXPECT_NEAR(field.distance[i], known, 1e-9) << x;
    }
  }
  EXPECT_EQ(field.unknown, 5u);
  EXPECT_EQ(field.because, Unknown::stale_body);
  EXPECT_NE(field.reason.find("obstacle/old"), std::string::npos);
  QueryScope without;
  without.exclude = {"obstacle/old"};
  EXPECT_EQ(distanceField(*snapshot, line, {20, false}, *narrowPhase(), without).unknown, 0u);
}

/// Returns a field along x from x = `from`, with this body at the origin.
DistanceField fieldAlongX(const Body& body, double from, double resolution, std::uint32_t count) {
  Scene scene{SceneOptions{}};
  put(scene, body, at(0));
  Lattice line;
  line.world_from_lattice = at(from);
  line.resolution = resolution;
  line.count = {count, 1, 1};
  return distanceField(*scene.commit(Time{1}, {}), line, {5.0, true}, *narrowPhase(), {});
}

// Claim: inside an open mesh the distance is 0. That does not make the distances of the following points too small.
TEST(DistanceField, IsExactBehindTheOpeningOfAMesh) {
  Body box = obstacle("box");
  TriangleMesh mesh = boxMesh({1, 1, 1});
  const auto is_front = [&](const std::array<std::uint32_t, 3>& triangle) {
    return std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t i) { return mesh.vertices[i].x() > 0.0; });
  };
  mesh.triangles.erase(std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), is_front), mesh.triangles.end());
  ASSERT_EQ(mesh.triangles.size(), 10u);
  box.shapes.push_back(solidShape(meshOf(mesh), Pose::Identity(), 0.0));
  const DistanceField field = fieldAlongX(box, -0.9, 0.1, 25);
  int inside = 0;
  for (std::size_t i = 0; i < 25; ++i) {
    const double x = -0.9 + 0.1 * double(i);
    if (field.distance[i] == 0.0) {
      EXPECT_TRUE(x > -0.51 && x < 0.51) << x;
      ++inside;
    } else if (x > 0.49) {
      EXPECT_NEAR(field.distance[i], std::hypot(x - 0.5, 0.5), 1e-9) << x;  // to the edges of the opening
    } else if (x < -0.51) {
      EXPECT_NEAR(field.distance[i], -0.5 - x, 1e-9) << x;
    }
  }
  EXPECT_GT(inside, 3);
}

TEST(DistanceField, OnTheSurfaceOfAPaddedMeshIsMinusThePadding) {
  Body box = obstacle("box");
  box.shapes.push_back(solidShape(meshOf(boxMesh({1, 1, 1})), Pose::Identity(), 0.1));
  const DistanceField field = fieldAlongX(box, -0.75, 0.25, 4);
  const double expected[] = {0.15, -0.1, -0.35, -0.6};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(field.distance[i], expected[i], 1e-9) << i;
}

TEST(DistanceField, MeasuresABoxInPlaceOfAShapeThatCouldNotBeRead) {
  Body ball = obstacle("ball");
  ball.shapes.push_back(shapeOf(Shape::sphere(0.5)));  // it has no solid
  const DistanceField field = fieldAlongX(ball, 0.0, 0.4, 3);
  const double expected[] = {-0.5, -0.1, 0.3};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(field.distance[i], expected[i], 1e-6) << i;
}

TEST(DistanceField, StopsAtItsDeadline) {
  const FieldWorld world(1, kAllKinds);
  QueryScope scope;
  scope.deadline = std::chrono::steady_clock::now();
  const DistanceField field = distanceField(*world.snapshot, world.lattice, {1.0, true}, *narrowPhase(), scope);
  EXPECT_EQ(field.unknown, 210u);
  EXPECT_EQ(field.distance.size(), 210u);
  EXPECT_EQ(field.gradient.size(), 210u);
  EXPECT_EQ(field.because, Unknown::budget);
}

TEST(DistanceField, RefusesInvalidLattices) {
  FieldWorld world(1, {ShapeKind::sphere});
  const auto code = [&](double resolution, double most) {
    world.lattice.resolution = resolution;
    return refusalOf([&] { world.field(most, false); });
  };
  EXPECT_EQ(code(0.0, 1.0), Code::out_of_range);
  EXPECT_EQ(code(std::nan(""), 1.0), Code::out_of_range);
  EXPECT_EQ(code(0.1, 0.0), Code::out_of_range);
  EXPECT_EQ(code(0.1, -INFINITY), Code::out_of_range);
  EXPECT_EQ(code(1e10, 1.0), Code::out_of_range);
  world.lattice.count = {1u << 31, 1u << 31, 2};
  EXPECT_EQ(code(0.1, 1.0), Code::limit);
  world.lattice.count = {1, 1, 1};
  world.lattice.world_from_lattice = Pose::Identity();
  EXPECT_EQ(code(1e10, 1.0), Code::ok);
  world.lattice.world_from_lattice.translation().x() = std::nan("");
  EXPECT_EQ(code(0.1, 1.0), Code::nonfinite);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
