// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Several publishers place one frame. The tests check whose transforms the node uses, what it reports, and for how
// long.
#include <gtest/gtest.h>

#include <functional>

#include "test/node/support/simulated_world.h"

namespace hgrid {
namespace test {
namespace {

bool says(const BodyTrouble* trouble, const std::vector<std::string>& words) {
  if (trouble == nullptr) return false;
  for (const std::string& word : words) {
    if (trouble->sentence.find(word) == std::string::npos) return false;
  }
  return true;
}

class Fights : public ::testing::Test {
 protected:
  Fights() : world_({"a", "b"}) {}

  /// Advances the clocks by 20 ms. After 10 ms, sends a transform of the frame a, calls `first` and makes a tick. After
  /// 10 ms more, calls `second` and makes another tick.
  void cycle(const std::function<void()>& first, const std::function<void()>& second = {}) {
    world_.wait(0.01);
    world_.sendNow("/robot", "base", "a", 0.0);
    first();
    world_.tick();
    look_();
    world_.wait(0.01);
    if (second) second();
    world_.tick();
    look_();
  }
  void expectEndOfFightWithin(double duration, const std::function<void()>& send) {
    const double end = world_.now() + duration;
    while (world_.now() < end) cycle(send);
    EXPECT_EQ(world_.trouble("b"), nullptr);
    EXPECT_EQ(world_.pose("b").state, Freshness::fresh);
    EXPECT_TRUE(world_.snapshot().complete());
  }

