// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/tf/frame_rivals.h"

#include <gtest/gtest.h>

#include "test/node/support/moments.h"

namespace hgrid {
namespace test {
namespace {

/// The publisher "/a" holds frame 3, whose name is "tool". The frame is in "hand" at x = 0 m. "/a" has sent transforms
/// with stamps from 8 s to 10 s.
class FrameRivalsTest : public ::testing::Test {
 protected:
  FrameRivals::Holder holder() const {
    return {name_, {"/a", "hand"}, s(10), [](Time time) {
              return time < s(8) ? std::nullopt : std::optional<FramePose>(FramePose{});
            }};
  }
  static FrameClaims::RivalTransform rival(double stamp, double x, const std::string& parent = "hand",
                                           const std::string& publisher = "/b") {
    FrameClaims::RivalTransform transform{{publisher, parent}, s(stamp), {}};
    transform.parent_from_frame.translation.x() = x;
    return transform;
  }
  bool contested() const { return rivals_.claims().isContested(3, kReading); }

  static constexpr Time kReading{1000000000};
  const std::string name_ = "tool";
  Ledger ledger_;
  FrameRivals rivals_{ledger_};
};

TEST_F(FrameRivalsTest, AgreeIfTheirPosesAreNearlyTheSame) {
  rivals_.take(3, holder(), rival(9, 0.009), kReading);
  EXPECT_FALSE(contested());
  rivals_.take(3, holder(), rival(9, 0.011), kReading);
  EXPECT_TRUE(contested());
}

TEST_F(FrameRivalsTest, ContradictIfTheirRotationsDiffer) {
  FrameClaims::RivalTransform turned = rival(9, 0.0);
  turned.parent_from_frame.rotation = Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitZ());
  rivals_.take(3, holder(), turned, kReading);
  EXPECT_TRUE(contested());
}

TEST_F(FrameRivalsTest, ContradictIfTheirParentsDiffer) {
  rivals_.take(3, holder(), rival(9, 0.0, "island"), kReading);
  EXPECT_TRUE(contested());
}

TEST_F(FrameRivalsTest, AreNotComparedBeforeTheHolderHasCaughtUp) {
  rivals_.take(3, holder(), rival(11, 5.0), kReading);
  EXPECT_FALSE(contested());
  EXPECT_FALSE(rivals_.takeWaiting(3, s(10.9)));
  const auto waiting = rivals_.takeWaiting(3, s(11));
  ASSERT_TRUE(waiting);
  rivals_.compare(3, holder(), *waiting, kReading);
  EXPECT_TRUE(contested());
}

TEST_F(FrameRivalsTest, AreNotComparedWithATimeThatTheHolderDoesNotKnow) {
  rivals_.take(3, holder(), rival(7, 5.0), kReading);
  EXPECT_FALSE(contested());
}

TEST_F(FrameRivalsTest, AreNoRivalsOnceTheyHoldTheFrame) {
  rivals_.compare(3, holder(), rival(9, 5.0, "hand", "/a"), kReading);
  EXPECT_FALSE(contested());
}

TEST_F(FrameRivalsTest, ContradictIfTheyTakeTurns) {
  rivals_.change(3, holder(), {"/b", "hand"}, kReading);
  EXPECT_FALSE(contested()) << "the frame may be handed over";
  FrameRivals::Holder other = holder();
  other.claim.publisher = "/b";
  rivals_.change(3, other, {"/a", "hand"}, kReading);
  EXPECT_TRUE(contested());
  EXPECT_EQ(ledger_.counters().at("tf.fight.CONFLICT"), 1u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
