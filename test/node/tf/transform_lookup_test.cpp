// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/tf/transform_lookup.h"

#include <gtest/gtest.h>

#include "hgrid_proximity/refusal.h"
#include "test/node/support/moments.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace test {
namespace {

constexpr double kMaxApart = 0.25;  // [s]

/// The frame "arm" is known in "base" at 10 s (x = 1 m) and at 12 s (x = 3 m). The frame "tool" is fixed to "arm" at x
/// = 0.5 m. The frame "island" is not connected with the other frames.
class TransformLookupTest : public ::testing::Test {
 protected:
  void SetUp() override {
    send("base", "arm", 1.0, 10.0);
    send("base", "arm", 3.0, 12.0);
    store_.fix(store_.admit("arm", "tool"), "arm", at(0.5));
    send("sea", "island", 0.0, 10.0);
  }

  static FramePose at(double x) {
    FramePose pose;
    pose.translation.x() = x;
    return pose;
  }

  void send(const std::string& parent, const std::string& child, double x, double time, bool continues = true) {
    store_.advance(store_.admit(parent, child), parent, {s(time), FrameTable::kNone, continues, at(x)}, s(time));
  }

  double xAtOrNewest(const std::string& frame, double time) const {
    return lookup_.atOrNewest("base", frame, s(time), kMaxApart, "frame '" + frame + "'").translation().x();
  }

  std::string whyNot(const std::string& target, const std::string& frame, double time) const {
    std::string why_not;
    EXPECT_FALSE(lookup_.at(target, frame, s(time), &why_not));
    EXPECT_FALSE(lookup_.isKnown(target, frame, s(time)));
    return why_not;
  }

