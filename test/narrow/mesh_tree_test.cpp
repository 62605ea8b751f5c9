// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares the search in the tree of a mesh with the distances of all pairs of triangles in extended precision.
#include "narrow/mesh_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "test/support/mesh_oracle.h"
#include "test/support/shapes.h"
#include "test/support/solids.h"

namespace hgrid {
namespace test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kAccuracy = 1e-9;  // [m], and relative to the distance

/// Returns a mesh whose triangles are long, short, thin or flat, or share no corners. Some have no area.
TriangleMesh randomMesh(Random& random) {
  TriangleMesh mesh = random.chance(0.3) ? lumpMesh(random, {1.0, random.uniform(0.1, 1.0), random.uniform(0.01, 1.0)})
                                         : TriangleMesh();
  for (int count = random.between(mesh.triangles.empty() ? 1 : 0, 30); count > 0; --count) {
    const auto first = std::uint32_t(mesh.vertices.size());
    const Eigen::Vector3d corner = 0.5 * Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), 0.0);
    for (int i = 0; i < 3; ++i) {
      const double size = random.logUniform(1e-6, 1.0);
      mesh.vertices.push_back(corner + size * Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1),
                                                              random.chance(0.3) ? 0.0 : random.uniform(-1, 1)));
    }
    if (random.chance(0.1)) mesh.vertices.back() = mesh.vertices[first];
    if (random.chance(0.1)) mesh.vertices.back() = 0.5 * (mesh.vertices[first] + mesh.vertices[first + 1]);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// Returns a triangle that may be a needle or nearly a segment. Many triangles share corners, edges or planes.
Triangle randomTriangle(Random& random) {
  Triangle triangle;
  for (Eigen::Vector3d& corner : triangle) {
    for (int i = 0; i < 3; ++i) corner[i] = random.chance(0.4) ? random.between(-1, 1) : random.uniform(-1, 1);
  }
  if (random.chance(0.4)) triangle[2] = triangle[random.below(2)];
  if (random.chance(0.2)) triangle[2] = 0.5 * (triangle[0] + triangle[1]);
  const double off = random.logUniform(1e-16, 1e-1);
  for (int i = 0; i < 3; ++i) triangle[2][i] += off * random.uniform(-1, 1);
  return triangle;
}

Triangle3r precise(const Triangle& t) { return {t[0].cast<Real>(), t[1].cast<Real>(), t[2].cast<Real>()}; }

/// Expects that both orders of two meshes give the distance of the brute force.
/// @returns that distance
double compare(const TriangleMesh& first, const TriangleMesh& second, const Pose& first_from_second) {
  const double expected = bruteForceDistance(first, second, first_from_second);
  const MeshTree a(first), b(second);
  const CoreGap gap = a.gapTo(b, first_from_second, {0.0, kInfinity}),
                swapped = b.gapTo(a, first_from_second.inverse(), {0.0, kInfinity});
  a.makeHulls();
  b.makeHulls();
  const CoreGap with_hulls = a.gapTo(b, first_from_second, {0.0, kInfinity});
  EXPECT_EQ(with_hulls.upper, gap.upper);
  EXPECT_EQ(with_hulls.lower, gap.lower);
  for (const CoreGap& found : {gap, swapped}) {
    EXPECT_NEAR(found.upper, expected, kAccuracy * (1.0 + expected));
    EXPECT_TRUE(found.upper - found.lower <= kAccuracy || found.lower == 0.0);
    EXPECT_NEAR((found.on_first - found.on_second).norm(), found.upper, kAccuracy);
    if (expected > kAccuracy) {
      EXPECT_GT(found.lower, 0.0);
    } else {
      EXPECT_LE(found.lower, kAccuracy);
    }
  }
  return expected;
}

