// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/world/unplaced_robots.h"

#include <gtest/gtest.h>

#include "test/support/refusals.h"

namespace hgrid {
namespace {

using test::says;

/// Two links of a robot: "base", which is the root, and "hand".
class UnplacedRobots : public ::testing::Test {
 protected:
  UnplacedRobots() {
    for (const char* frame : {"base", "hand"}) {
      Mover mover{frame, SourceId::ofRobot("arm"), movers_.size(), movers_.size() + 1};
      mover.trouble = Refusal(Code::unknown_frame, "frame is not connected");
      movers_.push_back(mover);
    }
  }
  void publish(const std::string& parent, const std::string& child) {
    frames_.setParent(frames_.admit(parent, child), parent);
  }
  void place(std::size_t mover) {
    movers_[mover].pose.settle(Time(1));
    movers_[mover].trouble.reset();
  }

  std::vector<Mover> movers_;
  RobotEntries robots_;
  FrameTable frames_{100};
};

TEST_F(UnplacedRobots, WithoutAnyTransformNeedAPublisher) {
  place(0);  // the root of the robot is the world frame
  const auto sentences = whyUnplaced(movers_, robots_, frames_, "base", false);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_TRUE(says(sentences[0], "robot 'arm': 1 of its 2 links never had a pose: frame 'hand' was never published"));
  EXPECT_TRUE(says(sentences[0], "start robot_state_publisher"));
}

TEST_F(UnplacedRobots, WhoseFrameRobotStatePublisherNeverSendsSayWhy) {
  place(0);
  auto model = std::make_shared<LoadedRobot>();
  model->unsent_frames["hand"] = "joint 'x' follows 'y'";
  robots_["arm"].model = model;
  auto sentences = whyUnplaced(movers_, robots_, frames_, "base", false);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_TRUE(says(sentences[0], "1 of its 2 links never had a pose: joint 'x' follows 'y'"));
  publish("elsewhere", "hand");
  sentences = whyUnplaced(movers_, robots_, frames_, "base", false);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_TRUE(says(sentences[0], "frame 'hand' is not connected to the world frame"));
}

TEST_F(UnplacedRobots, InAWorldFrameThatTfDoesNotKnowAreNotToBlame) {
  publish("map", "base");
  publish("base", "hand");
  const auto sentences = whyUnplaced(movers_, robots_, frames_, "wrold", true);
  ASSERT_EQ(sentences.size(), 1u) << "the frames of the robot are published";
  EXPECT_TRUE(says(sentences[0], "~world_frame is 'wrold', but no transform names this frame"));
  EXPECT_TRUE(says(sentences[0], "frames without a parent are 'map'"));
}

TEST_F(UnplacedRobots, ThatAreNotConnectedToTheWorldFrameSaySo) {
  publish("base", "hand");
  publish("map", "odom");
  const auto sentences = whyUnplaced(movers_, robots_, frames_, "map", true);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_TRUE(
      says(sentences[0], "2 of its 2 links never had a pose: frame 'base' is not connected to the world frame"));
}

TEST_F(UnplacedRobots, WithARefusedTransformHaveAReasonOfTheirOwn) {
  publish("map", "base");
  publish("base", "hand");
  for (Mover& mover : movers_) mover.trouble = Refusal(Code::nonfinite, "a number is not finite");
  EXPECT_TRUE(whyUnplaced(movers_, robots_, frames_, "map", true).empty());
  movers_[0].source = movers_[1].source = SourceId::ofObstacle("obstacle/crate");
  EXPECT_TRUE(whyUnplaced(movers_, robots_, frames_, "nowhere", false).empty());
}

}  // namespace
}  // namespace hgrid
