// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests distances of meshes that are known, and contacts of meshes. Each pair of convex parts that touch is one
// contact.
#include <gtest/gtest.h>

#include "hgrid_proximity/geometry/oriented_box.h"
#include "test/narrow/narrow_phase_judge.h"

namespace hgrid {
namespace test {
namespace {

constexpr std::size_t kAll = 1000000;

std::vector<Contact> contactsOf(const Case& placed, std::size_t most = kAll, bool exchanged = false) {
  const auto first = narrowPhase().solidOf(placed.first_shape), second = narrowPhase().solidOf(placed.second_shape);
  const PlacedSolid a{*first, placed.world_from_first, placed.first_padding};
  const PlacedSolid b{*second, placed.world_from_second, placed.second_padding};
  return exchanged ? narrowPhase().contacts(b, a, most) : narrowPhase().contacts(a, b, most);
}

/// Returns the convex parts of a shape: the triangles of a mesh, or else the shape itself.
std::vector<Shape> partsOf(const Shape& shape) {
  if (shape.kind() != ShapeKind::mesh) return {shape};
  std::vector<Shape> parts;
  for (const auto& corners : shape.mesh()->triangles) {
    const auto& vertices = shape.mesh()->vertices;
    parts.push_back(Shape::hull(std::make_shared<TriangleMesh>(
        TriangleMesh{{vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]}, {}})));
  }
  return parts;
}

/// Returns the number of pairs of parts that certainly touch, and the number that touch within a rounding error.
std::pair<std::size_t, std::size_t> partsThatMeet(const Case& placed) {
  std::pair<std::size_t, std::size_t> count{0, 0};
  for (const Shape& a : partsOf(placed.first_shape)) {
    for (const Shape& b : partsOf(placed.second_shape)) {
      const auto meet = [&](double padding) {
        return distanceOf(SolidOracle(a, placed.world_from_first, placed.first_padding + padding),
                          SolidOracle(b, placed.world_from_second, placed.second_padding))
                   .interval.upper <= 0.0;
      };
      count.first += meet(0.0);
      count.second += meet(2e-9);
    }
  }
  return count;
}

std::vector<KindPair> pairsWithMeshes() {
  std::vector<KindPair> pairs;
  for (const KindPair& kinds : allKindPairs()) {
    if (kinds.first == ShapeKind::mesh || kinds.second == ShapeKind::mesh) pairs.push_back(kinds);
  }
  return pairs;
}

class ContactsOfMeshes : public testing::TestWithParam<KindPair> {};

INSTANTIATE_TEST_SUITE_P(NarrowPhase, ContactsOfMeshes, testing::ValuesIn(pairsWithMeshes()),
                         [](const auto& info) { return nameOf(info.param); });

TEST_P(ContactsOfMeshes, AreOneForEachTwoPartsThatMeet) {
  Cases cases(42, GetParam());
  int compared = 0;
  for (int i = 0; i < 10; ++i) {
    const Case placed = cases.next();
    const auto [surely, maybe] = partsThatMeet(placed);
    if (surely == 0) continue;  // the surfaces do not touch
    ++compared;
    const std::size_t found = contactsOf(placed).size();
    EXPECT_GE(found, surely) << placed.text();
    EXPECT_LE(found, maybe) << placed.text();
    EXPECT_EQ(contactsOf(placed, 1).size(), 1u);
    EXPECT_EQ(contactsOf(placed, found).size(), found);
    EXPECT_TRUE(contactsOf(placed, 0).empty());
  }
  EXPECT_GT(compared, 0);
}

TEST(NarrowPhaseKnown, SphereOverAMesh) {
  Case placed{Shape::sphere(0.1), meshOf(boxMesh({1, 1, 1})), Pose::Identity(), Pose::Identity(), 0.0, 0.0};
  placed.world_from_second.translation() << 0.1, 0.2, -2.0;
  EXPECT_NEAR(Trial(placed).measure().distance, 1.4, 1e-6);
  Judge judge;
  judge.look(placed);
  judge.expectAllHeld();
}

TEST(NarrowPhaseContacts, OfASphereInAFloorOfTwoTriangles) {
  const Shape floor = meshOf({{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}});
  Case placed{floor, Shape::sphere(0.1), Pose::Identity(), Pose::Identity(), 0.0, 0.01};
  placed.world_from_second.translation() << 0.5, -0.5, 0.08;  // the sphere is above only one triangle
  std::vector<Contact> contacts = contactsOf(placed);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].depth, 0.03, 1e-9);
  EXPECT_TRUE(contacts[0].normal.isApprox(Eigen::Vector3d::UnitZ(), 1e-9));
  EXPECT_TRUE(contacts[0].point.isApprox(Eigen::Vector3d(0.5, -0.5, 0.0), 1e-9)) << contacts[0].point.transpose();
  placed.world_from_second.translation() << 0.5, 0.5 - 1e-3, 0.08;  // almost above their common side
  contacts = contactsOf(placed);
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_GT(contacts[0].depth, contacts[1].depth);
}

