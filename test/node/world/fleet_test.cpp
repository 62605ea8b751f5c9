// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Robots that join and leave, and that are declared absent. The tests need no ROS master.
#include "test/node/world/fleet.h"

#include <algorithm>
#include <cmath>

#include "test/support/random.h"

namespace hgrid {
namespace test {
namespace {

std::string cartName(int number) { return "amr" + std::to_string(number); }

TEST_F(Fleet, RobotsOfOneRequestJoinInOneTick) {
  world_.setRobot(std::make_shared<const LoadedRobot>(cartNamed("boss")));
  sending["boss"] = -50.0;
  tickFor(0.5);
  const std::uint64_t revision = snapshot().structure().revision;
  RobotChanges changes;
  for (int i = 0; i < 20; ++i) {
    changes.push_back(joins(cartName(i)));
    sending[cartName(i)] = 0.25 * i;
  }
  EXPECT_EQ(refused(changes), std::nullopt);
  tick();
  EXPECT_EQ(snapshot().structure().bodies.size(), 42u);
  EXPECT_EQ(snapshot().structure().revision, revision + 1);
  EXPECT_EQ(tick_->models->robots, 21u);
  EXPECT_TRUE(snapshot().complete()) << snapshot().incompleteSources().front();
  EXPECT_EQ(pairsOf(snapshot()).size(), 2u * 19) << "each cart is near the next one, at the base and at the top";
}

TEST_F(Fleet, ARobotThatIsDeclaredAbsentIsNoSourceAndASilentOneIsLost) {
  world_.setRobot(std::make_shared<const LoadedRobot>(cartNamed("boss")));
  sending = {{"boss", -50.0}, {"a", 0.0}, {"b", 0.25}, {"c", 9.0}};
  EXPECT_EQ(refused({joins("a"), joins("b"), joins("c")}), std::nullopt);
  tickFor(1.0);
  ASSERT_TRUE(snapshot().complete());
  ASSERT_EQ(pairsOf(snapshot()), (std::set<std::string>{"a/base|b/base", "a/top|b/top"}));

  sending.erase("b");
  EXPECT_EQ(refused({isAbsent("b")}), std::nullopt);
  tick();
  EXPECT_TRUE(snapshot().complete());
  EXPECT_EQ(bodies(), (Names{"a/base", "a/top", "boss/base", "boss/top", "c/base", "c/top"}));
  EXPECT_EQ(tick_->models->absent, Names{"b"});
  EXPECT_EQ(tick_->models->expected, (Names{"a", "boss", "c"}));
  const std::vector<PairEvent>& events = snapshot().events();
  ASSERT_EQ(events.size(), 2u);
  for (const PairEvent& event : events) {
    EXPECT_EQ(event.kind, EventKind::end);
    EXPECT_EQ(event.cause, EventCause::bodies);
  }
  sending.erase("c");
  tickFor(4.0);
  EXPECT_EQ(snapshot().incompleteSources(), Names{"c"}) << "nobody said that c was switched off";
  EXPECT_EQ(refused({isAbsent("c"), isPresent("b")}), std::nullopt);
  sending["b"] = 0.25;
  tickFor(0.5);
  EXPECT_TRUE(snapshot().complete());
  EXPECT_EQ(pairsOf(snapshot()).size(), 2u) << "b has the model that it had";
  EXPECT_EQ(refused({isAbsent("c"), isPresent("b")}), std::nullopt) << "what is so already can be said again";
}

TEST_F(Fleet, APresentRobotThatSendsNothingMakesTheWorldIncomplete) {
  world_.setRobot(std::make_shared<const LoadedRobot>(cartNamed("boss")));
  sending["boss"] = 0.0;
  EXPECT_EQ(refused({joins("a"), isAbsent("a")}), std::nullopt);
  tickFor(0.5);
  EXPECT_TRUE(snapshot().complete());
  EXPECT_EQ(refused({isPresent("a")}), std::nullopt);
  tick();
  EXPECT_EQ(snapshot().incompleteSources(), Names{"a"});
}

TEST_F(Fleet, ARobotThatIsRemovedIsForgotten) {
  sending["a"] = 0.0;
  EXPECT_EQ(refused({joins("a"), leaves("boss")}), std::nullopt) << "a robot of the parameters can leave, too";
  tickFor(0.5);
  EXPECT_TRUE(snapshot().complete()) << "boss is not waited for any more";
  EXPECT_EQ(bodies(), (Names{"a/base", "a/top"}));
  EXPECT_EQ(refused({leaves("a"), leaves("a", 1)}), Refused(Code::unknown_id, 1));
  tick();
  EXPECT_EQ(bodies().size(), 2u);
  world_.setMissing(SourceId::ofRobot("boss"), "NOT_READY robot 'boss': a load that was under way has failed");
  tick();
  EXPECT_TRUE(snapshot().complete());
  EXPECT_EQ(refused({leaves("a")}), std::nullopt);
  tick();
  EXPECT_TRUE(bodies().empty());
}

TEST_F(Fleet, RequestsAreRefusedAsAWholeWithTheIndexOfTheChange) {
  sending = {{"boss", -50.0}, {"a", 0.0}};
  world_.setRobot(std::make_shared<const LoadedRobot>(cartNamed("boss")));
  ASSERT_EQ(refused({joins("a")}), std::nullopt);
  RobotChange other = joins("a", 3);
  RobotSpec spec = *other.spec;
  spec.params.description = "other_description";
  other.spec = std::make_shared<const RobotSpec>(spec);
  EXPECT_EQ(refused({joins("b"), isAbsent("boss", 1), other}), Refused(Code::dup_id, 3));
  EXPECT_EQ(refused({joins("b"), isAbsent("nobody", 2)}), Refused(Code::unknown_id, 2));
  EXPECT_EQ(refused({isPresent("nobody", 4)}), Refused(Code::unknown_id, 4));
  EXPECT_EQ(refused({isAbsent("a"), joins("a", 1)}), Refused(Code::dup_id, 1));
  EXPECT_NE(sentence_.find("declare it present"), std::string::npos) << sentence_;
  tickFor(0.5);
  EXPECT_EQ(bodies(), (Names{"a/base", "a/top", "boss/base", "boss/top"}));
  EXPECT_TRUE(tick_->models->absent.empty());
  EXPECT_EQ(refused({joins("a")}), std::nullopt) << "an equal robot is accepted";
}

TEST_F(Fleet, LimitsCountRobotsBodiesAndTexts) {
  world_.setRobot(std::make_shared<const LoadedRobot>(cartNamed("boss")));
  RobotChanges changes;
  for (int i = 0; i < 29; ++i) changes.push_back(joins(cartName(i), std::size_t(i)));
  EXPECT_EQ(refused(changes), std::nullopt);
  EXPECT_EQ(refused({joins("late", 5)}), Refused(Code::limit, 5));
  EXPECT_NE(sentence_.find("~limits/max_robots is 30"), std::string::npos) << sentence_;
  EXPECT_EQ(refused({isAbsent("amr1"), joins("late", 5)}), Refused(Code::limit, 5)) << "absent robots count";
  EXPECT_EQ(refused({leaves("amr1"), joins("late", 5)}), std::nullopt);

  LoadedRobot large = cartNamed("late");
  while (large.bodies.size() < 13) {
    large.bodies.push_back(large.bodies.back());
    large.bodies.back().name += "+";
    large.groups[0].members.emplace_back(large.bodies.size() - 1, Pose::Identity());
  }
  RobotChange too_large = joins("late", 1);
  too_large.model = std::make_shared<const LoadedRobot>(large);
  EXPECT_EQ(refused({leaves("late"), too_large}), Refused(Code::limit, 1)) << "58 + 13 bodies, and 70 are allowed";
  EXPECT_EQ(refused({leaves("late"), isAbsent("boss"), too_large}), std::nullopt);
  EXPECT_EQ(refused({isPresent("boss", 2)}), Refused(Code::limit, 2));

  RobotChange told = joins("told", 0), twice = joins("twice", 1);
  for (RobotChange* change : {&told, &twice}) {
    RobotSpec spec = *change->spec;
    std::string urdf(std::size_t(params_.max_description_bytes) / 2 + 1, ' ');
    if (change == &told) urdf += "!";
    spec.text = std::make_shared<const RobotDescription>(urdf);
    change->spec = std::make_shared<const RobotSpec>(spec);
  }
  EXPECT_EQ(refused({leaves("amr2"), leaves("amr3"), told, twice}), Refused(Code::limit, 1));
  EXPECT_NE(sentence_.find("~limits/max_description_bytes"), std::string::npos) << sentence_;
}

TEST_F(Fleet, WhatWasRefusedBeforeAnAbsenceStillMakesTheRobotIncompleteAfterIt) {
  world_.setRobot(std::make_shared<const LoadedRobot>(cartNamed("boss")));
  sending["boss"] = 0.0;
  tickFor(0.5);
  world_.setMissing(SourceId::ofRobot("boss"), "PARSE robot 'boss': broken");
  tick();
  const std::string reason = snapshot().reasonOf("boss");
  EXPECT_EQ(reason.substr(0, 14), "REFUSED 'boss'");
  EXPECT_EQ(refused({isAbsent("boss")}), std::nullopt);
  tick();
  EXPECT_TRUE(snapshot().complete());
  EXPECT_EQ(refused({isPresent("boss")}), std::nullopt);
  tickFor(0.5);
  EXPECT_EQ(snapshot().reasonOf("boss"), reason);
  world_.setRobot(std::make_shared<const LoadedRobot>(cartNamed("boss")));
  tick();
  EXPECT_TRUE(snapshot().complete());
}

TEST_F(Fleet, AnAbsentRobotKeepsANewModelForItsReturn) {
  world_.setRobot(std::make_shared<const LoadedRobot>(cartNamed("boss")));
  sending["boss"] = 0.0;
  tick();
  ASSERT_EQ(refused({isAbsent("boss")}), std::nullopt);
  LoadedRobot shorter = cartNamed("boss");
  shorter.bodies.pop_back();
  shorter.groups[0].members.pop_back();
  world_.setRobot(std::make_shared<const LoadedRobot>(shorter));
  tick();
  EXPECT_TRUE(bodies().empty());
  ASSERT_EQ(refused({isPresent("boss")}), std::nullopt);
  tick();
  EXPECT_EQ(bodies(), Names{"boss/base"});
}

TEST_F(Fleet, AResetRestoresTheConfiguredRobots) {
  world_.setRobot(std::make_shared<const LoadedRobot>(cartNamed("boss")));
  sending["boss"] = 0.0;
  EXPECT_EQ(refused({joins("a"), isAbsent("boss")}), std::nullopt);
  tick();
  world_.reset();
  tick();
  EXPECT_EQ(bodies(), (Names{"boss/base", "boss/top"})) << "its model was kept";
  EXPECT_TRUE(snapshot().complete());
  EXPECT_EQ(refused({leaves("boss")}), std::nullopt);
  world_.reset();
  tick();
  EXPECT_EQ(snapshot().incompleteSources(), Names{"boss"}) << "it must be loaded again";
  EXPECT_EQ(tick_->models->expected, Names{"boss"});
}

TEST_F(Fleet, WhatAnAbsentRobotCarriedStaysAndIsLost) {
  world_.setRobot(std::make_shared<const LoadedRobot>(cartNamed("boss")));
  sending = {{"boss", 0.0}, {"a", 5.0}};
  ASSERT_EQ(refused({joins("a")}), std::nullopt);
  tick();
  msg::ApplyObstacles::Request request;
  request.changes = {adding("part", 1), attaching("part", "a/top", 0.5)};
  world_.applyObstacles(obstacleChangesOf(request, "/caller", params_, *phase_, MeshSource()), momentAt(time_).ros);
  tick();
  sending.erase("a");
  ASSERT_EQ(refused({isAbsent("a")}), std::nullopt);
  tickFor(4.0);
  const std::uint32_t part = snapshot().structure().find("obstacle/part");
  ASSERT_NE(part, Structure::kNone);
  EXPECT_EQ(snapshot().poses()[part].state, Freshness::lost);
  EXPECT_EQ(snapshot().poses()[part].world_from_body.translation(), Eigen::Vector3d(5.5, 0, 1));
  EXPECT_EQ(snapshot().incompleteSources(), Names{"obstacle"}) << "nobody said where the part is";
  ASSERT_EQ(refused({isPresent("a")}), std::nullopt);
  sending["a"] = 6.0;
  tickFor(0.5);
  EXPECT_TRUE(snapshot().complete());
  const std::uint32_t again = snapshot().structure().find("obstacle/part");  // the names have other numbers now
  EXPECT_EQ(snapshot().poses()[again].world_from_body.translation(), Eigen::Vector3d(6.5, 0, 1));
}

/// Without ~world_frame, the world frame is the root of the first configured robot.
class FleetWithoutWorldFrame : public Fleet {
 protected:
  FleetWithoutWorldFrame() : Fleet(without()) {}
  static Params without() {
    Params value = params();
    value.world_frame.clear();
    return value;
  }
};

TEST_F(FleetWithoutWorldFrame, OnlyRobotsWithTheSameRootJoin) {
  EXPECT_EQ(refused({joins("a", 2)}), Refused(Code::not_ready, 2));
  world_.setRobot(std::make_shared<const LoadedRobot>(cartNamed("boss")));
  EXPECT_EQ(refused({joins("a", 2)}), Refused(Code::conflict, 2));
  EXPECT_NE(sentence_.find("set ~world_frame to a frame that tf connects to all robots"), std::string::npos);
  RobotChange twin = joins("twin");
  LoadedRobot model = cartNamed("twin");
  model.root_frame = model.groups[0].frame = "boss/base";
  twin.model = std::make_shared<const LoadedRobot>(model);
  EXPECT_EQ(refused({twin, leaves("boss")}), std::nullopt);
  tick();
  EXPECT_EQ(tick_->world_frame, "boss/base") << "the world frame stays";
  EXPECT_EQ(bodies(), (Names{"twin/base", "twin/top"}));
}

/// Claim: after random requests, the world has the robots and the pairs that the simplest model has, and is complete
/// unless a robot that should be there is silent.
TEST_F(Fleet, IsWhatASimpleModelSays) {
  Random random(3);
  world_.setRobot(std::make_shared<const LoadedRobot>(cartNamed("boss")));
  sending["boss"] = -3.0;
  struct Cart {
    bool absent = false, configured = false;  // a robot that joins is not equal to the configured one
  };
  std::map<std::string, Cart> model{{"boss", {false, true}}};
  int applied = 0, refusals = 0, complete = 0;
  for (int round = 0; round < 3000; ++round) {
    RobotChanges changes;
    std::map<std::string, Cart> after = model;
    std::optional<Refused> expected;
    const int count = random.between(0, 4);
    for (int i = 0; i < count; ++i) {
      const auto index = static_cast<std::size_t>(i);
      const std::string name = random.below(8) == 0 ? "boss" : cartName(random.between(0, 5));
      const auto known = after.find(name);
      const bool is_known = known != after.end();
      std::optional<Code> code;
      const int what = random.below(5);
      if (what == 0) {
        changes.push_back(leaves(name, index));
        if (is_known) after.erase(known);
      } else if (what < 3) {
        changes.push_back(what == 1 ? isAbsent(name, index) : isPresent(name, index));
        if (is_known) known->second.absent = what == 1;
      } else {
        changes.push_back(joins(name, index));
        if (is_known && (known->second.absent || known->second.configured)) code = Code::dup_id;
        if (!is_known) after[name] = {};
      }
      if (!is_known && what < 3) code = Code::unknown_id;
      if (code && !expected) expected = Refused(*code, index);
    }
    ASSERT_EQ(refused(changes), expected) << "round " << round << ": " << sentence_;
    expected ? ++refusals : ++applied;
    if (!expected) model = after;
    for (const auto& robot : model) {
      if (sending.count(robot.first) == 0) sending[robot.first] = 0.0;
    }
    for (auto& robot : sending) robot.second = 0.25 * random.between(0, 12);
    tick();
    Names names;
    std::set<std::string> pairs;
    for (const auto& [name, cart] : model) {
      if (cart.absent) continue;
      for (const char* link : {"/base", "/top"}) {
        names.push_back(name + link);
        for (const auto& [other, other_cart] : model) {
          if (other <= name || other_cart.absent) continue;
          const double gap = std::max(0.0, std::abs(sending[name] - sending[other]) - 0.2);
          if (gap <= params_.margin) pairs.insert(name + link + "|" + other + link);
        }
      }
    }
    ASSERT_EQ(bodies(), names) << "round " << round;
    ASSERT_EQ(pairsOf(snapshot()), pairs) << "round " << round;
    complete += snapshot().complete() ? 1 : 0;
  }
  EXPECT_GT(applied, 500);
  EXPECT_GT(refusals, 500);
  EXPECT_EQ(complete, 3000);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
