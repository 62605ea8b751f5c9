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

/// Knows "arm" in "base" at 10 s (x = 1 m) and at 12 s (x = 3 m), and "tool" fixed to "arm" at x = 0.5 m. The frame
/// "island" is connected to neither.
class TransformLookupTest : public ::testing::Test {
 protected:
  void SetUp() override {
    send("base", "arm", 1.0, 10.0, false);
    send("base", "arm", 3.0, 12.0, false);
    send("arm", "tool", 0.5, 0.0, true);
    send("sea", "island", 0.0, 10.0, false);
  }

  void send(const std::string& parent, const std::string& child, double x, double time, bool is_static) {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = parent;
    transform.header.stamp.fromSec(time);
    transform.child_frame_id = child;
    transform.transform.translation.x = x;
    transform.transform.rotation.w = 1.0;
    ASSERT_TRUE(buffer_.setTransform(transform, "test", is_static));
  }

  double xAtOrNewest(const std::string& frame, double time) const {
    return lookup_.atOrNewest("base", frame, s(time), kMaxApart, "frame '" + frame + "'").translation().x();
  }

  tf2::BufferCore buffer_{ros::Duration(100.0)};
  TransformLookup lookup_{buffer_};
};

TEST_F(TransformLookupTest, KnowsAPoseBetweenTwoTransformsAndNotOutside) {
  EXPECT_DOUBLE_EQ(lookup_.at("base", "tool", s(11))->translation.x(), 2.5);
  EXPECT_TRUE(lookup_.isKnown("base", "tool", s(11)));
  for (const double time : {9.0, 13.0}) {
    std::string why_not;
    EXPECT_FALSE(lookup_.at("base", "tool", s(time), &why_not)) << time;
    EXPECT_NE(why_not.find("xtrapolation"), std::string::npos) << why_not;
    EXPECT_FALSE(lookup_.isKnown("base", "tool", s(time))) << time;
  }
}

TEST_F(TransformLookupTest, KnowsTheNewestPoseWhateverItsTime) {
  EXPECT_DOUBLE_EQ(lookup_.newest("base", "tool")->translation.x(), 3.5);
  EXPECT_TRUE(lookup_.isConnected("base", "tool"));
  EXPECT_TRUE(lookup_.isConnected("tool", "base"));
  EXPECT_FALSE(lookup_.newest("base", "island"));
  EXPECT_FALSE(lookup_.isConnected("base", "island"));
  EXPECT_FALSE(lookup_.isConnected("base", "nowhere"));
}

TEST_F(TransformLookupTest, KnowsEachFrameInItself) {
  EXPECT_TRUE(lookup_.isConnected("nowhere", "nowhere"));
  EXPECT_TRUE(lookup_.isKnown("nowhere", "nowhere", s(1)));
  EXPECT_EQ(*lookup_.at("nowhere", "nowhere", s(1)), FramePose{});
  EXPECT_EQ(lookup_.atOrNewest("nowhere", "nowhere", s(1), 0.0, "it").matrix(), Pose::Identity().matrix());
}

TEST_F(TransformLookupTest, TakesTheNewestPoseWhereItIsNearEnoughInTime) {
  EXPECT_DOUBLE_EQ(xAtOrNewest("tool", 11.0), 2.5) << "the exact time comes first";
  EXPECT_DOUBLE_EQ(xAtOrNewest("tool", 12.25), 3.5);
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { xAtOrNewest("tool", 12.26); }, &sentence), Code::extrapolation);
  EXPECT_EQ(sentence, "frame 'tool' is known at 12 s, the world at 12.26 s; they may be 0.25 s apart (~stale_after)");
  EXPECT_EQ(refusalOf([&] { xAtOrNewest("tool", 1.0); }), Code::extrapolation);
}

TEST_F(TransformLookupTest, RefusesAFrameThatIsNotConnected) {
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { xAtOrNewest("island", 10.0); }, &sentence), Code::unknown_frame);
  EXPECT_EQ(sentence.find("frame 'island' is not connected to 'base': "), 0u) << sentence;
  EXPECT_EQ(refusalOf([&] { xAtOrNewest("nowhere", 10.0); }), Code::unknown_frame);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
