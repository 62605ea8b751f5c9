// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/distance_lattice.h"

#include <gtest/gtest.h>

#include "narrow/mesh_solid.h"
#include "test/support/random.h"
#include "test/support/shapes.h"
#include "test/support/solids.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace {

using namespace test;

/// A closed mesh, with the exact distances of points.
struct TestedMesh {
  explicit TestedMesh(const TriangleMesh& mesh) : prepared(std::make_shared<const TriangleMesh>(mesh)) {
    for (const Triangle& triangle : prepared.tree.triangles()) {
      for (const Eigen::Vector3d& corner : triangle) box.extend(corner);
    }
  }
  bool isInside(const Eigen::Vector3d& point) const { return prepared.enclosure.holds(point) == Inside::yes; }
  /// Returns the distance from the mesh and the space that it encloses.
  double distanceOf(const Eigen::Vector3d& point) const {
    const ConvexSolid solid(ConvexCore::point(), {});
    return isInside(point) ? 0.0 : prepared.tree.gapTo(solid, Pose(Eigen::Translation3d(point)), {0.0, 1e9}).upper;
  }
  Eigen::Vector3d randomPoint(Random& random, double beyond) const {
    const Eigen::Vector3d share = randomVector(random, -beyond, 1.0 + beyond);
    return box.min() + share.cwiseProduct(box.sizes());
  }
  PreparedMesh prepared;
  Eigen::AlignedBox3d box;
};

TriangleMesh randomClosedMesh(Random& random) {
  const Eigen::Vector3d size = randomVector(random, 0.02, 1.0);
  TriangleMesh mesh = random.chance(0.5) ? trayMesh(size, 0.1 * size.minCoeff()) : lumpMesh(random, size);
  const Pose pose = randomPose(random, 2.0);
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = pose * vertex;
  return mesh;
}

TEST(DistanceLattice, GivesLowerBoundsThatAreNotMuchTooLow) {
  int inside = 0, outside = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const TestedMesh mesh(randomClosedMesh(random));
    ASSERT_TRUE(mesh.prepared.enclosure.simple());
    const DistanceLattice lattice(mesh.prepared.tree.triangles());
    double missing = 0.0, points = 0.0;  // [edges] sum of the differences, and number of points
    for (int i = 0; i < 100; ++i) {
      Eigen::Vector3d point[4];
      Four in_edges[3];
      for (int lane = 0; lane < 4; ++lane) {
        point[lane] = mesh.randomPoint(random, i % 3 == 0 ? 2.0 : 0.1);
        const Eigen::Vector3d relative = (point[lane] - lattice.corner()) / lattice.edge();
        for (int k = 0; k < 3; ++k) in_edges[k][lane] = float(relative[k]);
      }
      const Four bounds = lattice.lowerBounds(in_edges);
      for (int lane = 0; lane < 4; ++lane) {
        const double truth = mesh.distanceOf(point[lane]) / lattice.edge();
        ASSERT_LE(bounds[lane], truth + 2e-4) << point[lane].transpose();
        ++(truth > 0.0 ? outside : inside);
        if (truth == 0.0 || truth > 15.0) continue;
        missing += truth - double{bounds[lane]};
        ++points;
      }
    }
    EXPECT_LT(missing, 2.5 * points);
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(outside, 1500);
}

TEST(DistanceLattice, TellsMostPointsOutsideFromThoseInside) {
  int outside = 0, told = 0, inside = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const TestedMesh mesh(randomClosedMesh(random));
    const DistanceLattice lattice(mesh.prepared.tree.triangles());
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector3d point = mesh.randomPoint(random, 0.2);
      const bool is_inside = mesh.isInside(point), is_told = lattice.isOutside(point);
      ASSERT_FALSE(is_inside && is_told) << point.transpose();
      inside += is_inside;
      outside += !is_inside;
      told += is_told;
    }
    EXPECT_FALSE(lattice.isOutside(Eigen::Vector3d::Constant(std::nan(""))));
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(told, 0.8 * outside);
}

