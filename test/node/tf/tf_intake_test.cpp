// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Which transforms the node uses if those of a frame are late, early, invalid, or of several publishers.
#include "src/node/tf/tf_intake.h"

#include <gtest/gtest.h>

#include <limits>

#include "test/node/support/moments.h"
#include "test/node/support/transform_views.h"

namespace hgrid {
namespace test {
namespace {

/// A transform at x [m] in the frame "base", unless a test changes it.
struct Sent {
  std::string publisher = "/robot", parent = "base";
  double x = 0.0;
  bool is_static = false;
};

/// Takes in transforms of one frame, "arm".
class TfIntakeTest : public ::testing::Test {
 protected:
  /// Takes in a transform. @param stamp [s] its stamp. @param now [s] current time; negative: that of the stamp
  void send(double stamp, const Sent& sent = {}, double now = -1.0) {
    tf2_msgs::TFMessage message;
    add(message, stamp, sent);
    const double time = now < 0.0 ? stamp : now;
    intake_.take(viewsOf(message), sent.is_static, sent.publisher, moment(100.0 + time, time));
  }
  static void add(tf2_msgs::TFMessage& message, double stamp, const Sent& sent) {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = sent.parent;
    transform.header.stamp = ros::Time(100.0 + stamp);
    transform.child_frame_id = "arm";
    transform.transform.translation.x = sent.x;
    transform.transform.rotation.w = 1.0;
    message.transforms.push_back(transform);
  }
  /// Publishes "arm" every 20 ms up to a time [s].
  void stream(double end, const Sent& sent = {}) {
    for (int i = 0; 0.02 * i < end + 0.01; ++i) send(0.02 * i, sent);
  }
  std::uint32_t number() const { return intake_.table().find("arm"); }
  const TfIntake::Frame& frame() const { return intake_.frame(number()); }
  const std::string& parent() const { return intake_.table().parentName(number()); }
  bool isKnown(double time) const { return intake_.lookup().isKnown("base", "arm", s(100.0 + time)); }

