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

}  // namespace
}  // namespace test
}  // namespace hgrid
