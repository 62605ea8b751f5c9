// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "narrow/enclosure.h"
#include "test/support/mesh_oracle.h"
#include "test/support/random.h"
#include "test/support/solids.h"

namespace hgrid {
namespace test {
namespace {

/// Expects the winding numbers of the sum over all triangles, inside and around the mesh.
void compare(Random& random, const TriangleMesh& mesh) {
  const WindingTree tree(mesh.vertices, weldedTriangles(mesh));
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector3d point(random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2));
    EXPECT_NEAR(tree.windingNumber(point), bruteForceWindingNumber(mesh, point), 1e-12) << point.transpose();
  }
}

TEST(WindingTree, EqualsTheSumOverAllTriangles) {
  Random random(1);
  for (int divisions = 0; divisions < 4; ++divisions) {
    const TriangleMesh ball = ballMesh(divisions);
    compare(random, ball);
    compare(random, unwelded(ball));
    TriangleMesh holes = ball;  // many holes, some of which share corners
    for (int i = 0; i < 5 * divisions; ++i) {
      holes = without(holes, std::size_t(random.below(int(holes.triangles.size()))));
    }
    compare(random, holes);
  }
}

TEST(WindingTree, CountsSurfacesThatOverlapOrAreInsideOut) {
  Random random(2);
  TriangleMesh mesh = ballMesh(2);
  const auto add = [&](TriangleMesh other, double size, bool turned) {
    const auto first = std::uint32_t(mesh.vertices.size());
    for (const Eigen::Vector3d& vertex : other.vertices) mesh.vertices.push_back(size * vertex);
    for (auto t : other.triangles) {
      if (turned) std::swap(t[0], t[1]);
      mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  };
  add(ballMesh(2), 1.0, false);  // twice the same surface: each edge counts twice
  add(ballMesh(3), 0.7, false);
  add(ballMesh(1), 0.4, true);
  compare(random, mesh);
  const WindingTree tree(mesh.vertices, weldedTriangles(mesh));
  EXPECT_TRUE(tree.closed());
  EXPECT_NEAR(tree.windingNumber({0, 0, 0}), 2.0, 1e-12);
  mesh.triangles.pop_back();
  compare(random, mesh);
  EXPECT_FALSE(WindingTree(mesh.vertices, weldedTriangles(mesh)).closed());
}

TEST(WindingTree, IsZeroForAMeshThatEnclosesNothing) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}};
  EXPECT_EQ(WindingTree(mesh.vertices, weldedTriangles(mesh)).windingNumber({0.5, 0, 0}), 0.0);
  EXPECT_FALSE(Enclosure(mesh).simple());
  EXPECT_FALSE(Enclosure(mesh).boxHolds({0.5, 0, 0}));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