  TransformStore store_{s(100), 1000};
  TransformLookup lookup_{store_};
};

TEST_F(TransformLookupTest, DoesNotUseTheStaticPoseOfAFreeFrame) {
  EXPECT_TRUE(store_.setFree({"arm", "tool", "later"}));
  EXPECT_FALSE(store_.setFree({"arm", "later", "tool"}));
  store_.fix(store_.admit("arm", "later"), "arm", at(0.5));
  EXPECT_TRUE(lookup_.at("base", "arm", s(11))) << "it is on /tf";
  for (const std::string frame : {"tool", "later"}) {
    EXPECT_TRUE(says(whyNot("base", frame, 11), "a planar or floating joint moves frame '" + frame + "'"));
    EXPECT_TRUE(says(whyNot(frame, "base", 11), "the frame is only on /tf_static"));
    EXPECT_FALSE(lookup_.isConnected("base", frame));
    EXPECT_FALSE(lookup_.newest("base", frame));
  }
  EXPECT_TRUE(store_.setFree({"arm"}));
  EXPECT_TRUE(lookup_.isConnected("base", "tool"));
  EXPECT_TRUE(lookup_.isConnected("base", "later"));
}

TEST_F(TransformLookupTest, KnowsAPoseBetweenTwoTransformsAndNotOutside) {
  EXPECT_DOUBLE_EQ(lookup_.at("base", "tool", s(11))->translation.x(), 2.5);
  EXPECT_DOUBLE_EQ(lookup_.at("tool", "base", s(11))->translation.x(), -2.5);
  EXPECT_TRUE(lookup_.isKnown("base", "tool", s(11)));
  for (const double time : {9.0, 13.0}) {
    EXPECT_EQ(whyNot("base", "tool", time), "frame 'arm' is known from 10 s to 12 s");
    EXPECT_EQ(whyNot("tool", "base", time), "frame 'arm' is known from 10 s to 12 s");
  }
}

TEST_F(TransformLookupTest, NeedsOnlyTheTransformsBetweenTheTwoFrames) {
  send("map", "base", 100.0, 12.0);
  EXPECT_DOUBLE_EQ(lookup_.at("base", "tool", s(11))->translation.x(), 2.5);
  EXPECT_EQ(whyNot("map", "tool", 11), "frame 'base' is known from 12 s to 12 s");
  EXPECT_DOUBLE_EQ(lookup_.at("map", "tool", s(12))->translation.x(), 103.5);
}

TEST_F(TransformLookupTest, KnowsTheNewestPoseWhateverItsTime) {
  EXPECT_DOUBLE_EQ(lookup_.newest("base", "tool")->translation.x(), 3.5);
  EXPECT_TRUE(lookup_.isConnected("base", "tool"));
  EXPECT_TRUE(lookup_.isConnected("tool", "base"));
  EXPECT_FALSE(lookup_.newest("base", "island"));
  EXPECT_FALSE(lookup_.isConnected("base", "island"));
  EXPECT_FALSE(lookup_.isConnected("base", "nowhere"));
}

TEST_F(TransformLookupTest, TakesAllTransformsOfTheNewestPoseAtOneTime) {
  send("arm", "hand", 10.0, 9.0);
  send("arm", "hand", 30.0, 11.0);
  EXPECT_DOUBLE_EQ(lookup_.newest("base", "hand")->translation.x(), 32.0) << "both transforms are taken at 11 s";
}

TEST_F(TransformLookupTest, TakesTheNewestPoseFromBeforeASeam) {
  send("arm", "hand", 10.0, 11.0);
  send("arm", "hand", 30.0, 13.0, false);
  EXPECT_DOUBLE_EQ(lookup_.newest("base", "hand")->translation.x(), 12.0) << "both transforms are taken at 11 s";
  EXPECT_EQ(whyNot("base", "hand", 12),
            "frame 'hand' is not known between 11 s and 13 s, because its publisher or parent changed or its "
            "transforms paused");
}

TEST_F(TransformLookupTest, FollowsTheParentsOfEachTime) {
  send("table", "part", 1.0, 10.0);
  send("base", "table", 5.0, 9.0);
  send("base", "table", 5.0, 14.0);
  send("table", "part", 1.0, 10.5);
  send("arm", "part", 2.0, 11.0, false);
  send("arm", "part", 2.0, 12.0);
  EXPECT_DOUBLE_EQ(lookup_.at("base", "part", s(10.25))->translation.x(), 6.0);
  EXPECT_DOUBLE_EQ(lookup_.at("base", "part", s(11.5))->translation.x(), 4.5);
  EXPECT_FALSE(lookup_.at("base", "part", s(10.75)));
  EXPECT_DOUBLE_EQ(lookup_.newest("base", "part")->translation.x(), 5.0);
}

TEST_F(TransformLookupTest, KnowsNothingThatMovesAfterStampsWereForgotten) {
  store_.forgetStamps();
  EXPECT_FALSE(lookup_.isConnected("base", "tool"));
  EXPECT_FALSE(lookup_.newest("base", "tool"));
  EXPECT_DOUBLE_EQ(lookup_.newest("arm", "tool")->translation.x(), 0.5) << "a static transform stays";
  EXPECT_EQ(whyNot("base", "tool", 11), "there is no chain of transforms between them now");
}

TEST_F(TransformLookupTest, EndsInALoopOfParents) {
  send("tool", "base", 1.0, 12.0);
  EXPECT_TRUE(lookup_.isConnected("base", "tool"));
  EXPECT_FALSE(lookup_.isConnected("island", "tool"));
}

TEST_F(TransformLookupTest, KnowsEachFrameInItself) {
  EXPECT_TRUE(lookup_.isConnected("nowhere", "nowhere"));
  EXPECT_TRUE(lookup_.isKnown("nowhere", "nowhere", s(1)));
  EXPECT_EQ(*lookup_.at("nowhere", "nowhere", s(1)), FramePose{});
  EXPECT_EQ(lookup_.atOrNewest("nowhere", "nowhere", s(1), 0.0, "it").matrix(), Pose::Identity().matrix());
}

TEST_F(TransformLookupTest, TakesTheNewestPoseWhereItIsNearEnoughInTime) {
  EXPECT_DOUBLE_EQ(xAtOrNewest("tool", 11.0), 2.5) << "the pose at the exact time is preferred";
  EXPECT_DOUBLE_EQ(xAtOrNewest("tool", 12.25), 3.5);
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { xAtOrNewest("tool", 12.26); }, &sentence), Code::extrapolation);
  EXPECT_EQ(sentence,
            "frame 'tool' is last known at 12 s, but the world is at 12.26 s; the two times may differ by at most 0.25 "
            "s (~stale_after)");
  EXPECT_EQ(refusalOf([&] { xAtOrNewest("tool", 1.0); }), Code::extrapolation);
}

TEST_F(TransformLookupTest, RefusesAFrameThatIsNotConnected) {
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { xAtOrNewest("island", 10.0); }, &sentence), Code::unknown_frame);
  EXPECT_EQ(sentence, "frame 'island' is not connected to 'base': there is no chain of transforms between them now");
  EXPECT_EQ(refusalOf([&] { xAtOrNewest("nowhere", 10.0); }, &sentence), Code::unknown_frame);
  EXPECT_EQ(sentence, "frame 'nowhere' is not connected to 'base': frame 'nowhere' was never published");
}

}  // namespace
}  // namespace test
}  // namespace hgrid
