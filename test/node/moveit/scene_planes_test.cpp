// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Planes in messages of MoveIt.
#include <utility>

#include "test/node/moveit/scene_messages.h"

namespace hgrid {
namespace test {
namespace {

/// Returns the signed distance [m] of the origin of the world from the plane of a body, and its normal.
std::pair<double, Eigen::Vector3d> planeOf(const Snapshot& snapshot, const std::string& name) {
  const std::uint32_t body = snapshot.structure().find(name);
  const HalfSpace& half_space = snapshot.halfSpaceOf(snapshot.structure().first_proxy[body]);
  return {signedDistance(half_space, -snapshot.origin()), half_space.normal};
}

// Claim: the solid side of a plane is where a x + b y + c z + d is negative, whatever the length of (a, b, c).
TEST_F(SceneWorld, PlanesAreSolidWhereTheirEquationIsNegative) {
  take(scenePlane("floor", {{0.0, 0.0, 2.0, 3.0}}));     // z <= -1.5
  take(scenePlane("ceiling", {{0.0, 0.0, -1.0, 2.5}}));  // z >= 2.5
  take(scenePlane("wall", {{3.0, 0.0, -4.0, -50.0}}));   // 0.6 x - 0.8 z <= 10
  const Snapshot& snapshot = tick();
  const auto [floor, up] = planeOf(snapshot, "obstacle/floor");
  EXPECT_NEAR(floor, 1.5, 1e-12);
  EXPECT_TRUE(up.isApprox(Eigen::Vector3d(0, 0, 1), 1e-12));
  const auto [ceiling, down] = planeOf(snapshot, "obstacle/ceiling");
  EXPECT_NEAR(ceiling, 2.5, 1e-12);
  EXPECT_TRUE(down.isApprox(Eigen::Vector3d(0, 0, -1), 1e-12));
  const auto [wall, out] = planeOf(snapshot, "obstacle/wall");
  EXPECT_NEAR(wall, -10.0, 1e-12);
  EXPECT_TRUE(out.isApprox(Eigen::Vector3d(0.6, 0, -0.8), 1e-12));
  EXPECT_EQ(snapshot.pairs().size(), 2u) << "the links base and hand are inside the wall";
}

TEST_F(SceneWorld, PlanesMoveWithTheirCoefficients) {
  take(scenePlane("floor", {{0.0, 0.0, 1.0, 1.0}}));
  NoeticObject move = scenePlane("floor", {{0.0, 0.0, 1.0, 1.0}});
  move.operation = CollisionObject::MOVE;
  move.plane_poses.resize(1);
  move.plane_poses[0].position.z = 0.5;
  take(move);
  EXPECT_NEAR(planeOf(tick(), "obstacle/floor").first, 0.5, 1e-12);
  move.planes.clear();
  EXPECT_EQ(refusedScene(move), Code::bad_geometry);
  NoeticObject both = sceneSphere(CollisionObject::ADD, "both", 1);
  both.planes = scenePlane("", {{0.0, 0.0, 1.0, 1.0}}).planes;
  EXPECT_EQ(refusedScene(attachedTo("tool", both)), Code::unsupported);
  take(both);
  tick();
  EXPECT_EQ(bodyOf(*tick_->snapshot, "obstacle/both").shapes.size(), 2u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