/// Claim: no path leads out of the hollow of a closed shell, so no cell there is free, although the mesh does not
/// enclose it.
TEST(DistanceLattice, DoesNotTakeACavityForTheOutside) {
  TriangleMesh mesh = boxMesh({1, 1, 1});
  const TriangleMesh inner = boxMesh({0.8, 0.8, 0.8});
  const auto first = std::uint32_t(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), inner.vertices.begin(), inner.vertices.end());
  for (const auto& t : inner.triangles) mesh.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  const TestedMesh tested(mesh);
  const DistanceLattice lattice(tested.prepared.tree.triangles());
  EXPECT_FALSE(tested.isInside({0, 0, 0}));
  EXPECT_FALSE(lattice.isOutside({0, 0, 0}));
  EXPECT_TRUE(lattice.isOutside({0.6, 0, 0}));
}

/// Claim: the cells of long, thin, tilted triangles are found, and those of meshes that are flat, tiny or far away.
TEST(DistanceLattice, OfStrangeMeshesIsRight) {
  TriangleMesh rod;  // a long prism with many sides along the diagonal
  const std::uint32_t sides = 100;
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Ones());
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 2.0 * M_PI * i / sides;
    for (const double z : {-0.5, 0.5}) {
      rod.vertices.push_back(turn * Eigen::Vector3d(0.05 * std::cos(angle), 0.05 * std::sin(angle), z));
    }
  }
  for (std::uint32_t i = 0; i < 2 * sides; i += 2) {
    const std::uint32_t k = (i + 2) % (2 * sides);
    rod.triangles.push_back({i, k, k + 1});
    rod.triangles.push_back({i, k + 1, i + 1});
    if (i != 0 && k != 0) rod.triangles.push_back({0, k, i});
    if (i != 0 && k != 0) rod.triangles.push_back({1, i + 1, k + 1});
  }
  std::vector<TriangleMesh> meshes = {rod, boxMesh({1, 1, 1e-12}), boxMesh({1e-9, 1e-9, 1e-9}),
                                      boxMesh({1e9, 1, 1e-3})};
  meshes.push_back(moved(boxMesh({1e-9, 1e-9, 1e-9}), {1e5, -1e5, 1e5}));
  meshes.push_back(moved(boxMesh({1, 1, 1}), {1e8, 0, 0}));
  Random random(1);
  for (const TriangleMesh& shape : meshes) {
    const TestedMesh mesh(shape);
    ASSERT_TRUE(mesh.prepared.enclosure.simple());
    const DistanceLattice lattice(mesh.prepared.tree.triangles());
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d point = mesh.randomPoint(random, 0.3);
      EXPECT_FALSE(mesh.isInside(point) && lattice.isOutside(point));
      const Eigen::Vector3d relative = (point - lattice.corner()) / lattice.edge();
      const Four in_edges[3] = {allFour(float(relative[0])), allFour(float(relative[1])), allFour(float(relative[2]))};
      EXPECT_LE(lattice.lowerBounds(in_edges)[0], mesh.distanceOf(point) / lattice.edge() + 2e-4);
    }
  }
  EXPECT_FALSE(DistanceLattice({{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)}})
                   .isOutside({std::nan(""), 0, 1e9}));
}

TEST(DistanceLattice, IsMadeWhenAClosedMeshWasOftenMeasuredInVain) {
  const PreparedMesh closed(std::make_shared<const TriangleMesh>(trayMesh({1, 1, 1}, 0.1)));
  const PreparedMesh open(std::make_shared<const TriangleMesh>(without(ballMesh(1), 1)));
  const PreparedMesh two_sided(std::make_shared<const TriangleMesh>(twoSided(ballMesh(1))));
  TriangleMesh sheet = boxMesh({1, 1, 1});
  sheet.triangles.resize(10);
  const PreparedMesh open_two_sided(std::make_shared<const TriangleMesh>(twoSided(sheet)));
  for (int i = 0; i < 100; ++i) closed.countApart();
  EXPECT_EQ(closed.lattice(), nullptr);
  for (int i = 0; i < 10000; ++i) {
    closed.countApart();
    open.countApart();
    two_sided.countApart();
    open_two_sided.countApart();
  }
  EXPECT_NE(closed.lattice(), nullptr);
  EXPECT_EQ(open.lattice(), nullptr) << "an open mesh encloses no certain space";
  EXPECT_NE(two_sided.lattice(), nullptr);
  EXPECT_EQ(open_two_sided.lattice(), nullptr) << "the answers must not depend on the number of measurements";
}

}  // namespace
}  // namespace hgrid
