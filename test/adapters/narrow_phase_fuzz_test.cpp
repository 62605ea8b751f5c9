// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Whatever two shapes are and however they lie: nothing aborts, nothing throws, every answer agrees with itself.
// HGRID_TEST_FUZZ times as many cases as by default.
#include <gtest/gtest.h>

#include "test/adapters/narrow_phase_judge.h"

namespace hgrid {
namespace test {
namespace {

int cases(int by_default) { return by_default * countFromEnvironment("HGRID_TEST_FUZZ", 1); }

/// A hull that is hardly one: a point, points in line, in a plane, or many times the same.
TriangleMesh poorHull(Random& random, double size) {
  const int dimensions = random.below(4), count = random.between(1, 12);
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (int k = 0; k < dimensions; ++k)
      point[k] = size * (random.chance(0.5) ? random.between(-1, 1) : random.uniform(-1, 1));
    for (int copies = random.between(1, 3); copies > 0; --copies) mesh.vertices.push_back(point);
  }
  return mesh;
}

/// Adds triangles without an area: a corner twice, all corners in line, all the same.
void addPoorTriangles(Random& random, TriangleMesh& mesh) {
  for (int i = random.between(1, 6); i > 0; --i) {
    const auto [a, b, c] = mesh.triangles[std::size_t(random.below(int(mesh.triangles.size())))];
    const auto middle = std::uint32_t(mesh.vertices.size());
    switch (random.below(3)) {
      case 0:
        mesh.triangles.push_back({a, b, a});
        break;
      case 1:
        mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
        mesh.triangles.push_back({a, middle, b});
        break;
      default:
        mesh.triangles.push_back({c, c, c});
    }
  }
}

/// Flat, thin, tiny, huge, poor or as others are.
Shape strangeShape(Random& random) {
  const auto kind = ShapeKind(random.between(1, 7));
  const double huge = random.logUniform(1e4, 4e4);
  switch (random.below(7)) {
    case 0:  // plates and needles
      if (kind == ShapeKind::box) return Shape::box({random.logUniform(0.1, 2), random.logUniform(0.1, 2), 1e-4});
      if (kind == ShapeKind::cylinder) return Shape::cylinder(random.logUniform(0.1, 2), 1e-4);
      if (kind == ShapeKind::cone) return Shape::cone(1e-4, random.logUniform(0.1, 2));
      if (kind == ShapeKind::mesh) return meshOf(boxMesh({1.0, random.logUniform(0.1, 2), 1e-4}));
      return Shape::capsule(random.logUniform(0.1, 2), 1e-4);
    case 1:  // tiny
      return randomSolid(random, kind, {2e-4, 4e-4, 1.0});
    case 2:  // huge
      return randomSolid(random, kind, {huge, huge, 2.0});
    case 3:
      return Shape::hull(std::make_shared<TriangleMesh>(poorHull(random, random.logUniform(1e-3, 2))));
    case 4: {
      TriangleMesh mesh = lumpMesh(random, {1.0, random.uniform(0.1, 1.0), 0.5});
      addPoorTriangles(random, mesh);
      return meshOf(random.chance(0.5) ? mesh : without(mesh, 0));
    }
    case 5: {
      ShapeLimits flat;
      flat.allow_flat = true;
      return Shape::box({random.logUniform(0.1, 2), random.logUniform(0.1, 2), 0.0}, flat);
    }
    default:
      return randomSolid(random, kind);
  }
}

/// Touching, deep, one in the middle of the other, or anywhere; near the origin or far from it.
Case strangeCase(Random& random) {
  const Shape first = strangeShape(random), second = random.chance(0.1) ? first : strangeShape(random);
  const double reach = first.reach() + second.reach();
  const auto padding = [&] { return random.chance(0.7) ? 0.0 : random.logUniform(1e-6, 0.1); };
  Case strange{first, second, randomPose(random, 1.0), randomPose(random, 1.0), padding(), padding()};
  switch (random.below(5)) {
    case 0:
      strange.world_from_second = strange.world_from_first;
      break;
    case 1:
      strange.world_from_second.translation() = strange.world_from_first.translation();
      break;
    case 2:
      strange.world_from_second = randomPose(random, reach);
      break;
    default: {
      const bool parallel = random.chance(0.5);
      if (parallel) strange.world_from_second = strange.world_from_first;
      strange.world_from_second.translation() += 1.5 * reach * randomPose(random, 1.0).linear().col(random.below(3));
      bringTo(random.logUniform(1e-16, 1e-6) * (random.chance(0.3) ? -1.0 : 1.0), strange);
    }
  }
  if (random.chance(0.2)) {
    const Eigen::Vector3d off = 1e6 * randomPose(random, 1.0).linear().col(0);
    strange.world_from_first.translation() += off;
    strange.world_from_second.translation() += off;
  }
  return strange;
}

TEST(NarrowPhaseFuzz, EveryAnswerAgreesWithItself) {
  Random random(11);
  int failed = 0;
  for (int i = 0; i < cases(30000); ++i) {
    SCOPED_TRACE("case " + std::to_string(i));
    const Case strange = strangeCase(random);
    ASSERT_NO_THROW({
      const Trial trial(strange);
      const double up_to = random.chance(0.7) ? std::numeric_limits<double>::infinity() : random.logUniform(1e-9, 10.0);
      const Proximity answer = trial.measure(up_to);
      ASSERT_EQ(unsound(answer, up_to), "") << strange.text();
      ASSERT_TRUE(isSame(answer, swapped(trial.measureSwapped(up_to)))) << strange.text();
      failed += answer.status == Measure::failed;
    });
  }
  EXPECT_EQ(failed, 0) << "a pair of finite shapes at finite places can be measured";
}

// What touches here touches in the coordinates of a double: the error is that of the coordinates and the sizes.
TEST(NarrowPhaseFuzz, WhatIsStrangeIsMeasuredRightToo) {
  Random random(12);
  Claim distance("the distance apart is right", 1.0), contact("what is said to touch is not apart", 1.0);
  Claim missed("contact is not missed", 0.0);
  for (int i = 0; i < cases(10000); ++i) {
    const Case strange = strangeCase(random);
    const Proximity answer = Trial(strange).measure();
    const SolidOracle first = strange.first(), second = strange.second();
    const Interval truth = distanceOf(first, second).interval;
    const double allowed = 1e-6 + 1e-9 * (strange.first_shape.reach() + strange.second_shape.reach());
    if (answer.status == Measure::apart) {
      distance.hold(truth.errorOf(answer.distance) / allowed, strange);
      if (truth.lower == 0.0) missed.hold(!overlapByMore(first, second, 10 * allowed), strange);
    } else if (answer.status != Measure::containment_unknown) {
      contact.hold(truth.lower / allowed, strange);
    }
  }
  distance.expectHeld();
  contact.expectHeld();
  missed.expectHeld();
}

TEST(NarrowPhaseFuzz, APoseThatIsNotFiniteFails) {
  Random random(13);
  const double infinity = std::numeric_limits<double>::infinity();
  const double strangers[] = {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity};
  for (int i = 0; i < cases(2000); ++i) {
    Case broken = strangeCase(random);
    Pose& pose = random.chance(0.5) ? broken.world_from_first : broken.world_from_second;
    const double stranger = strangers[random.below(3)];
    if (random.chance(0.5)) {
      pose.translation()[random.below(3)] = stranger;
    } else {
      pose.linear()(random.below(3), random.below(3)) = stranger;
    }
    const Trial trial(broken);
    for (const Proximity& answer : {trial.measure(), trial.measureSwapped(), trial.measure(0.1)}) {
      ASSERT_EQ(answer.status, Measure::failed) << broken.text();
      ASSERT_EQ(unsound(answer), "") << broken.text();
    }
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
