// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Obstacles of one group: they move as one and make no pairs with each other.
#include <set>

#include "test/node/world/obstacle_world.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {
namespace {

msg::Obstacle inGroup(const std::string& group, msg::Obstacle change) {
  change.group = group;
  return change;
}

/// Turns the pose of a change about the z axis.
msg::Obstacle turned(msg::Obstacle change, double angle) {
  change.pose.orientation.z = std::sin(0.5 * angle);
  change.pose.orientation.w = std::cos(0.5 * angle);
  return change;
}

Pose poseOf(const Snapshot& snapshot, const std::string& name) {
  return snapshot.poses()[snapshot.structure().find(name)].world_from_body;
}

TEST_F(Obstacles, OfOneGroupMoveAsOneRigidBody) {
  apply({inGroup("rack", adding("left", 1)), inGroup("rack", adding("right", 2)), adding("other", 4)});
  tick();
  apply({turned(moving("left", 5), M_PI_2)});
  const Snapshot& snapshot = tick();
  EXPECT_EQ(placesIn(snapshot), (Places{{"left", 5}, {"other", 4}, {"post", 3}, {"right", 5}}));
  const Pose right = poseOf(snapshot, "obstacle/right");
  EXPECT_NEAR(right.translation().y(), 1.0, 1e-12) << "it was beside the other one, which was turned";
  EXPECT_NEAR(right.linear()(1, 0), 1.0, 1e-12);
  apply({moving("right", 0)});
  EXPECT_NEAR(poseOf(tick(), "obstacle/left").translation().x(), -1.0, 1e-12) << "in both directions";
}

TEST_F(Obstacles, OfOneGroupMakeNoPairsWithEachOther) {
  msg::Obstacle left = inGroup("rack", adding("left", 1)), right = inGroup("rack", adding("right", 1.05));
  msg::Obstacle other = inGroup("shelf", adding("other", 1.1));
  left.moving = right.moving = other.moving = true;
  apply({left, right, other});
  const Snapshot& snapshot = tick();
  std::set<std::string> pairs;
  for (const NearPair& pair : snapshot.pairs()) {
    const BodyList& bodies = snapshot.structure().bodies;
    pairs.insert(bodies[pair.first].name.substr(9) + " " + bodies[pair.second].name.substr(9));
  }
  EXPECT_EQ(pairs, (std::set<std::string>{"left other", "other right"}));
  const PairDecision decision =
      snapshot.structure().filter.decision(indexOf(snapshot, "obstacle/left"), indexOf(snapshot, "obstacle/right"));
  EXPECT_EQ(decision.origin, Origin::group);
  EXPECT_TRUE(decision.allowed);
  right.group.clear();
  right.replace = true;
  apply({right});
  EXPECT_FALSE(mayTouch(tick(), "obstacle/left", "obstacle/right")) << "it has left the group";
}

TEST_F(Obstacles, ARuleDecidesAboutAPairWithinAGroup) {
  msg::Obstacle left = inGroup("rack", adding("left", 1)), right = inGroup("rack", adding("right", 1.05));
  left.moving = right.moving = true;
  apply({left, right});
  const Structure& structure = tick().structure();
  PairRule rule{"obstacle/left", "obstacle/*", "", false};
  rule.origin = Origin::service;
  world_.setRules({PairFilter(structure.bodies, PairKinds(), {rule}), structure.revision});
  EXPECT_FALSE(mayTouch(tick(), "obstacle/left", "obstacle/right"));
  EXPECT_EQ(tick_->snapshot->pairs().size(), 1u);
}

TEST_F(Obstacles, OfOneGroupAreAttachedAndDetachedTogether) {
  apply({inGroup("tool", adding("grip", 10.25, 0.1)), inGroup("tool", adding("tip", 10.5, 0.1))});
  tick();
  apply({attaching("grip", "arm/tool", 0.5)});
  const Snapshot& attached = tick();
  EXPECT_NEAR(placesIn(attached)["grip"], cart(time_) + 0.75, 1e-6);
  EXPECT_NEAR(placesIn(attached)["tip"], cart(time_) + 1.0, 1e-6);
  EXPECT_TRUE(mayTouch(attached, "obstacle/tip", "arm/hand"));
  EXPECT_EQ(refused({moving("tip", 1)}), Refused(Code::conflict, 0));
  EXPECT_EQ(refused({inGroup("tool", adding("new", 1))}), Refused(Code::conflict, 0)) << "it would not move with them";
  const double at = cart(time_);
  apply({detaching("tip")});
  tick();
  EXPECT_NEAR(placesIn(tick())["grip"], at + 0.75, 1e-6);
  EXPECT_NEAR(placesIn(*tick_->snapshot)["tip"], at + 1.0, 1e-6);
  EXPECT_FALSE(mayTouch(*tick_->snapshot, "obstacle/grip", "arm/hand"));
}

TEST_F(Obstacles, OfOneGroupMustFollowTheSameFrame) {
  apply({inGroup("rack", adding("left", 1)), inGroup("cargo", adding("box", 1, 0.1, "cart"))});
  EXPECT_EQ(refused({inGroup("rack", adding("right", 1, 0.1, "cart"))}), Refused(Code::conflict, 0));
  EXPECT_EQ(refused({inGroup("swarm", adding("a", 1, 0.1, "~poses")), inGroup("swarm", adding("b", 1, 0.1, "~poses"))}),
            Refused(Code::conflict, 1))
      << "each obstacle of ~poses has a pose of its own";
  apply({inGroup("cargo", adding("crate", 2, 0.1, "cart"))});
  apply({moving("crate", 5)});
  EXPECT_EQ(placesIn(tick())["box"], 4) << "the group follows the world frame now";
  apply({moving("box", 0.5, "cart")});
  tick();
  EXPECT_NEAR(placesIn(*tick_->snapshot)["crate"], cart(time_) + 1.5, 1e-6);
}

TEST_F(Obstacles, AMoveThatOneOfAGroupCannotMakeMovesNone) {
  apply({inGroup("rack", adding("left", 0)), inGroup("rack", adding("right", 9e5))});
  const Places before = placesIn(tick());
  EXPECT_EQ(refused({moving("post", 2), moving("left", 5e5)}), Refused(Code::out_of_range, 1));
  EXPECT_EQ(placesIn(tick()), before);
  apply({inGroup("rack", adding("third", 1))});
  std::vector<msg::Obstacle> many;  // each of them moves two other obstacles, too
  for (int i = 0; i < 2 * params().max_bodies; ++i) many.push_back(moving("left", 0));
  apply(many);
  many.push_back(moving("left", 0));
  EXPECT_EQ(refused(many), Refused(Code::limit, many.size() - 1)) << "the work of a request is bounded";
}

/// Claim: whatever happens to groups, each obstacle is where a model says that moves one rigid body for each group.
TEST_F(Obstacles, OfGroupsAreWhereAModelSaysAfterRandomChanges) {
  struct Place {
    std::string group;
    Pose pose;
  };
  std::size_t carried = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::map<std::string, Place> model;
    world_.reset();
    tick();
    for (int step = 0; step < 40; ++step) {
      const std::string name = std::string(1, static_cast<char>('a' + random.between(0, 7)));
      const std::string group = random.chance(0.3) ? "" : random.chance(0.5) ? "g" : "h";
      const double x = random.uniform(-9, 9), angle = random.uniform(-3, 3);
      Pose pose = Pose::Identity();
      pose.translation().x() = x;
      pose.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
      const bool known = model.count(name) != 0;
      if (!known || random.chance(0.2)) {
        msg::Obstacle add = turned(inGroup(group, adding(name, x)), angle);
        add.replace = add.moving = true;
        apply({add});
        model[name] = {group, pose};
      } else if (random.chance(0.2)) {
        apply({removing(name)});
        model.erase(name);
      } else {
        apply({turned(moving(name, x), angle)});
        const Pose motion = pose * model[name].pose.inverse();
        const std::string moved = model[name].group;
        for (auto& [other, place] : model) {
          if (other != name && (moved.empty() || place.group != moved)) continue;
          place.pose = motion * place.pose;
          carried += other != name ? 1 : 0;
        }
      }
      const Snapshot& snapshot = tick();
      ASSERT_EQ(placesIn(snapshot).size(), model.size() + 1) << "and the post";
      for (const auto& [other, place] : model) {
        EXPECT_TRUE(poseOf(snapshot, "obstacle/" + other).matrix().isApprox(place.pose.matrix(), 1e-9)) << other;
        for (const auto& [third, its] : model) {
          if (third == other) continue;
          const Origin origin = snapshot.structure().filter.origin(indexOf(snapshot, "obstacle/" + other),
                                                                   indexOf(snapshot, "obstacle/" + third));
          EXPECT_EQ(origin == Origin::group, place.group == its.group && !its.group.empty()) << other << third;
        }
      }
    }
  }
  EXPECT_GT(carried, 100u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
