// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/states/map_clearance.h"

#include <gtest/gtest.h>

#include "test/queries/states/placed_boxes.h"
#include "test/queries/states/state_worlds.h"

namespace hgrid {
namespace {

using namespace test;

/// Returns a random point of a box, often on a face, an edge or a corner.
Eigen::Vector3d randomPointOf(const TiltedBox<float>& box, Random& random) {
  Eigen::Vector3d point(box.center[0], box.center[1], box.center[2]);
  for (int axis = 0; axis < 3; ++axis) {
    const double at = random.chance(0.5) ? (random.chance(0.5) ? 1.0 : -1.0) : random.uniform(-1.0, 1.0);
    for (Eigen::Index k = 0; k < 3; ++k) point[k] += at * double{box.half[axis]} * double{box.axes[axis][k]};
  }
  return point;
}

TEST(SphereCover, SpheresContainTheBox) {
  Random random(1);
  std::set<std::uint32_t> counts;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d size(random.uniform(0.001, 1.0), random.uniform(0.001, 0.3), random.uniform(0.001, 0.1));
    const BodyShape shape = shapeOf(Shape::box(random.chance(0.3) ? Eigen::Vector3d::Constant(size[0]) : size));
    const TiltedBox<float> box = tiltedBoxOf(shape, randomPose(random, 1.0), 1e-6);
    const SphereCover cover = coverOf(box);
    counts.insert(cover.count[0] * cover.count[1]);
    EXPECT_LE(cover.count[0] * cover.count[1], 24u);
    EXPECT_LE(cover.radius, cover.whole * (1.0f + 1e-5f));
    for (int k = 0; k < 100; ++k) {
      const Eigen::Vector3d point = randomPointOf(box, random);
      double nearest = 1e9, from_center = 0.0;
      for (std::uint32_t a = 0; a < cover.count[0]; ++a) {
        for (std::uint32_t b = 0; b < cover.count[1]; ++b) {
          Eigen::Vector3d center(box.center[0], box.center[1], box.center[2]);
          from_center = (point - center).norm();
          for (Eigen::Index row = 0; row < 3; ++row) {
            center[row] += (a - 0.5 * (cover.count[0] - 1)) * cover.step[0] * double{box.axes[cover.axis[0]][row]};
            center[row] += (b - 0.5 * (cover.count[1] - 1)) * cover.step[1] * double{box.axes[cover.axis[1]][row]};
          }
          nearest = std::min(nearest, (point - center).norm());
        }
      }
      ASSERT_LE(nearest, cover.radius + 1e-6);
      ASSERT_LE(from_center, cover.whole + 1e-6);
    }
  }
  EXPECT_GT(counts.size(), 8u);
}

TEST(SphereCover, CoversASphereWithOneSphere) {
  const BodyShape shape = solidShape(Shape::sphere(0.2), Pose::Identity(), 0.05);
  const SphereCover cover = coverOf(tiltedBoxOf(shape, Pose::Identity(), 1e-6));
  EXPECT_EQ(cover.count[0] * cover.count[1], 1u);
  EXPECT_NEAR(cover.whole, 0.25, 1e-5);
  EXPECT_GE(cover.whole, 0.25);
}

TEST(MapClearance, ReportsOnlyShapesBeyondTheReach) {
  int farther = 0, nearer = 0, covered = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const double edge = random.uniform(0.02, 0.1), away = random.chance(0.3) ? 1e4 : 1.0;
    const auto cells = makeMapCells(std::make_shared<StaticGrid>(edge, randomVoxels(random, 30, 24)), *narrowPhase());
    const Pose world_from_map = randomPose(random, away);
    const PlacedMap map{0, *cells, world_from_map, world_from_map.inverse(), 0.0};
    const Eigen::Vector3d origin = world_from_map.translation() + randomPose(random, 1.0).translation();
    const MapClearance clearance(map, origin);
    for (int turn = 0; turn < 40; ++turn) {
      const BodyShape shape = solidShape(randomShape(random, 0.3), Pose::Identity(), random.uniform(0.0, 0.02));
      const SphereCover cover = coverOf(tiltedBoxOf(shape, Pose::Identity(), 1e-6));
      Pose poses[4];
      TiltedBox<float> boxes[4];
      Four reach;
      for (std::size_t lane = 0; lane < 4; ++lane) {
        poses[lane] = world_from_map * randomPose(random, 24.0 * edge);
        Pose local = poses[lane];
        local.translation() -= origin;
        boxes[lane] = tiltedBoxOf(shape, local, 1e-6);
        reach[lane] = random.chance(0.5) ? 0.0f : float(random.uniform(0.0, 0.2));
      }
      const unsigned lanes = unsigned(random.between(0, 15));
      const unsigned bits = clearance.farther(placed(boxes), cover, reach, lanes);
      EXPECT_EQ(bits & ~lanes, 0u);
      for (std::size_t lane = 0; lane < 4; ++lane) {
        if ((lanes >> lane & 1u) == 0) continue;
        ((bits >> lane & 1u) != 0 ? farther : nearer) += 1;
        if ((bits >> lane & 1u) == 0) continue;
        covered += cover.count[0] * cover.count[1] > 1 ? 1 : 0;
        for (const Voxel& voxel : cells->grid->voxels()) {
          const Proximity found =
              narrowPhase()->measure({*shape.solid, poses[lane], shape.padding},
                                     {*cells->cubes[voxel.level], map.worldFromCube(voxel), 0.0}, 0.3);
          ASSERT_GT(found.distance, double{reach[lane]}) << "lane " << lane;
        }
      }
    }
  }
  EXPECT_GT(farther, 500);
  EXPECT_GT(nearer, 500);
  EXPECT_GT(covered, 200);
}

}  // namespace
}  // namespace hgrid