  SimulatedWorld world_;
  std::function<void()> look_ = [] {};  // the cycle() function calls it after each tick
};

TEST_F(Fights, WhileTwoPublishersDisagreeAboutTheParentNothingReadsAsClear) {
  double x = 5.0;
  const auto lost = [&] { world_.sendNow("/amcl", "island", "b", 0.0); };
  const auto good = [&] { world_.sendNow("/odometry", "base", "b", x); };
  for (int i = 0; i < 20; ++i) cycle(good);
  EXPECT_EQ(world_.sphere(0.2, 0.02), Verdict::clear);
  for (int i = 0; i < 5; ++i) cycle(good, lost);
  int ticks = 0;
  look_ = [&] {
    ++ticks;
    ASSERT_NE(world_.pose("b").state, Freshness::fresh);
    ASSERT_EQ(world_.sphere(0.2, 0.02) == Verdict::clear, false);
    ASSERT_FALSE(world_.snapshot().complete());
    ASSERT_TRUE(says(world_.trouble("b"), {"'b'", "'base'", "'island'", "/amcl", "/odometry"}));
    ASSERT_EQ(world_.trouble("b")->code, Code::conflict);
  };
  x = 0.25;  // b moves next to a
  for (int i = 0; i < 100; ++i) cycle(good, lost);
  EXPECT_EQ(ticks, 200);
  EXPECT_TRUE(world_.near("a", "b")) << "the transforms of the first publisher are used";
  EXPECT_NEAR(world_.x("b"), 0.25, 1e-9);
  EXPECT_GE(world_.counter("tf.fight.CONFLICT"), 100u);
  look_ = [] {};
  expectEndOfFightWithin(3.5, good);
}

TEST_F(Fights, OverAFrameThatComesFirstFromTheUnconnectedParentAreReportedToo) {
  const auto lost = [&] { world_.sendNow("/amcl", "island", "b", 0.0); };
  const auto good = [&] { world_.sendNow("/odometry", "base", "b", 0.25); };
  for (int i = 0; i < 5; ++i) cycle(lost, good);
  look_ = [&] {
    ASSERT_FALSE(world_.snapshot().complete());
    ASSERT_NE(world_.pose("b").state, Freshness::fresh);
  };
  for (int i = 0; i < 100; ++i) cycle(lost, good);
  EXPECT_TRUE(says(world_.trouble("b"), {"'b'", "'base'", "'island'", "/amcl", "/odometry"}));
  look_ = [] {};
  expectEndOfFightWithin(3.5, good);
  EXPECT_NEAR(world_.x("b"), 0.25, 1e-9);
}

TEST_F(Fights, OverThePoseInOneParentNeverGiveAPoseInBetween) {
  const auto left = [&] { world_.sendNow("/left", "base", "b", -4.0); };
  const auto right = [&] { world_.sendNow("/right", "base", "b", 4.0); };
  for (int i = 0; i < 20; ++i) cycle(left);
  for (int i = 0; i < 5; ++i) cycle(left, right);
  look_ = [&] {
    ASSERT_NEAR(std::abs(world_.x("b")), 4.0, 1e-9);
    ASSERT_NE(world_.pose("b").state, Freshness::fresh);
    ASSERT_FALSE(world_.snapshot().complete());
    ASSERT_TRUE(says(world_.trouble("b"), {"'b'", "'base'", "/left", "/right"}));
  };
  for (int i = 0; i < 100; ++i) cycle(left, right);
  look_ = [] {};
  expectEndOfFightWithin(3.5, left);
}

TEST_F(Fights, WithAPublisherWhoseClockIsAheadOrBehindAreReported) {
  for (const double skew : {0.3, -0.3, 0.015}) {
    SCOPED_TRACE(skew);
    SimulatedWorld world({"b"});
    const auto cycle = [&](bool both) {
      world.wait(0.02);
      world.sendNow("/left", "base", "b", -4.0);
      if (both) world.send("/right", "base", "b", 4.0, world.now() + skew);
      world.tick();
    };
    for (int i = 0; i < 20; ++i) cycle(false);
    for (int i = 0; i < 50; ++i) cycle(true);
    for (int i = 0; i < 50; ++i) {
      cycle(true);
      ASSERT_EQ(world.pose("b").state, Freshness::invalid);
      ASSERT_NEAR(world.x("b"), -4.0, 1e-9);
      ASSERT_LT(world.pose("b").age, 0.05);
      ASSERT_TRUE(says(world.trouble("b"), {"/left", "/right"}));
    }
  }
}

TEST_F(Fights, OfASlowPublisherAgainstAFastOneDoNotFlicker) {
  const auto fast = [&] { world_.sendNow("/fast", "base", "b", -4.0); };
  const auto slow = [&] { world_.sendNow("/slow", "base", "b", 4.0); };
  for (int i = 0; i < 20; ++i) cycle(fast);
  cycle(fast, slow);
  cycle(fast);
  look_ = [&] { ASSERT_EQ(world_.pose("b").state, Freshness::invalid); };
  for (int i = 0; i < 500; ++i) {
    cycle(fast, [&, i] {
      if (i % 50 == 0) slow();
    });
  }
}

TEST_F(Fights, AreNoneBetweenPublishersThatAgree) {
  double x = 1.0;
  const auto same = [&](const std::string& publisher) {
    return [&, publisher] { world_.sendNow(publisher, "base", "b", x); };
  };
  look_ = [&] {
    ASSERT_EQ(world_.trouble("b"), nullptr);
    ASSERT_EQ(world_.pose("b").state, Freshness::fresh);
  };
  cycle(same("/one"));
  for (int i = 0; i < 100; ++i) cycle(same("/one"), same("/other"));
  // A relay sends copies of the transforms of /one, sometimes before and sometimes after the original.
  for (int i = 0; i < 100; ++i) {
    x += 0.01;
    const auto one = same("/one"), relay = same("/relay");
    cycle([&, i] {
      (i % 2 == 0 ? one : relay)();
      (i % 2 == 0 ? relay : one)();
    });
    EXPECT_NEAR(world_.x("b"), x, 1e-9);
  }
  EXPECT_EQ(world_.counter("tf.fight.CONFLICT"), 0u);
}

TEST_F(Fights, AreNoneWhenAnotherPublisherTakesOver) {
  for (int i = 0; i < 50; ++i) cycle([&] { world_.sendNow("/camera", "base", "b", 5.0); });
  look_ = [&] {
    ASSERT_LE(world_.pose("b").state, Freshness::late);
    ASSERT_TRUE(world_.snapshot().complete());
    ASSERT_TRUE(world_.x("b") == 5.0 || world_.x("b") == 0.25)
        << "the pose is never between those of the two publishers";
  };
  for (int i = 0; i < 50; ++i) cycle([&] { world_.sendNow("/gripper", "a", "b", 0.25); });
  EXPECT_EQ(world_.pose("b").state, Freshness::fresh);
  EXPECT_TRUE(world_.near("a", "b"));
  EXPECT_EQ(world_.counter("tf.fight.CONFLICT"), 0u);
}

TEST_F(Fights, OfOnePublisherWithItselfAboutTheParentAreReported) {
  const auto base = [&] { world_.sendNow("/relay", "base", "b", 5.0); };
  const auto island = [&] { world_.sendNow("/relay", "island", "b", 0.0); };
  for (int i = 0; i < 5; ++i) cycle(base, island);
  look_ = [&] {
    ASSERT_NE(world_.pose("b").state, Freshness::fresh);
    ASSERT_FALSE(world_.snapshot().complete());
    ASSERT_TRUE(says(world_.trouble("b"), {"'b'", "'base'", "'island'", "/relay"}));
  };
  for (int i = 0; i < 50; ++i) cycle(base, island);
}

TEST_F(Fights, OverAFrameBelowWhichABodyHangsAreItsTroubleToo) {
  world_.fix("/setup", "mount", "b", 0.0);
  const auto left = [&] { world_.sendNow("/left", "base", "mount", -4.0); };
  const auto right = [&] { world_.sendNow("/right", "base", "mount", 4.0); };
  for (int i = 0; i < 10; ++i) cycle(left, right);
  EXPECT_EQ(world_.pose("b").state, Freshness::invalid);
  EXPECT_TRUE(says(world_.trouble("b"), {"'mount'", "/left", "/right"}));
  EXPECT_EQ(world_.trouble("a"), nullptr);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