TEST(NarrowPhaseContacts, OfAShapeInsideAMeshIsAPointOfTheShape) {
  Case placed{meshOf(boxMesh({1, 1, 1})), Shape::box({0.1, 0.1, 0.1}), Pose::Identity(), Pose::Identity(), 0.0, 0.0};
  placed.world_from_first.translation() << 5, 0, 0;
  placed.world_from_second.translation() << 5.2, 0, 0;
  for (const bool exchanged : {false, true}) {
    const std::vector<Contact> contacts = contactsOf(placed, kAll, exchanged);
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_LE(distanceOf(placed.second(), contacts[0].point).lower, 1e-9);
    EXPECT_TRUE(contacts[0].normal.hasNaN());
    EXPECT_TRUE(std::isnan(contacts[0].depth));
  }
}

Contact contactOf(const Case& placed) {
  const auto first = narrowPhase().solidOf(placed.first_shape), second = narrowPhase().solidOf(placed.second_shape);
  return narrowPhase().measureContact({*first, placed.world_from_first, placed.first_padding},
                                      {*second, placed.world_from_second, placed.second_padding});
}

// The least depth of two boxes is known. That of boxes as meshes is a bound of it, which is not much larger.
TEST(NarrowPhaseContact, OfBoxesHasTheDepthOfTheBoxesAndOfTheirMeshesHasABoundOfIt) {
  Random random(1);
  const Eigen::Vector3d size(0.3, 0.4, 0.5), other_size(0.2, 0.9, 0.4);
  int contacts = 0;
  double worst = 0.0;
  for (int i = 0; i < 200; ++i) {
    Case placed{Shape::box(size), Shape::box(other_size), randomPose(random, 0.3), randomPose(random, 0.3), 0.0, 0.0};
    if (!isContact(Trial(placed).measure().status)) continue;
    ++contacts;
    const double exact =
        penetrationDepth(OrientedBox{placed.world_from_first, size}, OrientedBox{placed.world_from_second, other_size});
    ASSERT_NEAR(contactOf(placed).depth, exact, 1e-6) << placed.text();
    placed.first_shape = meshOf(boxMesh(size));
    if (i % 2 == 0) placed.second_shape = meshOf(boxMesh(other_size));
    const double bound = contactOf(placed).depth;
    ASSERT_GE(bound, exact - 1e-6) << placed.text();
    worst = std::max(worst, bound - exact);
  }
  EXPECT_LT(worst, 0.05);
  EXPECT_GT(contacts, 50);
}

TEST(NarrowPhaseContact, OfAShapeInsideAMeshIsAPointOfTheShapeAndTheWayOut) {
  Case placed{meshOf(boxMesh({1, 1, 1})), Shape::box({0.1, 0.1, 0.1}), Pose::Identity(), Pose::Identity(), 0.0, 0.0};
  placed.world_from_first.translation() << 5, 0, 0;
  placed.world_from_second.translation() << 5.2, 0, 0;
  const Contact contact = contactOf(placed);
  EXPECT_LE(distanceOf(placed.second(), contact.point).upper, 1e-9);
  EXPECT_NEAR(contact.depth, 0.5 - 0.2 + 0.05, 1e-6);
  EXPECT_TRUE(contact.normal.isApprox(Eigen::Vector3d::UnitX(), 1e-6)) << contact.normal.transpose();
}

// The extents of a box between two walls overlap with those of the walls in all directions, but the padding of the
// box touches only one wall.
TEST(NarrowPhaseContact, OfAPaddingThatTouchesAWallIsTheMoveAwayFromThisWall) {
  const TriangleMesh wall = boxMesh({0.1, 1, 1});
  TriangleMesh walls;
  for (const double x : {-0.5, 0.5}) {
    const auto begin = static_cast<std::uint32_t>(walls.vertices.size());
    for (const Eigen::Vector3d& vertex : wall.vertices) walls.vertices.push_back(vertex + x * Eigen::Vector3d::UnitX());
    for (const auto& t : wall.triangles) walls.triangles.push_back({begin + t[0], begin + t[1], begin + t[2]});
  }
  Case placed{meshOf(walls), meshOf(boxMesh({0.1, 0.1, 0.1})), Pose::Identity(), Pose::Identity(), 0.01, 0.03};
  placed.world_from_second.translation() << 0.375, 0, 0;
  const Contact contact = contactOf(placed);
  EXPECT_NEAR(contact.depth, 0.015, 1e-6);
  EXPECT_TRUE(contact.normal.isApprox(-Eigen::Vector3d::UnitX(), 1e-6)) << contact.normal.transpose();
}

}  // namespace
}  // namespace test
}  // namespace hgrid
