// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// When the verdict about a state must be unknown instead of clear. See turning_arm.h for the robot.
#include <gtest/gtest.h>

#include "test/queries/states/turning_arm.h"

namespace hgrid {
namespace {

using namespace test;

/// An arm with a ball that it hits after a quarter turn.
class StateDoubts : public ::testing::Test {
 protected:
  StateDoubts() { ball = put(world.scene, ArmWorld::ballBody("ball"), at(0, 0.5)); }
  ArmWorld world;
  BodyId ball;
};

TEST_F(StateDoubts, WithoutDoubtTheStateIsClearOrAHit) {
  EXPECT_EQ(world.verdictAt(0), Verdict::clear);
  EXPECT_EQ(world.reason(), Unknown::no);
  EXPECT_EQ(world.sentence(), "");
  EXPECT_EQ(world.verdictAt(kQuarter), Verdict::hit);
}

TEST_F(StateDoubts, AGapThatCanBeAnywhereMakesClearUnknownButKeepsHits) {
  world.gaps.push_back({"map/hall", "map/hall", "NOT_READY map 'hall': it has not been read yet"});
  EXPECT_EQ(world.verdictAt(0), Verdict::unknown);
  EXPECT_EQ(world.reason(), Unknown::incomplete);
  EXPECT_TRUE(says(world.sentence(), "map 'hall'"));
  EXPECT_EQ(world.verdictAt(kQuarter), Verdict::hit);
  EXPECT_EQ(world.verdictAt(0, {}, {{"map/*"}}), Verdict::clear) << "the map is ignored";
}

TEST_F(StateDoubts, AGapWithinASphereCountsOnlyWhereTheRobotTouchesTheSphere) {
  world.gaps.push_back({"cloud/front", "cloud/front", "NOT_READY", Sphere{{0.9, 0, 0}, 0.31}});
  EXPECT_EQ(world.verdictAt(0), Verdict::unknown);
  EXPECT_EQ(world.verdictAt(-0.9), Verdict::clear);
  world.gaps.back().within = Sphere{{0.9, 0, 0}, 0.29};
  EXPECT_EQ(world.verdictAt(0), Verdict::clear);
  StateRequest request;
  request.clearance = 0.05;
  EXPECT_EQ(world.verdictAt(0, request), Verdict::unknown) << "something unseen may be nearer than the clearance";
}

TEST_F(StateDoubts, ABodyWithoutAPoseCanBeAnywhere) {
  world.scene.add(ArmWorld::ballBody("lost"));
  EXPECT_EQ(world.verdictAt(0), Verdict::unknown);
  EXPECT_TRUE(says(world.sentence(), "UNPLACED obstacle/lost"));
  EXPECT_EQ(world.verdictAt(0, {}, {{"obstacle/lost"}}), Verdict::clear);
}

TEST_F(StateDoubts, AnAttachedObstacleIsInDoubtIfItsStateIsWorseThanThatOfTheLink) {
  Body held = ArmWorld::ballBody("held", 0.05);
  held.frame = "arm";
  held.frame_from_body = at(0.7);
  const BodyId id = put(world.scene, held, at(0.7));
  EXPECT_EQ(world.verdictAt(0), Verdict::clear);
  world.scene.setState(id, Freshness::lost, 5.0);
  EXPECT_EQ(world.verdictAt(0), Verdict::unknown);
  EXPECT_TRUE(says(world.sentence(), "obstacle/held"));
  world.scene.setState(world.links[1], Freshness::lost, 5.0);
  EXPECT_EQ(world.verdictAt(0), Verdict::clear) << "the joint gives the pose of both";
}

TEST_F(StateDoubts, ABodyWithAnUnreadableShapeCanBeAnywhereUnlessItIsWaived) {
  Body body = ArmWorld::ballBody("odd");
  body.covered = false;
  body.note = "its mesh could not be read";
  const BodyId id = put(world.scene, body, at(5));
  EXPECT_EQ(world.verdictAt(0), Verdict::unknown);
  EXPECT_TRUE(says(world.sentence(), "its mesh could not be read"));
  world.scene.remove(id);
  body.waived = true;
  put(world.scene, body, at(5));
  EXPECT_EQ(world.verdictAt(0), Verdict::clear);
}

TEST_F(StateDoubts, AnUnreadableShapeOfTheRobotMakesEachStateUnknown) {
  Body arm = world.scene.body(world.links[1]);
  arm.covered = false;
  arm.note = "its mesh could not be read";
  world.scene.exchange({world.links[1]}, {arm});
  EXPECT_EQ(world.verdictAt(0), Verdict::unknown);
  EXPECT_EQ(world.reason(), Unknown::incomplete);
  EXPECT_TRUE(says(world.sentence(), "UNCOVERED robot/arm"));
}

TEST_F(StateDoubts, ABodyThatMayHaveMovedCountsWhereItMayHaveCome) {
  world.scene.setState(ball, Freshness::stale, 0.28);  // max_speed is 1 m/s, so it may be 0.28 m from its pose
  EXPECT_EQ(world.verdictAt(0), Verdict::clear) << "the arm is 0.51 m away, and the base 0.3 m";
  EXPECT_EQ(world.verdictAt(0.7), Verdict::unknown) << "the arm is 0.22 m away from the ball";
  EXPECT_EQ(world.reason(), Unknown::stale_body);
  EXPECT_TRUE(says(world.sentence(), "obstacle/ball"));
  EXPECT_EQ(world.verdictAt(kQuarter), Verdict::hit);
  StateRequest request;
  request.clearance = 0.4;
  EXPECT_EQ(world.verdictAt(0, request), Verdict::unknown) << "it may be nearer than the clearance";
}

TEST_F(StateDoubts, AFrozenOrInvalidBodyCanBeAnywhere) {
  for (const Freshness state : {Freshness::frozen, Freshness::invalid}) {
    world.scene.setState(ball, state, 0.0);
    EXPECT_EQ(world.verdictAt(0), Verdict::unknown) << name(state);
  }
}

TEST_F(StateDoubts, TheRecordedPosesOfTheLinksDoNotMatter) {
  world.scene.setState(world.links[1], Freshness::lost, 60.0);
  EXPECT_EQ(world.verdictAt(0), Verdict::clear);
  world.gaps.push_back({"robot", "robot/arm", "UNPLACED robot/arm"});
  EXPECT_EQ(world.verdictAt(0), Verdict::clear);
}

TEST_F(StateDoubts, AnOldPoseOfTheBaseCountsUnlessTheBatchGivesThePose) {
  world.scene.setState(world.links[0], Freshness::stale, 0.5);
  EXPECT_EQ(world.verdictAt(0), Verdict::unknown);
  EXPECT_TRUE(says(world.sentence(), "robot/base"));
  EXPECT_EQ(world.verdictAt(kQuarter), Verdict::hit);
  world.batch.world_from_root = Pose::Identity();
  EXPECT_EQ(world.verdictAt(0), Verdict::clear);
}

TEST_F(StateDoubts, ABodyThatIsSwitchedOffWithTheWholeRobotIsNoReason) {
  world.scene.add(ArmWorld::ballBody("lost"));
  PairRule rule;
  rule.first = "robot/*";
  rule.second = "obstacle/lost";
  world.scene.setRules({rule});
  EXPECT_EQ(world.verdictAt(0), Verdict::clear);
  rule.first = "robot/arm";
  world.scene.setRules({rule});
  EXPECT_EQ(world.verdictAt(0), Verdict::unknown) << "it may still touch the base";
}

TEST_F(StateDoubts, APassedDeadlineLeavesTheStatesUnknown) {
  StateRequest request;
  request.deadline = std::chrono::steady_clock::now() - std::chrono::seconds(1);
  EXPECT_EQ(world.verdictAt(kQuarter, request), Verdict::unknown);
  EXPECT_EQ(world.reason(), Unknown::budget);
  EXPECT_TRUE(says(world.sentence(), "deadline"));
  request.deadline = std::chrono::steady_clock::now() + std::chrono::hours(1);
  EXPECT_EQ(world.verdictAt(kQuarter, request), Verdict::hit);
}

TEST(StateUnmapped, AStateIsClearOnlyWhereAMapKnowsTheSpaceToBeFree) {
  SceneOptions options;
  options.report_unmapped = true;
  ArmWorld world(options);
  EXPECT_EQ(world.verdictAt(0), Verdict::unknown) << "there is no map";
  EXPECT_EQ(world.reason(), Unknown::unmapped);
  const BodyId map = put(world.scene, mapBody("hall"), Pose::Identity());
  const std::vector<Voxel> occupied{{40000, 40000, 40000, 0}};
  // The map knows the space from -1 m to 1 m, except for one cell of 0.1 m near (0.45, -0.45).
  const Voxel unknown{static_cast<std::uint16_t>(Voxel::kOriginKey + 4),
                      static_cast<std::uint16_t>(Voxel::kOriginKey - 5), Voxel::kOriginKey, 0};
  const auto unmapped = std::make_shared<const UnmappedSpace>(UnmappedSpace{
      StaticGrid(0.1, {unknown}), Eigen::AlignedBox3d(Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(1))});
  world.scene.setCells(map, makeMapCells(std::make_shared<StaticGrid>(0.1, occupied), *narrowPhase(), unmapped));
  EXPECT_EQ(world.verdictAt(0), Verdict::clear);
  EXPECT_EQ(world.verdictAt(-0.7), Verdict::unknown) << "the arm is in the unknown cell";
  world.batch.world_from_root = at(0.5);
  EXPECT_EQ(world.verdictAt(0), Verdict::unknown) << "the arm is outside the map";
}

TEST(StateUnmapped, AMapThatMayHaveMovedCountsWhereItsCellsMayHaveCome) {
  ArmWorld world;
  Body body = mapBody("hall", Mobility::moving);
  const BodyId map = put(world.scene, body, Pose::Identity());
  const Voxel cell{static_cast<std::uint16_t>(Voxel::kOriginKey + 9), Voxel::kOriginKey, Voxel::kOriginKey, 0};
  world.scene.setCells(map, makeMapCells(std::make_shared<StaticGrid>(0.1, std::vector<Voxel>{cell}), *narrowPhase()));
  EXPECT_EQ(world.verdictAt(0), Verdict::clear);
  world.scene.setState(map, Freshness::stale, 0.5);
  EXPECT_EQ(world.verdictAt(0), Verdict::unknown);
  EXPECT_EQ(world.verdictAt(2), Verdict::clear);
}

}  // namespace
}  // namespace hgrid
