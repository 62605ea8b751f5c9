// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/states/mesh_clearance.h"

#include <gtest/gtest.h>

#include "queries/states/robot_shapes.h"
#include "test/queries/states/placed_boxes.h"
#include "test/queries/states/state_worlds.h"

namespace hgrid {
namespace {

using namespace test;

/// Claim: shapes that are said to be farther than the reach are farther, inside a tray as well.
TEST(MeshClearance, ReportsOnlyShapesBeyondTheReach) {
  int farther = 0, nearer = 0, in_box = 0;
  for (unsigned seed = 1; seed <= 15; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const double away = random.chance(0.3) ? 1e4 : 1.0;
    const Eigen::Vector3d size(random.uniform(0.3, 1.0), random.uniform(0.3, 1.0), random.uniform(0.3, 1.0));
    const BodyShape tray = solidShape(meshOf(trayMesh(size, 0.02)), Pose::Identity(), random.uniform(0.0, 0.1));
    ASSERT_TRUE(makeLattice(tray));
    const MeshClearance clearance(tray);
    ASSERT_TRUE(clearance.exists());
    const Pose world_from_tray = randomPose(random, away);
    const Eigen::Vector3d origin = world_from_tray.translation() + randomPose(random, 1.0).translation();
    const auto boxOf = [&origin](const BodyShape& shape, Pose pose) {
      pose.translation() -= origin;
      return tiltedBoxOf(shape, pose, 1e-6);
    };
    const TiltedBox<float> tray_box = boxOf(tray, world_from_tray);
    for (int turn = 0; turn < 40; ++turn) {
      const BodyShape shape = solidShape(randomShape(random, 0.15), Pose::Identity(), random.uniform(0.0, 0.02));
      const SphereCover cover = coverOf(tiltedBoxOf(shape, Pose::Identity(), 1e-6));
      Pose poses[4];
      TiltedBox<float> boxes[4];
      Four reach;
      for (std::size_t lane = 0; lane < 4; ++lane) {
        poses[lane] = world_from_tray * randomPose(random, 0.6);
        boxes[lane] = boxOf(shape, poses[lane]);
        reach[lane] = random.chance(0.5) ? 0.0f : float(random.uniform(0.0, 0.1));
      }
      const unsigned lanes = unsigned(random.between(0, 15));
      const unsigned bits =
          clearance.farther(placed({tray_box, tray_box, tray_box, tray_box}), placed(boxes), cover, reach, lanes);
      EXPECT_EQ(bits & ~lanes, 0u);
      for (std::size_t lane = 0; lane < 4; ++lane) {
        if ((lanes >> lane & 1u) == 0) continue;
        ((bits >> lane & 1u) != 0 ? farther : nearer) += 1;
        if ((bits >> lane & 1u) == 0) continue;
        const Eigen::Vector3d center = world_from_tray.inverse() * poses[lane].translation();
        in_box += (center.cwiseAbs().array() < 0.5 * size.array()).all() ? 1 : 0;
        const Proximity found = narrowPhase()->measure({*shape.solid, poses[lane], shape.padding},
                                                       {*tray.solid, world_from_tray, tray.padding}, 0.2);
        ASSERT_GT(found.distance, double{reach[lane]}) << "lane " << lane;
      }
    }
  }
  EXPECT_GT(farther, 200);
  EXPECT_GT(nearer, 200);
  EXPECT_GT(in_box, 20);
}

/// Claim: a lattice changes no answer about shapes that cannot be measured. They are in contact if their boxes are.
TEST(MeshClearance, IsNotAskedAboutShapesThatCannotBeMeasured) {
  Random random(1);
  WorldPlan plan;
  plan.obstacles = 0;
  plan.map = plan.plane = plan.attached = false;
  plan.closed_meshes = true;
  StateWorld world = randomStateWorld(random, plan);
  int self_pairs = 0;
  for (const bool measured : {true, false}) {
    for (RobotLink& link : world.model.links) {
      if (!measured && &link != &world.model.links.front()) link.shapes.front().solid = nullptr;
    }
    Scene scene{SceneOptions()};
    for (const Body& body : bodiesOf(world.model, "robot", world.matrix)) put(scene, body, Pose::Identity());
    const auto snapshot = scene.commit(Time{2}, {});
    const RobotShapes shapes(*snapshot, world.kinematics(), "robot", {}, QueryScope());
    for (const SelfPair& pair : shapes.selfPairs()) {
      EXPECT_EQ(pair.mesh != Structure::kNone, measured);
      ++self_pairs;
    }
  }
  EXPECT_GT(self_pairs, 4);
}

TEST(MeshClearance, SaysNothingWithoutALattice) {
  const BodyShape box = solidShape(Shape::box({1, 1, 1})), mesh = solidShape(meshOf(trayMesh({1, 1, 1}, 0.1)));
  EXPECT_FALSE(MeshClearance(box).exists());
  const TiltedBox<float> here = tiltedBoxOf(box, Pose::Identity(), 1e-6),
                         far = tiltedBoxOf(box, Pose(Eigen::Translation3d(9, 0, 0)), 1e-6);
  const FourShapes first = placed({here, here, here, here}), second = placed({far, far, far, far});
  const SphereCover cover = coverOf(here);
  EXPECT_EQ(MeshClearance(box).farther(first, second, cover, allFour(0.0f), 15u), 0u);
  EXPECT_EQ(MeshClearance(mesh).farther(first, second, cover, allFour(0.0f), 15u), 0u);
  ASSERT_TRUE(makeLattice(mesh));
  EXPECT_EQ(MeshClearance(mesh).farther(first, second, cover, allFour(0.0f), 15u), 15u);
}

}  // namespace
}  // namespace hgrid
