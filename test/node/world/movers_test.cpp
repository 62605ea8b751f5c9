// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/world/movers.h"

#include <gtest/gtest.h>

#include "test/support/refusals.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace test {
namespace {

Body bodyOf(const std::string& name) {
  Body body = ball("any");
  body.name = name;
  return body;
}

Pose shifted(double x) { return Pose(Eigen::Translation3d(x, 0.0, 0.0)); }

/// A scene with two robots and the obstacle "post". Two links of the robot "arm" are on one frame, one link is on
/// another frame. The robot "cart" has one link.
class MoversTest : public ::testing::Test {
 protected:
  void SetUp() override {
    Body post = bodyOf("obstacle/post");
    post.frame = "world";
    movers_.add(SourceId::ofObstacle("obstacle/post"), post);
    NewMovers coming;
    addArm(coming);
    coming.add("cart_base", SourceId::ofRobot("cart"), bodyOf("cart/base"), Pose::Identity());
    movers_.exchange(nullptr, std::move(coming));
  }

  static void addArm(NewMovers& coming) {
    coming.add("shoulder", SourceId::ofRobot("arm"), bodyOf("arm/shoulder"), Pose::Identity());
    coming.join(bodyOf("arm/upper"), shifted(0.5));
    coming.add("wrist", SourceId::ofRobot("arm"), bodyOf("arm/wrist"), Pose::Identity());
  }

  /// Returns one line for each mover, in the form "frame: body body".
  std::vector<std::string> listed() {
    std::vector<std::string> lines;
    for (const Mover& mover : movers_.all()) {
      std::string line = mover.frame + ":";
      for (std::size_t i = mover.first; i < mover.last; ++i) {
        line += " " + scene_.body(movers_.members()[i].body).name;
      }
      lines.push_back(line);
    }
    return lines;
  }

  static SceneOptions optionsOfTheScene() {
    SceneOptions options;
    options.max_bodies = 5;
    return options;
  }

  using Lines = std::vector<std::string>;
  Scene scene_{optionsOfTheScene()};
  Movers movers_{scene_};
};

TEST_F(MoversTest, KnowWhichBodiesFollowWhichFrame) {
  EXPECT_EQ(listed(), (Lines{"world: obstacle/post", "shoulder: arm/shoulder arm/upper", "wrist: arm/wrist",
                             "cart_base: cart/base"}));
  EXPECT_TRUE(movers_.members()[1].at_frame);
  EXPECT_FALSE(movers_.members()[2].at_frame);
  EXPECT_EQ(movers_.members()[2].frame_from_body.translation().x(), 0.5);
}

TEST_F(MoversTest, ReplaceTheBodiesOfOneSourceAndKeepThePosesOfTheOthers) {
  movers_.all().back().pose.renew(Time(7), Time(3));
  const std::uint64_t before = movers_.revision();
  const SourceId arm = SourceId::ofRobot("arm");
  NewMovers coming;
  coming.add("shoulder", arm, bodyOf("arm/shoulder"), shifted(1.0));  // the scene already has a body of this name
  movers_.exchange([&](const SourceId& source) { return source == arm; }, std::move(coming));
  EXPECT_EQ(listed(), (Lines{"world: obstacle/post", "cart_base: cart/base", "shoulder: arm/shoulder"}));
  EXPECT_EQ(scene_.size(), 3u);
  EXPECT_EQ(movers_[1].pose.stamp(), Time(7));
  EXPECT_FALSE(movers_[2].pose.exists()) << "a new body has no pose";
  EXPECT_GT(movers_.revision(), before);
}

TEST_F(MoversTest, KeepTheMembersOfOtherMoversWhenOneIsRemoved) {
  const SourceId post = SourceId::ofObstacle("obstacle/post");
  NewMovers coming;
  const SourceId box = SourceId::ofObstacle("obstacle/box");
  coming.add("world", box, bodyOf("obstacle/box"), shifted(2.0));
  movers_.exchange([&](const SourceId& source) { return source == post; }, std::move(coming));
  EXPECT_EQ(listed(), (Lines{"shoulder: arm/shoulder arm/upper", "wrist: arm/wrist", "cart_base: cart/base",
                             "world: obstacle/box"}));
  EXPECT_EQ(movers_.members().size(), 5u);
  EXPECT_EQ(movers_.members()[1].frame_from_body.translation().x(), 0.5);
  EXPECT_EQ(movers_.members()[4].frame_from_body.translation().x(), 2.0);
}

TEST_F(MoversTest, RemoveAllSourcesOfAKind) {
  movers_.exchange([](const SourceId& source) { return source.kind == SourceKind::robot; }, {});
  EXPECT_EQ(listed(), (Lines{"world: obstacle/post"}));
  EXPECT_EQ(scene_.size(), 1u);
}

TEST_F(MoversTest, StayAsTheyWereIfTheSceneRefusesAChange) {
  const Lines before = listed();
  const std::uint64_t revision = movers_.revision();
  NewMovers coming;
  coming.add("other", SourceId::ofRobot("other"), bodyOf("arm/wrist"), Pose::Identity());
  EXPECT_NE(refusalOf([&] { movers_.exchange(nullptr, std::move(coming)); }), Code::ok);
  EXPECT_NE(refusalOf([&] { movers_.add(SourceId::ofObstacle("obstacle/post"), bodyOf("obstacle/post")); }), Code::ok);
  EXPECT_EQ(listed(), before);
  EXPECT_EQ(scene_.size(), 5u);
  EXPECT_EQ(movers_.revision(), revision) << "the chains need no new plan";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
