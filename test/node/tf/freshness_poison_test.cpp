// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Claim: a single wrong message or a wrong stamp makes a frame unusable only for a short time.
#include <gtest/gtest.h>

#include <limits>

#include "test/node/support/simulated_world.h"

namespace hgrid {
namespace test {
namespace {

class Poison : public ::testing::Test {
 protected:
  Poison() : world_({"a", "b"}) {}

  /// Sends transforms of the frame a at 50 Hz for `duration` [s]. Makes a tick after each transform.
  void stream(double duration, double x = 1.0) {
    const double end = world_.now() + duration - 1e-9;
    while (world_.now() < end) {
      world_.wait(0.02);
      world_.sendNow("/robot", "base", "a", x);
      world_.tick();
    }
  }
  void idle(double duration) {
    const double end = world_.now() + duration - 1e-9;
    while (world_.now() < end) {
      world_.wait(0.02);
      world_.tick();
    }
  }
  void expectFollowed(const std::string& frame, double x) {
    EXPECT_EQ(world_.pose(frame).state, Freshness::fresh);
    EXPECT_NEAR(world_.x(frame), x, 1e-9);
  }

  SimulatedWorld world_;
};

TEST_F(Poison, AStaticTransformStampedInTheFutureDoesNotEndAMovingFrame) {
  stream(0.5, 1.0);
  world_.fix("/mistake", "base", "a", 7.0, 1e9);
  stream(0.5, 2.0);
  expectFollowed("a", 2.0);
  ASSERT_NE(world_.trouble("a"), nullptr) << "the use of both topics is reported";
  EXPECT_EQ(world_.trouble("a")->code, Code::conflict);
}

TEST_F(Poison, AStaticTransformStampedInTheFutureIsAsGoodAsAnyOther) {
  for (const double stamp : {1e9, -900.0}) {
    world_.fix("/setup", "base", "a", stamp > 0 ? 3.0 : 4.0, stamp);
    idle(0.1);
    expectFollowed("a", stamp > 0 ? 3.0 : 4.0);
  }
}

TEST(Flood, OfOtherFramesKeepsOutNoFrameThatABodyFollows) {
  Params params;
  params.max_frames = 20;
  SimulatedWorld world({"a"}, SimulatedWorld::Clock::wall, params);
  world.tick();  // from now on, the world knows which frames it needs
  for (int round = 0; round < 5; ++round) {
    world.wait(0.02);
    for (int i = 0; i < 100; ++i) world.sendNow("/flood", "flood" + std::to_string(i), "f" + std::to_string(i), 0.0);
    world.sendNow("/robot", "base", "cart", 1.0);
    world.sendNow("/robot", "cart", "a", 2.0);
    world.tick();
  }
  EXPECT_GT(world.counter("tf.refused.LIMIT"), 0u);
  EXPECT_EQ(world.pose("a").state, Freshness::fresh);
  EXPECT_NEAR(world.x("a"), 3.0, 1e-9);
}

TEST(Flood, DoesNotLoseStaticTransformsThatABodyNeedsLater) {
  Params params;
  params.max_frames = 20;
  SimulatedWorld world({"a"}, SimulatedWorld::Clock::wall, params);  // no tick yet: nobody needs a frame
  for (int i = 0; i < 20; ++i) world.fix("/flood", "flood", "f" + std::to_string(i), 0.0);
  world.fix("/robot", "base", "cart", 1.0);
  world.fix("/robot", "cart", "lift", 1.0);
  world.fix("/robot", "lift", "a", 1.0);
  EXPECT_EQ(world.counter("tf.refused.LIMIT"), 3u);
  world.tick();
  EXPECT_EQ(world.pose("a").state, Freshness::fresh);
  EXPECT_NEAR(world.x("a"), 3.0, 1e-9);
}

TEST_F(Poison, OneTransformOnTfDoesNotEndAStaticFrame) {
  world_.fix("/setup", "base", "a", 3.0);
  idle(0.1);
  world_.sendNow("/mistake", "base", "a", 7.0);
  idle(5.0);
  expectFollowed("a", 3.0);
}

TEST_F(Poison, AFrameThatMovedIsStaticAgainWhenItsStaticTransformIsSentAgain) {
  world_.fix("/setup", "base", "a", 3.0);
  idle(0.1);
  stream(0.5, 5.0);
  expectFollowed("a", 5.0);
  idle(5.0);
  EXPECT_EQ(world_.pose("a").state, Freshness::lost) << "it keeps its last pose of /tf, which is too old";
  EXPECT_NEAR(world_.x("a"), 5.0, 1e-9);
  world_.fix("/setup", "base", "a", 3.0);
  idle(0.1);
  expectFollowed("a", 3.0);
}

TEST_F(Poison, OneBadTransformOnTfDoesNotInvalidateAStaticFrame) {
  world_.fix("/setup", "base", "a", 3.0);
  idle(0.1);
  world_.sendNow("/mistake", "base", "a", std::numeric_limits<double>::quiet_NaN());
  idle(0.1);
  expectFollowed("a", 3.0);
}

TEST_F(Poison, AnotherPublishersStampsFromTheFutureDoNotSilenceAFrame) {
  stream(0.5, 1.0);
  for (int i = 0; i < 200; ++i) {
    world_.wait(0.02);
    if (i % 10 == 0) world_.send("/ahead", "base", "a", 7.0, world_.now() + 0.45);
    world_.sendNow("/robot", "base", "a", 2.0);
    world_.tick();
    ASSERT_NE(world_.x("a"), 7.0);
    ASSERT_LT(world_.pose("a").age, 0.1) << i;
  }
  EXPECT_NEAR(world_.x("a"), 2.0, 1e-9);
  stream(3.5, 2.0);
  expectFollowed("a", 2.0);
}

TEST_F(Poison, AStampAheadOfTheClockCountsOnlyUntilTheNextTransform) {
  Params params;
  params.max_future = 3600.0;
  SimulatedWorld world({"a"}, SimulatedWorld::Clock::wall, params);
  for (int i = 0; i < 200; ++i) {
    world.wait(0.02);
    world.send("/robot", "base", "a", 1.0, world.now() + (i == 100 ? 3000.0 : 0.0));
    world.tick();
  }
  EXPECT_EQ(world.pose("a").state, Freshness::fresh);
  EXPECT_LT(world.pose("a").age, 0.05);
}

TEST_F(Poison, AStampOfZeroIsRefusedAndNamed) {
  world_.send("/mistake", "base", "a", 7.0, -SimulatedWorld::kStart);  // relative to the start; the stamp itself is 0
  idle(0.1);
  EXPECT_EQ(world_.pose("a").state, Freshness::unplaced);
  EXPECT_EQ(world_.counter("tf.refused.CLOCK"), 1u);
  stream(0.5, 1.0);
  expectFollowed("a", 1.0);
  world_.send("/mistake", "base", "a", 7.0, -SimulatedWorld::kStart);
  EXPECT_EQ(world_.counter("tf.refused.CLOCK"), 2u);
  stream(0.1, 1.0);
  expectFollowed("a", 1.0);
}

TEST_F(Poison, AFrameStampedAheadOfTheClockDoesNotMakeTheOthersLate) {
  for (int i = 0; i < 100; ++i) {
    world_.wait(0.02);
    world_.sendNow("/robot", "base", "a", 1.0);
    world_.send("/postdating", "base", "b", 5.0, world_.now() + 0.45);
    world_.tick();
  }
  expectFollowed("a", 1.0);
  expectFollowed("b", 5.0);
}

TEST_F(Poison, AFrameThatWasStaticBeforeItMovedIsTakenAtTheTimeOfTheTick) {
  world_.fix("/setup", "base", "a", 3.0);
  idle(0.1);
  for (int i = 0; i < 100; ++i) {  // a moves at 1 m/s; b lags by 50 ms, and the tick waits for b
    world_.wait(0.02);
    world_.sendNow("/robot", "base", "a", world_.now());
    world_.send("/slow", "base", "b", 5.0, world_.now() - 0.05);
    world_.tick();
  }
  EXPECT_NEAR(world_.x("a"), world_.stamp("a"), 1e-6) << "at 1 m/s, its x [m] equals the stamp of its pose [s]";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