TEST(TriangleGap, IsTheDistanceOfTwoTriangles) {
  Random random(7);
  int meet = 0;
  for (int i = 0; i < 5000; ++i) {
    SCOPED_TRACE("seed 7, case " + std::to_string(i));
    const Triangle first = randomTriangle(random), second = randomTriangle(random);
    const auto expected = double(triangleDistance(precise(first), precise(second)));
    const CoreGap gap = gapOfTriangles(first, second, 4.0, {0.0, kInfinity});
    ASSERT_NEAR(gap.upper, expected, kAccuracy);
    ASSERT_NEAR(gapOfTriangles(second, first, 4.0, {0.0, kInfinity}).upper, expected, kAccuracy);
    ASSERT_LE((gap.on_first - gap.on_second).norm(), gap.upper + kAccuracy);
    if (expected == 0.0) {
      ++meet;
      continue;
    }
    ASSERT_EQ(gapOfTriangles(first, second, 4.0, {0.0, 1.01 * expected + kAccuracy}).upper, gap.upper);
    const CoreGap enough = gapOfTriangles(first, second, 4.0, {0.0, 0.99 * expected});
    ASSERT_TRUE(enough.upper == kInfinity || std::abs(enough.upper - expected) <= kAccuracy);
  }
  EXPECT_GT(meet, 300);
}

TEST(MeshTree, FindsTheDistanceOfAllPairsOfTriangles) {
  Random random(1);
  int apart = 0, meet = 0;
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE("seed 1, case " + std::to_string(i));
    const TriangleMesh first = randomMesh(random), second = randomMesh(random);
    const double distance = compare(first, second, randomPose(random, random.logUniform(0.1, 5.0)));
    (distance > kAccuracy ? apart : meet) += 1;
  }
  EXPECT_GT(apart, 100);
  EXPECT_GT(meet, 30);
}

// Meshes of many levels, near each other and one inside the other.
TEST(MeshTree, FindsTheDistanceOfLargeMeshes) {
  Random random(2);
  const TriangleMesh ball = ballMesh(2);
  for (const double size : {0.3, 0.99, 1.7}) {
    SCOPED_TRACE(size);
    TriangleMesh other = ballMesh(2);
    for (Eigen::Vector3d& vertex : other.vertices) vertex *= size;
    compare(ball, other, Pose::Identity());
    compare(ball, other, randomPose(random, 4.0));
  }
}

// The meshes of two boxes: face on face, edge on edge, corner on corner, corner on face, and the same a little apart.
TEST(MeshTree, FindsTheDistanceOfMeshesThatTouch) {
  const TriangleMesh box = boxMesh({1, 1, 1});
  for (const double apart : {0.0, 1e-12, 1e-9, 1e-6, 1e-3}) {
    for (const Eigen::Vector3d& way : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(1, 1, 1),
                                       Eigen::Vector3d(1, 0.3, 0.2), Eigen::Vector3d(1, 1, 0.3)}) {
      SCOPED_TRACE(apart);
      Pose pose = Pose::Identity();
      pose.translation() = way;
      pose.translation().x() += apart;
      EXPECT_NEAR(compare(box, box, pose), apart, 1e-15);
      pose.linear() = Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitX()).toRotationMatrix();
      compare(box, box, pose);
    }
  }
}

TEST(MeshTree, FindsTheDistanceOfMeshesWithTheSameCenter) {
  EXPECT_NEAR(compare(boxMesh({1, 1, 1}), boxMesh({0.5, 0.5, 0.5}), Pose::Identity()), 0.25, 1e-15);
  const TriangleMesh triangle{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  EXPECT_EQ(compare(triangle, triangle, Pose::Identity()), 0.0);
}

TEST(MeshTree, IsExactFarFromTheOriginOfTheMesh) {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    SCOPED_TRACE("seed 3, case " + std::to_string(i));
    const Eigen::Vector3d far = 1e3 * Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), 1.0);
    Pose pose = randomPose(random, 2.0);
    pose.translation() += far;
    compare(moved(randomMesh(random), far), randomMesh(random), pose);
  }
}

