// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Which poses and states the bodies get if the world refuses a pose, or if the clock stops.
#include "src/node/world/mover_poses.h"

#include <gtest/gtest.h>

#include "test/node/support/simulated_world.h"
#include "test/support/bodies.h"

namespace hgrid {
namespace test {
namespace {

using Clock = SimulatedWorld::Clock;

/// Returns a robot "twins" with two links in the frame "hand": "near" at its origin, and "far" at x = 5 m.
LoadedRobot twins() {
  LoadedRobot robot;
  robot.name = "twins";
  robot.root_frame = "base";
  robot.groups.push_back({"hand", {}});
  for (const char* name : {"near", "far"}) {
    Body body;
    body.name = std::string("twins/") + name;
    body.frame = "hand";
    body.shapes.push_back(shapeOf(Shape::sphere(0.1)));
    const double x = robot.bodies.empty() ? 0.0 : 5.0;
    robot.groups[0].members.push_back({robot.bodies.size(), Pose(Eigen::Translation3d(x, 0.0, 0.0))});
    robot.bodies.push_back(body);
  }
  return robot;
}

TEST(MoverPoses, IfThePoseOfOneBodyIsRefusedNoBodyOfTheFrameMoves) {
  Params params;
  params.world_limit = 100.0;
  SimulatedWorld world({}, Clock::wall, params);
  world.world().setRobot(std::make_shared<const LoadedRobot>(twins()));
  for (const double x : {1.0, 97.0}) {  // at 97 m, only the body "far" is beyond the limit
    world.wait(0.02);
    world.sendNow("/robot", "base", "hand", x);
    world.tick();
    for (const char* name : {"twins/near", "twins/far"}) {
      const BodyPose& pose = world.snapshot().poses().at(world.snapshot().structure().find(name));
      EXPECT_NEAR(pose.world_from_body.translation().x(), name == std::string("twins/far") ? 6.0 : 1.0, 1e-9);
      EXPECT_EQ(pose.state, x > 2.0 ? Freshness::invalid : Freshness::fresh);
    }
  }
}

TEST(MoverPoses, ARefusedStaticPoseIsReportedInEveryTick) {
  Params params;
  params.world_limit = 100.0;
  SimulatedWorld world({"a"}, Clock::wall, params);
  world.fix("/map", "base", "a", 101.0);
  for (int i = 0; i < 3; ++i) {
    world.wait(0.02);
    world.tick();
    ASSERT_NE(world.trouble("a"), nullptr) << "tick " << i;
    EXPECT_EQ(world.trouble("a")->code, Code::out_of_range);
  }
}

TEST(MoverPoses, AStandingClockFreezesOnlyBodiesThatMove) {
  SimulatedWorld world({"a", "b"}, Clock::simulated);
  world.wait(0.02);
  world.fix("/map", "base", "a", 1.0);
  world.sendNow("/robot", "base", "b", 2.0);
  world.tick();
  world.wait(10.0);
  world.setRosClock(0.02);
  world.fix("/map", "base", "c", 3.0);  // a new static frame, so that the states of all bodies are judged again
  world.tick();
  EXPECT_EQ(world.pose("a").state, Freshness::fresh);
  EXPECT_EQ(world.pose("b").state, Freshness::frozen);
}

TEST(MoverPoses, OnlyBodiesWithPosesOfOneTimeAreOneCohort) {
  SimulatedWorld world({"a", "b", "late"});
  for (int i = 0; i < 10; ++i) {
    world.wait(0.2);
    world.sendNow("/robot", "base", "a", 1.0);
    world.sendNow("/robot", "base", "b", 2.0);
    if (i < 5) world.sendNow("/robot", "base", "late", 3.0);
    world.tick();
  }
  EXPECT_EQ(world.pose("a").cohort, world.pose("b").cohort);
  EXPECT_NE(world.pose("a").cohort, world.pose("late").cohort);
}

/// The growth of the margins reaches the pair only in the second half of each second.
TEST(MoverPoses, ASourceOfOneHertzDoesNotEndItsPairsWithEachPose) {
  Params params;
  params.growth_cap = 1.0;
  params.default_max_speed = 0.8;
  SimulatedWorld world({"slow", "post"}, Clock::wall, params);
  world.fix("/map", "base", "post", 0.8);  // the boxes are 0.6 m apart
  int ticks_without_pair = 0;
  for (int tick = 0; tick < 500; ++tick) {
    if (tick % 50 == 0) world.sendNow("/tracker", "base", "slow", 0.0);
    world.wait(0.02);
    world.tick();
    if (tick < 150) continue;  // the node knows the period
    EXPECT_EQ(world.pose("slow").state, Freshness::fresh);
    ticks_without_pair += world.near("slow", "post") ? 0 : 1;
  }
  EXPECT_EQ(ticks_without_pair, 0);
}

/// robot_state_publisher sends a planar joint on /tf_static, as if it were fixed. So where its link is, is not known.
TEST(MoverPoses, TheStaticPoseOfAFrameThatAPlanarJointMovesPlacesNothing) {
  SimulatedWorld world({"tool", "bolted"});
  LoadedRobot robot = twins();
  robot.free_frames = {"hand"};
  world.world().setRobot(std::make_shared<const LoadedRobot>(robot));
  world.fix("/robot_state_publisher", "base", "hand", 1.0);
  world.fix("/robot_state_publisher", "hand", "tool", 0.5);
  world.fix("/robot_state_publisher", "base", "bolted", 3.0);
  world.wait(0.02);
  world.tick();
  const auto stateOf = [&](const char* body) {
    return world.snapshot().poses().at(world.snapshot().structure().find(body)).state;
  };
  EXPECT_EQ(stateOf("twins/near"), Freshness::unplaced);
  EXPECT_EQ(world.pose("tool").state, Freshness::unplaced) << "an obstacle that follows the frame";
  EXPECT_EQ(world.pose("bolted").state, Freshness::fresh) << "no such joint moves it";
  EXPECT_EQ(world.sphere(-5.0, 0.1), Verdict::unknown);
  ASSERT_EQ(world.last().unplaced.size(), 1u);
  EXPECT_EQ(world.last().unplaced[0].find("UNPLACED robot 'twins': 2 of its 2 links never had a pose: a planar or "
                                          "floating joint moves frame 'hand', but the frame is only on /tf_static"),
            0u);

  for (int i = 0; i < 3; ++i) {
    world.wait(0.02);
    world.sendNow("/odometry", "base", "hand", 2.0);
    world.tick();
  }
  EXPECT_EQ(stateOf("twins/near"), Freshness::fresh) << "odometry tells where it is";
  EXPECT_NEAR(world.x("tool"), 2.5, 1e-9);
  EXPECT_TRUE(world.last().unplaced.empty());
}

/// An obstacle stands at a static frame. Then a robot comes, and one of its planar joints moves this frame.
TEST(MoverPoses, AStaticPoseIsNotUsedAnyMoreOnceARobotSaysThatItsFrameMoves) {
  SimulatedWorld world({"hand"});
  world.fix("/robot_state_publisher", "base", "hand", 1.0);
  world.wait(0.02);
  world.tick();
  EXPECT_EQ(world.pose("hand").state, Freshness::fresh);
  LoadedRobot robot = twins();
  robot.free_frames = {"hand"};
  world.world().setRobot(std::make_shared<const LoadedRobot>(robot));
  world.wait(0.02);
  world.tick();
  EXPECT_EQ(world.pose("hand").state, Freshness::invalid);
  EXPECT_NEAR(world.x("hand"), 1.0, 1e-9) << "the last pose is kept";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