  static constexpr double kCache = 10.0;
  Ledger ledger_;
  TfIntake intake_{20.0, kCache, 100, false, ledger_};
};

TEST_F(TfIntakeTest, OnlyThePublisherOfAStaticFrameCanMakeItInvalid) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  send(1.0, {"/map", "base", 0.0, true});
  send(1.1, {"/stranger", "base", nan, true});
  send(1.2, {"/map", "base", nan, false});
  EXPECT_FALSE(frame().refused);
  send(1.3, {"/map", "base", nan, true});
  EXPECT_TRUE(frame().refused);
  send(1.4, {"/map", "base", 0.0, true});
  EXPECT_FALSE(frame().refused);
}

TEST_F(TfIntakeTest, NoPoseIsKnownWithinAnOutageThatIsLongerThanTheCache) {
  for (const double pause : {kCache, kCache + 0.1}) {
    send(1.0);
    send(1.0 + pause, {}, 2.0);  // stamped ahead of the clock, so that the cache still holds the sample before it
    EXPECT_TRUE(isKnown(1.0));
    EXPECT_EQ(isKnown(5.0), pause <= kCache);
    intake_.forgetMoving();
  }
}

TEST_F(TfIntakeTest, AnotherPublisherHasAPeriodOfItsOwn) {
  stream(1.0);
  EXPECT_NEAR(frame().pace.period(), 0.02, 1e-6);
  send(6.0, {"/other"});
  EXPECT_EQ(*frame().publisher, "/other");
  EXPECT_EQ(frame().pace.period(), 0.0) << "one transform has no period";
  send(6.5, {"/other"});
  send(7.0, {"/other"});
  EXPECT_NEAR(frame().pace.period(), 0.5, 1e-6);
}

TEST_F(TfIntakeTest, TheHolderOfAContestedFrameKeepsItForThreeSeconds) {
  for (const bool contested : {false, true}) {
    stream(1.0);
    if (contested) send(1.0, {"/rival", "island"});
    EXPECT_EQ(intake_.isContested(number(), s(1.0)), contested);
    send(2.0, {"/rival", "island"});
    EXPECT_EQ(*frame().publisher, contested ? "/robot" : "/rival");
    intake_.forgetMoving();
  }
}

TEST_F(TfIntakeTest, ALateTransformMakesNoFrameFresher) {
  stream(1.0);
  const Time received = frame().pace.received();
  send(0.51, {}, 1.5);
  EXPECT_EQ(frame().pace.received(), received);
  send(1.52, {}, 1.6);
  EXPECT_EQ(frame().pace.received(), s(1.6));
}

TEST_F(TfIntakeTest, AStaticFrameMovesOnlyAfterTwoSuccessiveTransforms) {
  send(1.0, {"/robot", "base", 0.0, true});
  send(1.1);
  EXPECT_FALSE(intake_.history(number()).moves()) << "one stray transform";
  send(6.0);
  EXPECT_FALSE(intake_.history(number()).moves()) << "the stray transform before it was too long ago";
  send(6.0, {}, 6.1);
  EXPECT_FALSE(intake_.history(number()).moves()) << "the same stamp again";
  send(6.2);
  EXPECT_TRUE(intake_.history(number()).moves());
}

TEST_F(TfIntakeTest, AStampThatIsSentTwiceWithTwoParentsIsAConflict) {
  stream(1.0);
  send(1.0, {"/robot", "base", 0.5});
  EXPECT_FALSE(intake_.isContested(number(), s(1.0))) << "the first pose is kept";
  send(1.0, {"/robot", "island"});
  EXPECT_EQ(parent(), "base");
  EXPECT_TRUE(intake_.isContested(number(), s(1.0)));
}

// The frames of several transforms are found together, before the first of them is taken in.
TEST_F(TfIntakeTest, AMessageMayMoveAFrameToAnotherParentAndBack) {
  send(1.0);
  tf2_msgs::TFMessage message;
  constexpr int kTransforms = 50;
  const auto parent_of = [](int i) { return i / 3 % 2 == 0 ? "base" : "island"; };
  for (int i = 0; i < kTransforms; ++i) add(message, 1.1 + 0.1 * i, {"/robot", parent_of(i), 0.1 * i});
  intake_.take(viewsOf(message), false, "/robot", moment(107.0, 7.0));
  ASSERT_EQ(intake_.history(number()).newest().stamp, s(101.1 + 0.1 * (kTransforms - 1)));
  for (int i = 0; i < kTransforms; ++i) {
    const auto sample = intake_.history(number()).sampleAt(s(101.1 + 0.1 * i));
    ASSERT_TRUE(sample) << i;
    EXPECT_EQ(intake_.table().name(sample->parent), parent_of(i)) << i;
    EXPECT_NEAR(sample->parent_from_frame.translation.x(), 0.1 * i, 1e-12) << i;
  }
}

TEST_F(TfIntakeTest, KnowsWhyTheNewestTransformWasRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  stream(1.0);
  EXPECT_EQ(intake_.refusal(number()), nullptr);
  send(1.1, {"/robot", "base", nan});
  ASSERT_NE(intake_.refusal(number()), nullptr);
  EXPECT_EQ(intake_.refusal(number())->code(), Code::nonfinite);
  send(0.0, {"/robot", "base", 1e10}, 1.2);
  ASSERT_NE(intake_.refusal(number()), nullptr);
  EXPECT_EQ(intake_.refusal(number())->code(), Code::out_of_range);
  send(1.3);
  EXPECT_EQ(intake_.refusal(number()), nullptr);
  send(1.4, {"/robot", "base", nan});
  ASSERT_NE(intake_.refusal(number()), nullptr);
  EXPECT_EQ(intake_.refusal(number())->code(), Code::nonfinite);
  intake_.forgetMoving();
  EXPECT_EQ(intake_.refusal(number()), nullptr);
}

TEST_F(TfIntakeTest, AMessageMayHaveNewFramesAndRefusedOnesBetweenKnownOnes) {
  const auto message_at = [&](double stamp, int frames, int refused) {
    tf2_msgs::TFMessage message;
    for (int i = 0; i < frames; ++i) {
      add(message, stamp, {"/robot", i == 0 ? "base" : "frame_" + std::to_string(i - 1), 1.0 * i});
      message.transforms.back().child_frame_id = "frame_" + std::to_string(i);
    }
    if (refused >= 0) message.transforms[static_cast<std::size_t>(refused)].transform.rotation.w = 0.0;
    return message;
  };
  for (const int frames : {15, 16, 17, 33, 100}) {
    SCOPED_TRACE(std::to_string(frames) + " frames");
    TfIntake intake(20.0, kCache, 200, false, ledger_);
    const auto take = [&](double stamp, int count, int refused) {
      const tf2_msgs::TFMessage message = message_at(stamp, count, refused);
      intake.take(viewsOf(message), false, "/robot", moment(100.0 + stamp, stamp));
    };
    const int known = frames / 2, refused = frames / 3;
    take(1.0, known, -1);
    take(1.1, frames, refused);
    for (int i = 0; i < frames; ++i) {
      const std::uint32_t number = intake.table().find("frame_" + std::to_string(i));
      ASSERT_NE(number, TfIntake::kNone);
      const PoseSample& newest = intake.history(number).newest();
      EXPECT_EQ(newest.stamp, s(i == refused ? 101.0 : 101.1)) << i;
      EXPECT_EQ(newest.parent_from_frame.translation.x(), 1.0 * i) << i;
      EXPECT_EQ(intake.table().name(newest.parent), i == 0 ? "base" : "frame_" + std::to_string(i - 1));
      EXPECT_EQ(intake.refusal(number) != nullptr, i == refused) << i;
    }
  }
}

TEST_F(TfIntakeTest, TwoPublishersWithLongNamesAreTwoPublishers) {
  const std::string robot(30, 'r'), rival = robot + "2";
  send(1.0, {robot});
  send(1.01, {rival, "base", 0.5});
  EXPECT_EQ(*frame().publisher, robot) << "the robot holds the frame";
  send(2.0, {rival, "base", 0.5});
  EXPECT_EQ(*frame().publisher, rival) << "the robot was silent";
  send(2.1, {rival, "base", 0.6});
  EXPECT_EQ(intake_.history(number()).newest().stamp, s(102.1));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