TEST(MeshTree, ReturnsNothingBeyondTheLimitAndTheSameBelowIt) {
  Random random(4);
  int beyond = 0;
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE("seed 4, case " + std::to_string(i));
    const MeshTree a(randomMesh(random)), b(randomMesh(random));
    const Pose pose = randomPose(random, 2.0);
    const CoreGap gap = a.gapTo(b, pose, {0.0, kInfinity});
    if (i % 2 == 0) a.makeHulls();
    if (i % 4 == 0) b.makeHulls();
    if (gap.lower <= 0.0) continue;  // contact is never beyond the limit
    for (const double limit : {0.0, 0.5 * gap.upper, (1.0 - 1e-9) * gap.upper}) {
      EXPECT_EQ(a.gapTo(b, pose, {0.0, limit}).upper, kInfinity);
      ++beyond;
    }
    EXPECT_EQ(a.gapTo(b, pose, {0.0, (1.0 + 1e-9) * gap.upper + 1e-12}).upper, gap.upper);
  }
  EXPECT_GT(beyond, 100);
}

TEST(MeshTree, FindsTheDistanceToAConvexCore) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE("seed 5, case " + std::to_string(i));
    const TriangleMesh mesh = randomMesh(random);
    const std::array<Eigen::Vector3d, 3> corners{Eigen::Vector3d(random.uniform(-1, 1), 0.7, -0.2),
                                                 Eigen::Vector3d(0.3, 0.2, 0.5),
                                                 Eigen::Vector3d(random.uniform(-1, 1), 0.1, 0.4)};
    const Pose pose = randomPose(random, 2.0);
    const CoreGap gap =
        MeshTree(mesh).gapTo(ConvexSolid(ConvexCore::hull(corners.data(), 3), {}), pose, {0.0, kInfinity});
    const double expected = bruteForceDistance(mesh, {{corners[0], corners[1], corners[2]}, {{0, 1, 2}}}, pose);
    EXPECT_NEAR(gap.upper, expected, 2e-9);
  }
}

TEST(MeshTree, MeetsEachPairOfTrianglesWithinReachOnce) {
  Random random(6);
  std::size_t most = 0;
  for (int i = 0; i < 30; ++i) {
    SCOPED_TRACE("seed 6, case " + std::to_string(i));
    const TriangleMesh first = randomMesh(random), second = randomMesh(random);
    const Pose pose = randomPose(random, 0.7);
    const double reach = random.logUniform(1e-3, 0.3);
    std::size_t expected = 0, found = 0;
    for (const auto& t : first.triangles) {
      for (const auto& u : second.triangles) {
        expected += bruteForceDistance({first.vertices, {t}}, {second.vertices, {u}}, pose) <= reach;
      }
    }
    const MeshTree a(first), b(second);
    a.meetings(b, pose, {0.0, reach}, [&](const CoreGap& gap) {
      EXPECT_LE(gap.lower, reach);
      ++found;
      return true;
    });
    EXPECT_EQ(found, expected);
    std::size_t calls = 0;
    a.meetings(b, pose, {0.0, reach}, [&](const CoreGap&) { return ++calls < 2; });
    EXPECT_EQ(calls, std::min<std::size_t>(expected, 2));
    most = std::max(most, expected);
  }
  EXPECT_GT(most, 10u);
}

TEST(MeshTree, SupportIsAFarthestCorner) {
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    TriangleMesh mesh = randomMesh(random);
    const double away = random.chance(0.3) ? 1000.0 : 1.0;
    const Eigen::Vector3d shift(random.uniform(-away, away), random.uniform(-away, away), random.uniform(-away, away));
    for (Eigen::Vector3d& vertex : mesh.vertices) vertex += shift;
    const MeshTree tree(mesh);
    for (int k = 0; k < 10; ++k) {
      const Eigen::Vector3d direction(random.uniform(-1, 1), random.uniform(-1, 1),
                                      k == 0 ? 0.0 : random.uniform(-1, 1));
      double most = -kInfinity;
      for (const auto& t : mesh.triangles) {
        for (const std::uint32_t corner : t) most = std::max(most, direction.dot(mesh.vertices[corner] - shift));
      }
      ASSERT_NEAR(direction.dot(tree.support(direction) - shift), most, 1e-12 * away);
    }
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
