// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// A closed mesh is solid, so a shape completely inside it is in contact with it. An open mesh has no defined inside.
// Therefore a shape that an open mesh may enclose must not count as apart from it.
#include <gtest/gtest.h>

#include "test/narrow/narrow_phase_judge.h"

namespace hgrid {
namespace test {
namespace {

/// Returns closed meshes around the origin, and their names. A sphere of radius 0.9 m fits into each mesh.
std::vector<std::pair<std::string, TriangleMesh>> vessels() {
  const auto scaled = [](TriangleMesh mesh, double factor) {
    for (Eigen::Vector3d& vertex : mesh.vertices) vertex *= factor;
    return mesh;
  };
  const TriangleMesh box = boxMesh({2.0, 2.5, 3.0}), ball = scaled(ballMesh(2), 1.1);
  return {{"box", box}, {"box of an STL file", unwelded(box)}, {"ball", ball}, {"ball of an STL file", unwelded(ball)}};
}

std::vector<ShapeKind> allKinds() {
  std::vector<ShapeKind> kinds;
  for (int kind = 1; kind <= 7; ++kind) kinds.push_back(ShapeKind(kind));
  return kinds;
}

const Proportions kSmall = {0.01, 0.2, 10.0};

Case placedIn(const Shape& outer, const Shape& inner, const Pose& world_from_outer, const Pose& outer_from_inner) {
  return {outer, inner, world_from_outer, world_from_outer * outer_from_inner, 0.0, 0.0};
}

class Containment : public testing::TestWithParam<ShapeKind> {};

INSTANTIATE_TEST_SUITE_P(NarrowPhase, Containment, testing::ValuesIn(allKinds()),
                         [](const auto& info) { return std::string(name(info.param)); });

TEST_P(Containment, AShapeInsideAClosedMeshIsContained) {
  Random random(5);
  for (const auto& [what, vessel] : vessels()) {
    SCOPED_TRACE(what);
    for (int i = 0; i < 50; ++i) {
      const Case placed = placedIn(meshOf(vessel), randomSolid(random, GetParam(), kSmall), randomPose(random, 5.0),
                                   randomPose(random, 0.3));
      const Trial trial(placed);
      const Proximity answer = trial.measure();
      ASSERT_EQ(unsound(answer), "") << placed.text();
      ASSERT_EQ(answer.status, Measure::contained) << placed.text();
      ASSERT_TRUE(isSameInOtherOrder(placed, answer, trial.measureSwapped())) << placed.text();
    }
  }
}

TEST_P(Containment, AShapeBesideAClosedMeshIsApart) {
  Random random(6);
  for (const auto& [what, vessel] : vessels()) {
    SCOPED_TRACE(what);
    Judge judge;
    for (int i = 0; i < 50; ++i) {
      Pose beside = randomPose(random, 0.3);
      beside.translation()[random.below(3)] += random.chance(0.5) ? 2.5 : -2.5;
      const Case placed =
          placedIn(meshOf(vessel), randomSolid(random, GetParam(), kSmall), randomPose(random, 5.0), beside);
      ASSERT_EQ(Trial(placed).measure().status, Measure::apart) << placed.text();
      judge.look(placed);
    }
    judge.expectAllHeld();
  }
}

// Each mesh lacks one triangle on some side. Then rays and winding numbers give wrong answers for some points.
TEST_P(Containment, AShapeInsideAnOpenMeshIsNeverApart) {
  Random random(7);
  for (const auto& [what, vessel] : vessels()) {
    SCOPED_TRACE(what);
    for (std::size_t hole = 0; hole < vessel.triangles.size(); hole += 1 + vessel.triangles.size() / 30) {
      const Case placed = placedIn(meshOf(without(vessel, hole)), randomSolid(random, GetParam(), kSmall),
                                   randomPose(random, 5.0), randomPose(random, 0.3));
      const Trial trial(placed);
      const Proximity answer = trial.measure();
      ASSERT_EQ(unsound(answer), "") << placed.text();
      ASSERT_TRUE(answer.status == Measure::containment_unknown || answer.status == Measure::contact)
          << name(answer.status) << ": " << placed.text();
      ASSERT_TRUE(isSameInOtherOrder(placed, answer, trial.measureSwapped())) << placed.text();
    }
  }
}

TEST_P(Containment, AShapeFarFromAnOpenMeshIsApart) {
  Random random(8);
  for (const auto& [what, vessel] : vessels()) {
    SCOPED_TRACE(what);
    Judge judge;
    for (std::size_t hole = 0; hole < vessel.triangles.size(); hole += 1 + vessel.triangles.size() / 30) {
      Pose beside = randomPose(random, 0.3);
      beside.translation()[random.below(3)] += random.chance(0.5) ? 4.0 : -4.0;
      const Case placed = placedIn(meshOf(without(vessel, hole)), randomSolid(random, GetParam(), kSmall),
                                   randomPose(random, 5.0), beside);
      ASSERT_EQ(Trial(placed).measure().status, Measure::apart) << placed.text();
      judge.look(placed);
    }
    judge.expectAllHeld();
  }
}

// The triangles of a mesh may also be clockwise, for example after mirroring with a negative scale.
TEST_P(Containment, TheSideThatATriangleFacesDoesNotMatter) {
  Random random(9);
  for (const auto& [what, vessel] : vessels()) {
    SCOPED_TRACE(what);
    TriangleMesh turned = vessel;
    for (auto& triangle : turned.triangles) std::swap(triangle[1], triangle[2]);
    const Shape inner = randomSolid(random, GetParam(), kSmall);
    const Case placed = placedIn(meshOf(turned), inner, randomPose(random, 5.0), randomPose(random, 0.3));
    EXPECT_EQ(Trial(placed).measure().status, Measure::contained) << placed.text();
  }
}

// Some programs write each face for both sides, or turn some faces around. The inside is the same.
TEST_P(Containment, TheDirectionsAndCopiesOfFacesDoNotMatter) {
  Random random(11);
  for (const auto& [what, vessel] : vessels()) {
    for (int i = 0; i < 12; ++i) {
      SCOPED_TRACE(what + ", " + std::to_string(i));
      const Shape outer = meshOf(i == 0 ? twoSided(vessel) : disordered(random, vessel));
      const Shape inner = randomSolid(random, GetParam(), kSmall);
      const Pose world_from_outer = randomPose(random, 5.0);
      const Case placed = placedIn(outer, inner, world_from_outer, randomPose(random, 0.3));
      const Trial trial(placed);
      const Proximity answer = trial.measure();
      ASSERT_EQ(unsound(answer), "") << placed.text();
      ASSERT_EQ(answer.status, Measure::contained) << placed.text();
      ASSERT_TRUE(isSameInOtherOrder(placed, answer, trial.measureSwapped())) << placed.text();
      Pose beside = randomPose(random, 0.3);
      beside.translation()[random.below(3)] += 2.5;
      const Case placed_beside = placedIn(outer, inner, world_from_outer, beside);
      ASSERT_EQ(Trial(placed_beside).measure().status, Measure::apart) << placed_beside.text();
    }
  }
}

// A mesh prepares bounds of distances after some hundreds of measurements without contact.
TEST(TwoSidedFaces, EncloseTheSameAfterManyMeasurements) {
  const Shape outer = meshOf(twoSided(boxMesh({1, 1, 1}))), inner = Shape::sphere(0.05);
  Pose pose = Pose::Identity();
  const Case in_middle{outer, inner, Pose::Identity(), pose, 0.0, 0.0};
  pose.translation() << 0.6, 0.6, 0.0;
  const Case outside{outer, inner, Pose::Identity(), pose, 0.0, 0.0};
  const Trial middle(in_middle), beside(outside);
  for (int i = 0; i < 400; ++i) ASSERT_EQ(beside.measure().status, Measure::apart);
  EXPECT_EQ(middle.measure().status, Measure::contained);
}

/// The center of the sphere is 0.25 m below the surface of the box.
TEST(Surfaces, ThatTouchOrCrossAreInContactWhereverTheCentersAre) {
  const Pose sphere_pose(Eigen::Translation3d(0.25, 0, 0));
  for (const TriangleMesh& box : {boxMesh({1, 1, 1}), unwelded(boxMesh({1, 1, 1}))}) {
    const auto status = [&](double radius, double padding_of_box, double padding_of_sphere) {
      return Trial(
                 {meshOf(box), Shape::sphere(radius), Pose::Identity(), sphere_pose, padding_of_box, padding_of_sphere})
          .measure()
          .status;
    };
    EXPECT_EQ(status(0.1, 0.0, 0.0), Measure::contained);
    EXPECT_EQ(status(0.25, 0.0, 0.0), Measure::contact) << "the surfaces touch";
    EXPECT_EQ(status(0.4, 0.0, 0.0), Measure::contact);
    EXPECT_EQ(status(0.1, 0.0, 0.15), Measure::contact);
    EXPECT_EQ(status(0.4, 0.25, 0.0), Measure::contained) << "the padding of the box moves its surface away";
    EXPECT_EQ(status(0.4, 0.1, 0.0), Measure::contact);
  }
}

// A hollow sphere has an outer and an inner surface. Its cavity counts as outside.
TEST(Cavity, OfAClosedMeshIsOutsideOfIt) {
  TriangleMesh hollow = ballMesh(2);
  const auto count = std::uint32_t(hollow.vertices.size());
  const std::vector<std::array<std::uint32_t, 3>> outside = hollow.triangles;
  for (std::uint32_t i = 0; i < count; ++i) hollow.vertices.push_back(0.5 * hollow.vertices[i]);
  for (const auto& [a, b, c] : outside) hollow.triangles.push_back({a + count, c + count, b + count});
  Pose pose = Pose::Identity();
  const Shape ball = Shape::sphere(0.1);
  EXPECT_EQ(Trial({meshOf(hollow), ball, Pose::Identity(), pose, 0.0, 0.0}).measure().status, Measure::apart);
  pose.translation().x() = 0.72;
  EXPECT_EQ(Trial({meshOf(hollow), ball, Pose::Identity(), pose, 0.0, 0.0}).measure().status, Measure::contained);
}

// Convex shapes are solid. A shape inside a sphere or a box is in contact with it, even if that shape is a mesh.
TEST_P(Containment, AShapeInsideASolidIsInContact) {
  Random random(10);
  const Shape outers[] = {Shape::sphere(1.0),        Shape::box({2, 2, 2}),
                          Shape::cylinder(3.0, 1.0), Shape::cone(5.0, 3.0),
                          Shape::capsule(2.0, 1.0),  Shape::hull(std::make_shared<TriangleMesh>(boxMesh({2, 2, 2})))};
  for (const Shape& outer : outers) {
    for (int i = 0; i < 50; ++i) {
      const Case placed =
          placedIn(outer, randomSolid(random, GetParam(), kSmall), randomPose(random, 5.0), randomPose(random, 0.3));
      const Trial trial(placed);
      const Proximity answer = trial.measure();
      ASSERT_EQ(unsound(answer), "") << placed.text();
      ASSERT_TRUE(answer.status == Measure::contact || answer.status == Measure::contained) << placed.text();
      ASSERT_TRUE(isSameInOtherOrder(placed, answer, trial.measureSwapped())) << placed.text();
    }
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
