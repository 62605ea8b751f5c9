// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Obstacles that are attached to links of a robot. The tests need no ROS master.
#include "hgrid_proximity/pairs/rule_book.h"
#include "test/node/world/obstacle_world.h"
#include "test/support/models.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace test {
namespace {

TEST_F(Obstacles, ThatAreAttachedFollowTheLinkAndMayTouchIt) {
  msg::Obstacle held = attaching("part", "arm/tool", 0.5);
  held.touch = {"obstacle/po*"};
  apply({adding("part", 1), adding("lid", 2), held, attaching("lid", "arm/base")});
  tick();
  const Snapshot& first = tick();
  EXPECT_EQ(placesIn(first), (Places{{"lid", 2}, {"part", cart(time_) + 0.75}, {"post", 3}}));
  EXPECT_TRUE(mayTouch(first, "obstacle/part", "arm/hand")) << "it never moves relative to the tool";
  EXPECT_TRUE(mayTouch(first, "obstacle/part", "obstacle/post"));
  EXPECT_FALSE(mayTouch(first, "obstacle/part", "arm/base"));
  EXPECT_FALSE(mayTouch(first, "obstacle/part", "obstacle/lid"));
  EXPECT_TRUE(mayTouch(first, "obstacle/lid", "arm/base"));
  const double at = cart(time_) + 0.75;
  apply({detaching("part")});
  EXPECT_EQ(placesIn(tick()).at("part"), at);
  const Snapshot& last = tick();
  EXPECT_EQ(placesIn(last).at("part"), at);
  EXPECT_EQ(bodyOf(last, "obstacle/part").mobility, Mobility::fixed);
  EXPECT_FALSE(mayTouch(last, "obstacle/part", "arm/hand"));
}

TEST_F(Obstacles, KeepTheirPresentPoseIfTheyAreAttachedWithoutOne) {
  apply({adding("part", 1)});
  tick();
  apply({attaching("part", "arm/hand")});
  const double before = cart(time_);
  tick();
  EXPECT_EQ(placesIn(*tick_->snapshot).at("part"), 1 + cart(time_) - before);
  apply({attaching("part", "arm/base")});  // from link to link
  const double place = placesIn(*tick_->snapshot).at("part");
  EXPECT_EQ(placesIn(tick()).at("part"), place);
  EXPECT_EQ(placesIn(tick()).at("part"), place);
}

TEST_F(Obstacles, ThatAreAttachedStayWhereTheirLinkWas) {
  apply({adding("part", 1), attaching("part", "arm/hand", 0.5)});
  tick();
  const double last = cart(time_) + 0.5;
  LoadedRobot without_hand = arm();
  without_hand.bodies.pop_back();
  without_hand.groups.pop_back();
  without_hand.links.erase("arm/hand");
  without_hand.links.erase("arm/tool");
  without_hand.without_collision.clear();
  world_.setRobot(std::make_shared<const LoadedRobot>(without_hand));
  for (int second = 1; second <= 20; ++second) tick_ = world_.tick(momentAt(time_ + second));  // the cart is silent
  const Snapshot& snapshot = *tick_->snapshot;
  EXPECT_EQ(placesIn(snapshot), (Places{{"part", last}, {"post", 3}}));
  EXPECT_EQ(snapshot.poses()[indexOf(snapshot, "obstacle/part")].state, Freshness::lost);
  EXPECT_FALSE(snapshot.complete());
  time_ += 20.0;
  EXPECT_EQ(refused({detaching("part")}), Refused(Code::extrapolation, 0)) << "nobody knows where it is now";
  tick();  // the cart moves again
  EXPECT_EQ(placesIn(*tick_->snapshot).at("part"), cart(time_) + 0.5);
  EXPECT_EQ(refused({detaching("part")}), std::nullopt);
}

/// Returns an arm whose hand turns at 3 rad/s, with a flange at the joint.
std::shared_ptr<const LoadedRobot> turningArm() {
  const auto read = std::make_shared<ReadDescription>();
  addLink(read->model, "base", -1);
  addLink(read->model, "hand", 0);
  read->model.links[1].max_velocity = 3.0;
  addLink(read->model, "tool", 1, JointKind::fixed, false);
  read->model.links[2].parent_from_joint.translation().x() = 0.25;
  addLink(read->model, "flange", 1, JointKind::fixed, false);
  findRigidGroups(read->model);
  LoadedRobot turning = arm();
  turning.read = read;
  turning.links["arm/flange"] = {1, Pose::Identity()};
  for (Body& link : turning.bodies) link.max_speed = 1.0;
  return std::make_shared<const LoadedRobot>(turning);
}

/// Claim: what is attached to a link may reach farther out than the link, and is then expected to be faster.
TEST_F(Obstacles, ThatAreAttachedAreAsFastAsTheJointsLetTheirFarEndBe) {
  world_.setRobot(turningArm());
  apply({adding("part", 1), attaching("part", "arm/tool", 3.0)});
  EXPECT_DOUBLE_EQ(bodyOf(tick(), "obstacle/part").max_speed, 3.0 * 3.35);
}

/// Claim: an obstacle that follows the tf frame of a link moves like one that is attached to it.
TEST_F(Obstacles, ThatFollowTheFrameOfALinkAreAsFastAsTheJointsLetTheirFarEndBe) {
  msg::Obstacle bounded = adding("bounded", 3.0, 0.1, "flange");
  bounded.max_speed = 0.5;
  apply({adding("pole", 3.0, 0.5, "flange"), adding("crate", 3.0), bounded});
  EXPECT_EQ(bodyOf(tick(), "obstacle/pole").max_speed, params().default_max_speed);
  world_.setRobot(turningArm());
  EXPECT_DOUBLE_EQ(bodyOf(tick(), "obstacle/pole").max_speed, 3.0 * 3.5) << "the robot came later";
  EXPECT_EQ(bodyOf(tick(), "obstacle/crate").max_speed, params().default_max_speed) << "it follows no link";
  EXPECT_EQ(bodyOf(tick(), "obstacle/bounded").max_speed, 0.5) << "the request gives a bound";
  apply({moving("pole", 5.0, "flange"), adding("rod", 2.0, 0.1, "hand")});
  EXPECT_DOUBLE_EQ(bodyOf(tick(), "obstacle/pole").max_speed, 3.0 * 5.5);
  EXPECT_DOUBLE_EQ(bodyOf(tick(), "obstacle/rod").max_speed, 3.0 * 2.1);
  apply({moving("pole", 5.0)});
  EXPECT_EQ(bodyOf(tick(), "obstacle/pole").max_speed, params().default_max_speed);
}

TEST_F(Obstacles, ThatAreAttachedMoveWithANewModelOfTheRobot) {
  apply({adding("part", 1), attaching("part", "arm/tool", 0.5)});
  tick();
  LoadedRobot longer = arm();
  longer.bodies.push_back(linkOf("finger", "cart"));
  longer.bodies.back().max_speed = 7.0;
  longer.groups[1].members.emplace_back(2, Pose::Identity());
  longer.links["arm/finger"] = {1, Pose::Identity()};
  longer.links["arm/tool"].frame_from_link.translation().x() = 0.375;
  world_.setRobot(std::make_shared<const LoadedRobot>(longer));
  const Snapshot& snapshot = tick();
  EXPECT_EQ(placesIn(snapshot).at("part"), cart(time_) + 0.875);
  EXPECT_TRUE(mayTouch(snapshot, "obstacle/part", "arm/finger"));
  EXPECT_GE(bodyOf(snapshot, "obstacle/part").max_speed, 7.0);
}

TEST_F(Obstacles, WhoseNamesAreGlobsCannotBeAttached) {
  apply({adding("p*", 1), adding("q?", 2)});
  EXPECT_EQ(refused({attaching("p*", "arm/hand")}), Refused(Code::bad_id, 0));
  apply({attaching("q?", "arm/hand")});
}

TEST_F(Obstacles, RefuseInvalidAttachments) {
  apply({adding("part", 1), adding("lid", 2), attaching("part", "arm/hand")});
  tick();
  msg::Obstacle long_glob = attaching("lid", "arm/hand"), many = long_glob;
  long_glob.touch = {std::string(600, 'a')};
  many.touch.assign(101, "arm/*");
  const std::vector<std::pair<msg::Obstacle, Code>> wrong{
      {moving("part", 2), Code::conflict},
      {detaching("lid"), Code::conflict},
      {detaching("nobody"), Code::unknown_id},
      {attaching("nobody", "arm/hand"), Code::unknown_id},
      {attaching("lid", "arm/foot"), Code::unknown_id},
      {attaching("lid", "hand"), Code::unknown_id},
      {attaching("lid", ""), Code::unknown_id},
      {attaching("lid", "arm/hand", std::nan("")), Code::nonfinite},
      {attaching("lid", "arm/hand", 2e6), Code::out_of_range},
      {adding("part", 1), Code::dup_id},
      {long_glob, Code::bad_id},
      {many, Code::limit},
  };
  for (const auto& [change, code] : wrong) {
    EXPECT_EQ(refused({removing("post"), change}), Refused(code, 1)) << change.name << " " << name(code);
  }
  many.touch.assign(40, "arm/*");
  EXPECT_THROW(apply({many}), Refusal) << "more than ~limits/max_rules";
  EXPECT_EQ(placesIn(tick()).size(), 3u);
  EXPECT_TRUE(mayTouch(*tick_->snapshot, "obstacle/part", "arm/hand"));
}

TEST_F(Obstacles, AndLinksThatDoNotExistAreRefusedWithSimilarNames) {
  apply({adding("part", 1), adding("lid", 2)});
  tick();
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { apply({removing("prat")}); }, &sentence), Code::unknown_id);
  EXPECT_TRUE(says(sentence, "similar names are 'obstacle/part'"));
  EXPECT_EQ(refusalOf([&] { apply({attaching("lid", "arm/hnad")}); }, &sentence), Code::unknown_id);
  EXPECT_TRUE(says(sentence, "similar names are 'arm/hand'"));
}

TEST_F(Obstacles, LeaveTheRulesOfTheUserAsTheyAre) {
  apply({adding("part", 1), attaching("part", "arm/hand")});
  const auto structure = [&]() -> const Structure& { return tick().structure(); };
  RuleBook book(structure().filter.rules(), 40);
  PairRule rule;
  rule.first = "obstacle/part";
  rule.second = "arm/hand";
  rule.allowed = false;
  book.add({rule});
  const Structure& before = structure();
  const PreparedRules prepared{PairFilter(before.bodies, PairKinds{}, book.rules()), before.revision};
  apply({adding("lid", 2), attaching("lid", "arm/hand")});  // in the same tick, after the rules were prepared
  world_.setRules(prepared);
  const Snapshot& after = tick();
  EXPECT_FALSE(mayTouch(after, "obstacle/part", "arm/hand")) << "the rule of the user takes precedence";
  EXPECT_TRUE(mayTouch(after, "obstacle/lid", "arm/hand"));
  apply({removing("lid"), detaching("part")});
  const Snapshot& last = tick();
  ASSERT_EQ(last.structure().filter.rules().size(), 1u);
  EXPECT_EQ(last.structure().filter.rules()[0].origin, Origin::service);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
