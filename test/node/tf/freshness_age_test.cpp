// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Claim: the age of a body is the age of the pose that the node uses for it. Other transforms do not change the age.
#include <gtest/gtest.h>

#include "test/node/support/simulated_world.h"

namespace hgrid {
namespace test {
namespace {

using Clock = SimulatedWorld::Clock;

class Ages : public ::testing::TestWithParam<Clock> {};
INSTANTIATE_TEST_SUITE_P(BothClocks, Ages, ::testing::Values(Clock::wall, Clock::simulated),
                         [](const ::testing::TestParamInfo<Clock>& info) {
                           return info.param == Clock::wall ? "Wall" : "Simulated";
                         });

TEST_P(Ages, APoseTakenAtAnOlderTimeThanItsNewestTransformHasTheAgeOfThatTime) {
  for (const double delay : {0.08, 0.15}) {
    SCOPED_TRACE(delay);
    Params params;
    params.max_sync_wait = 0.2;
    SimulatedWorld world({"a", "b"}, GetParam(), params);
    for (int i = 0; i < 50; ++i) {
      world.wait(0.02);
      world.sendNow("/fast", "base", "a", 0.0);
      world.send("/slow", "base", "b", 5.0, world.now() - delay);  // the tick uses the newest time for which it knows b
      world.tick();
    }
    for (const char* frame : {"a", "b"}) {
      EXPECT_NEAR(world.stamp(frame), world.now() - delay, 1e-6);
      EXPECT_NEAR(world.pose(frame).age, delay, 1e-6);
      EXPECT_EQ(world.pose(frame).state, delay > 0.1 ? Freshness::late : Freshness::fresh);
    }
    EXPECT_NEAR(world.snapshot().maxAge(), delay, 1e-6);
  }
}

TEST_P(Ages, APoseThatTheNewestTransformsDoNotGiveKeepsItsStampAndAges) {
  Params params;
  params.lost_after = 1.0;
  SimulatedWorld world({"a", "b"}, GetParam(), params);
  const auto step = [&](const std::string& parent, double x) {
    world.wait(0.02);
    world.sendNow("/robot", "base", "a", 0.0);
    world.sendNow("/robot", parent, "b", x);
    world.tick();
  };
  for (int i = 0; i < 10; ++i) step("base", 5.0);
  const double stamp = world.now();
  EXPECT_NEAR(world.stamp("b"), stamp, 1e-6);
  EXPECT_EQ(world.pose("b").state, Freshness::fresh);
  Freshness worst = Freshness::fresh;
  for (int i = 0; i < 100; ++i) {
    step("island", 0.0);  // transforms keep arriving, but b is not connected to the world frame
    const BodyPose& pose = world.pose("b");
    ASSERT_NEAR(world.stamp("b"), stamp, 1e-6);
    ASSERT_NEAR(pose.age, world.now() - stamp, 1e-6);
    ASSERT_GE(pose.state, worst);
    worst = pose.state;
    const double age = world.now() - stamp;
    if (age > 0.101) {
      ASSERT_GE(pose.state, Freshness::late);
    }
    if (age > 0.251) {
      ASSERT_GE(pose.state, Freshness::stale);
      ASSERT_GT(pose.growth, 0.0);
    }
    if (age > 1.001) {
      ASSERT_EQ(pose.state, Freshness::lost);
      ASSERT_FALSE(world.snapshot().complete());
    }
    ASSERT_NEAR(world.x("b"), 5.0, 1e-9);
  }
  EXPECT_EQ(worst, Freshness::lost);
}

TEST_P(Ages, WhatWasPlacedByStaticTransformsAgesFromTheMomentTheyStopPlacingIt) {
  SimulatedWorld world({"a"}, GetParam());
  world.fix("/setup", "base", "mount", 0.0);
  world.fix("/setup", "mount", "a", 1.0);
  for (int i = 0; i < 500; ++i) {
    world.wait(0.02);
    world.tick();
  }
  EXPECT_EQ(world.pose("a").state, Freshness::fresh);
  EXPECT_EQ(world.pose("a").age, 0.0);
  world.fix("/setup", "island", "mount", 0.0);
  for (int i = 0; i < 10; ++i) {
    world.wait(0.02);
    world.tick();
    EXPECT_NEAR(world.pose("a").age, 0.02 * (i + 1), 1e-6) << "the pose ages only since the static chain was broken";
  }
  EXPECT_EQ(world.pose("a").state, Freshness::late);
}

TEST_P(Ages, LateStaleAndLostBeginAtOneAndAHalfPeriodsOfASlowFrameButReachDoesNot) {
  Params params;
  params.lost_after = 1.0;
  SimulatedWorld world({"a"}, GetParam(), params);
  for (int i = 0; i < 60; ++i) {  // sends one transform per second
    world.wait(1.0);
    world.sendNow("/slow", "base", "a", 0.0);
    world.tick();
  }
  for (const double age : {0.2, 0.4, 0.9, 1.4}) {
    world.wait(age - world.pose("a").age);
    world.tick();
    EXPECT_NEAR(world.pose("a").age, age, 1e-6);
    EXPECT_EQ(world.pose("a").state, Freshness::fresh) << age;
    EXPECT_NEAR(world.pose("a").reach, age > 0.25 ? 2.0 * age : 0.0, 1e-6) << age;
    EXPECT_EQ(world.pose("a").growth, 1.0) << "the margins are always as wide as before the next pose, up to the cap";
    EXPECT_EQ(world.snapshot().complete(), 2.0 * age <= 1.0) << "beyond ~growth_cap, pairs may be missing";
  }
  world.wait(0.2);
  world.tick();
  EXPECT_EQ(world.pose("a").state, Freshness::lost);
  EXPECT_FALSE(world.snapshot().complete());
}

TEST_P(Ages, AFastFrameThatStopsIsLostEvenIfASlowFrameCarriesIt) {
  SimulatedWorld world({"a"}, GetParam());
  for (int i = 0; i <= 1000; ++i) {
    world.wait(0.02);
    if (i % 250 == 0) world.sendNow("/slow", "base", "cart", 0.0);  // every 5 s
    world.sendNow("/fast", "cart", "a", 0.0);
    world.tick();
  }
  for (int i = 0; i < 21; ++i) {
    world.wait(0.1);
    world.tick();
  }
  EXPECT_EQ(world.pose("a").state, Freshness::lost) << "age " << world.pose("a").age;
}

TEST_P(Ages, AnOutageDoesNotCountAsThePeriodOfAFrame) {
  SimulatedWorld world({"a"}, GetParam());
  const auto stream = [&](int count) {
    for (int i = 0; i < count; ++i) {
      world.wait(0.02);
      world.sendNow("/robot", "base", "a", 0.0);
      world.tick();
    }
  };
  stream(20);
  for (int outage = 0; outage < 3; ++outage) {
    for (int i = 0; i < 25; ++i) {  // an outage of 5 s; the steps are too short to count as jumps of the clock
      world.wait(0.2);
      world.tick();
    }
    stream(3);
  }
  world.wait(0.15);
  world.tick();
  EXPECT_EQ(world.pose("a").state, Freshness::late);
  world.wait(0.15);
  world.tick();
  EXPECT_EQ(world.pose("a").state, Freshness::stale);
}

TEST(AgesByTheSteadyClock, SettingTheWallClockDoesNotChangeTheAgeOfAPose) {
  for (const double shift : {3600.0, -3600.0, 5.0, -5.0}) {
    SCOPED_TRACE(shift);
    SimulatedWorld world({"a"});
    for (int i = 0; i < 10; ++i) {
      world.wait(0.02);
      world.sendNow("/robot", "base", "a", 1.0);
      world.tick();
    }
    world.setRosClock(world.now() + shift);
    for (int i = 1; i <= 20; ++i) {
      world.wait(0.02);
      world.tick();
      ASSERT_NEAR(world.pose("a").age, 0.02 * i, 1e-6);
    }
    EXPECT_EQ(world.pose("a").state, Freshness::stale);
    world.sendNow("/robot", "base", "a", 2.0);
    world.tick();
    EXPECT_NEAR(world.pose("a").age, 0.0, 1e-6);
    EXPECT_EQ(world.x("a"), 2.0);
  }
}

TEST(AgesByTheSteadyClock, AfterTheWallClockWasSetTheKeptPoseHasAStampOfTheNewClock) {
  SimulatedWorld world({"a"});
  for (int i = 0; i < 10; ++i) {
    world.wait(0.02);
    world.sendNow("/robot", "base", "a", 1.0);
    world.tick();
  }
  world.setRosClock(world.now() - 3600.0);
  world.wait(0.02);
  world.tick();
  EXPECT_NEAR(world.stamp("a"), world.now() - 0.02, 1e-6);
}

TEST(AgesBySimulatedTime, AStandingClockAgesPosesByTheSteadyClock) {
  SimulatedWorld world({"a"}, Clock::simulated);
  for (int i = 0; i < 10; ++i) {
    world.wait(0.02);
    world.sendNow("/robot", "base", "a", 1.0);
    world.tick();
  }
  const double paused = world.now();
  double before = 0.0;
  for (int i = 1; i <= 100; ++i) {
    world.wait(0.02);
    world.setRosClock(paused);
    world.tick();
    ASSERT_GE(world.pose("a").age, before);
    before = world.pose("a").age;
  }
  EXPECT_EQ(world.pose("a").state, Freshness::frozen);
  EXPECT_NEAR(before, 2.0, 0.05);
}

TEST(AgesBySimulatedTime, AJumpBackMakesNoPoseYounger) {
  SimulatedWorld world({"a"}, Clock::simulated);
  for (int i = 0; i < 100; ++i) {
    world.wait(0.02);
    if (i < 50) world.sendNow("/robot", "base", "a", 1.0);
    world.tick();
  }
  EXPECT_NEAR(world.pose("a").age, 1.0, 1e-6);
  world.setRosClock(0.5);
  for (int i = 0; i < 50; ++i) {
    world.wait(0.02);
    world.tick();
    ASSERT_GE(world.pose("a").age, 1.0 + 0.02 * i - 1e-6);
    ASSERT_EQ(world.pose("a").state, Freshness::frozen);
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
