// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// What the world holds is stored, read by a new world, and compared. The tests need no ROS master.
#include "src/node/state/stored_items.h"

#include "src/node/state/state_log.h"
#include "test/node/world/obstacle_world.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {
namespace {

const RuleClocks kClocks{PairRule::Clock::time_point(std::chrono::hours(1)),
                         std::chrono::system_clock::time_point(std::chrono::hours(500000))};

StateItems itemsOf(const ObstacleBodies& obstacles) {
  StateItems items;
  for (const auto& [name, obstacle] : obstacles.all()) applyEdits({editOf(obstacle)}, items);
  return items;
}

Shape randomShape(Random& random) {
  const auto length = [&] { return random.uniform(0.01, 2.0); };
  const auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{0, 0, 0}, {length(), 0, 0}, {0, length(), 0}, {0, 0, length()}};
  mesh->triangles = {{{0, 2, 1}}, {{0, 1, 3}}, {{0, 3, 2}}, {{1, 2, 3}}};
  switch (random.between(1, 8)) {
    case 1:
      return Shape::sphere(length());
    case 2:
      return Shape::box(Eigen::Vector3d(length(), length(), length()));
    case 3:
      return Shape::cylinder(length(), length());
    case 4:
      return Shape::cone(length(), length());
    case 5:
      return Shape::capsule(length(), length());
    case 6:
      return Shape::hull(mesh);
    case 7:
      return Shape::plane();
    default:
      return Shape::mesh(mesh);
  }
}

Pose randomPose(Random& random) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
  pose.linear() = Eigen::AngleAxisd(random.uniform(-3, 3), Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  return pose;
}

PlacedObstacle randomObstacle(Random& random, int number) {
  auto what = std::make_shared<RequestedObstacle>();
  what->body.name = "obstacle/" + std::string("ünter % box\t") + std::to_string(number);
  for (int i = random.between(1, 3); i > 0; --i) {
    what->body.shapes.push_back({randomShape(random), randomPose(random), random.uniform(0.0, 0.1),
                                 random.between(0, 1) == 0 ? "" : "package://a/b c.stl",
                                 Eigen::Vector3d(1.0, random.uniform(0.1, 2.0), 1.0)});
  }
  what->body.margin = random.uniform(0.0, 1.0);
  what->body.max_speed = random.between(0, 1) == 0 ? std::numeric_limits<double>::infinity() : random.uniform(0.1, 9.0);
  what->moving = random.between(0, 1) != 0;
  what->lost_at_end = random.between(0, 1) != 0;
  what->lifetime = std::chrono::nanoseconds(std::int64_t{random.between(0, 1)} * 123456789012345);
  what->owner = "/caller";
  PlacedObstacle obstacle;
  obstacle.what = what;
  obstacle.owner = "an owner";
  obstacle.asked = {"frame a", randomPose(random), std::nullopt};
  if (random.between(0, 1) != 0) obstacle.asked.at = Time(1234567890123456789);
  obstacle.frame = "world";
  obstacle.frame_from_body = randomPose(random);
  if (random.between(0, 1) != 0) {
    auto attachment = std::make_shared<Attachment>();
    attachment->link = "arm/hand";
    attachment->owner = "/gripper";
    attachment->without_robot = true;
    if (random.between(0, 1) != 0) attachment->link_from_body = randomPose(random);
    attachment->touch = {"arm/*", "obstacle/tray?"};
    attachment->touch_links = {"finger"};
    obstacle.attachment = attachment;
    obstacle.touch = {"arm/hand", "arm/*"};
    obstacle.carrier_speed = random.uniform(0.0, 3.0);
  }
  return obstacle;
}

TEST(StoredItems, AnObstacleIsReadAsItWasWritten) {
  const auto phase = makeFclNarrowPhase();
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE(i);
    const PlacedObstacle written = randomObstacle(random, i);
    const StateEdit edit = editOf(written);
    const StoredWorld stored = storedWorldOf({{edit.key, edit.text}}, *phase, kClocks);
    ASSERT_EQ(stored.troubles, std::vector<std::string>());
    ASSERT_EQ(stored.obstacles.size(), 1u);
    const PlacedObstacle& read = stored.obstacles.front();
    EXPECT_TRUE(isSame(*read.what, *written.what));
    EXPECT_TRUE(isSame(read.asked, written.asked));
    EXPECT_TRUE(isAtSamePlace(read, written));
    EXPECT_EQ(editOf(read).text, edit.text);
    EXPECT_EQ(read.owner, written.owner);
    EXPECT_EQ(read.touch, written.touch);
    EXPECT_TRUE(read.restored);
    EXPECT_FALSE(written.restored);
    for (const BodyShape& shape : read.what->body.shapes) EXPECT_NE(shape.solid, nullptr);
  }
}

TEST(StoredItems, TheLifetimeOfARuleGoesOnWhileTheNodeDoesNotRun) {
  const auto phase = makeFclNarrowPhase();
  PairRule forever{"obstacle/a", "robot/*", "grip"}, short_one{"obstacle/b", "robot/*", "held"};
  forever.origin = short_one.origin = Origin::service;
  forever.set_by = "/me";
  forever.since = Time(42);
  short_one.allowed = false;
  short_one.ends = kClocks.steady + std::chrono::seconds(30);
  const StateEdit edit = editOf({forever, short_one}, kClocks);
  const auto after = [&](std::chrono::seconds time) {
    // After a restart of the computer, the steady clock begins again.
    const RuleClocks later{PairRule::Clock::time_point(std::chrono::seconds(7)), kClocks.wall + time};
    return storedWorldOf({{edit.key, edit.text}}, *phase, later).rules;
  };
  const std::vector<PairRule> soon = after(std::chrono::seconds(20));
  ASSERT_EQ(soon.size(), 2u);
  EXPECT_EQ(soon[0].first, "obstacle/a");
  EXPECT_EQ(soon[0].reason, "grip");
  EXPECT_EQ(soon[0].set_by, "/me");
  EXPECT_EQ(soon[0].since, Time(42));
  EXPECT_EQ(soon[0].origin, Origin::service);
  EXPECT_EQ(soon[0].ends, PairRule::Clock::time_point::max());
  EXPECT_FALSE(soon[1].allowed);
  EXPECT_EQ(soon[1].ends, PairRule::Clock::time_point(std::chrono::seconds(17)));
  EXPECT_EQ(after(std::chrono::seconds(31)).size(), 1u);
  const std::vector<PairRule> set_back = after(std::chrono::seconds(-1000));
  ASSERT_EQ(set_back.size(), 2u);
  EXPECT_EQ(set_back[1].ends, PairRule::Clock::time_point(std::chrono::seconds(37))) << "not longer than its lifetime";
  EXPECT_EQ(editOf(std::vector<PairRule>(), kClocks).kind, StateEdit::Kind::erase);
}

TEST(StoredItems, AMapIsReadAsItWasWritten) {
  const auto phase = makeFclNarrowPhase();
  Random random(2);
  MapParams map;
  map.name = "hall";
  map.file = "hall.bt";
  map.frame = "shelf";
  map.frame_from_map = randomPose(random);
  const StateEdit loaded = editOf("hall", map), removed = editOf("old", std::nullopt);
  const StoredMaps maps = storedWorldOf({{loaded.key, loaded.text}, {removed.key, removed.text}}, *phase, kClocks).maps;
  ASSERT_EQ(maps.size(), 2u);
  EXPECT_EQ(maps.at("hall")->name, "hall");
  EXPECT_EQ(maps.at("hall")->file, "hall.bt");
  EXPECT_EQ(maps.at("hall")->frame, "shelf");
  EXPECT_EQ(maps.at("hall")->frame_from_map.matrix(), map.frame_from_map.matrix());
  EXPECT_EQ(maps.at("old"), std::nullopt);
}

TEST_F(Obstacles, AMapThatAnEarlierRunLoadedIsMissedUntilItIsReadAgainAndARemovedOneIsNot) {
  Params params = Obstacles::params();
  for (const char* name : {"hall", "yard"}) {
    params.maps.emplace_back();
    params.maps.back().name = name;
    params.maps.back().file = "room.bt";
  }
  StoredWorld stored;
  stored.maps["hall"] = std::nullopt;
  stored.maps["late"] = params.maps[0];
  World second(params, false, 2, ledger_, phase_, stored);
  second.setRobot(arm());
  const auto tick = second.tick(momentAt(time_));
  EXPECT_EQ(tick->snapshot->reasonOf("map/hall"), "");
  EXPECT_NE(tick->snapshot->reasonOf("map/yard"), "");
  EXPECT_NE(tick->snapshot->reasonOf("map/late"), "");
}

TEST(StoredItems, AnItemThatCannotBeReadIsATrouble) {
  const auto phase = makeFclNarrowPhase();
  const StoredWorld stored = storedWorldOf({{"obstacle obstacle/a", "nonsense\n"}}, *phase, kClocks);
  EXPECT_TRUE(stored.obstacles.empty());
  EXPECT_EQ(stored.troubles, std::vector<std::string>({"line 1 of the stored obstacle obstacle/a is not valid: it "
                                                       "should begin with 'obstacle'"}));
}

/// Tests with a world that changes, and a second world that begins with what was stored of the first.
class StoredObstacles : public Obstacles {
 protected:
  /// Stores what changed since the last call.
  void store() {
    const ObstacleBodies& obstacles = world_.obstacles();
    if (obstacles.unsaved().all_removed) applyEdits({{StateEdit::Kind::erase_kind, kObstacleKeys, ""}}, items_);
    for (const std::string& name : obstacles.unsaved().names) {
      const auto found = obstacles.all().find(name);
      applyEdits({found == obstacles.all().end() ? removalOf(name, name == "obstacle/post") : editOf(found->second)},
                 items_);
    }
    world_.forgetUnsaved();
  }
  std::unique_ptr<World> restarted() {
    auto world = std::make_unique<World>(params(), false, 2, ledger_, phase_, storedWorldOf(items_, *phase_, kClocks));
    world->setRobot(arm());
    world->tick(momentAt(time_));
    return world;
  }
  void expectSame() {
    store();
    const auto second = restarted();
    StateItems now = itemsOf(world_.obstacles()), then = itemsOf(second->obstacles());
    EXPECT_EQ(now, then);
  }

  StateItems items_;
};

TEST_F(StoredObstacles, AreTheSameAfterRandomChanges) {
  Random random(5);
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    std::vector<msg::Obstacle> changes;
    for (int count = random.between(1, 3); count > 0; --count) {
      const std::string name =
          random.between(0, 5) == 0 ? "post" : std::string(1, static_cast<char>('a' + random.between(0, 3)));
      switch (random.between(0, 4)) {
        case 0:
          changes.push_back(moving(name, random.uniform(-3, 3)));
          break;
        case 1:
          changes.push_back(removing(name));
          break;
        case 2:
          changes.push_back(attaching(name, "arm/hand", random.uniform(-1, 1)));
          break;
        case 3:
          changes.push_back(detaching(name));
          break;
        default:
          changes.push_back(
              adding(name, random.uniform(-3, 3), random.uniform(0.1, 0.5), random.between(0, 1) == 0 ? "" : "cart"));
          changes.back().replace = true;
      }
    }
    refused(changes);  // nothing is changed if one of them is refused
    if (random.between(0, 40) == 0) world_.reset();
    tick();
    expectSame();
  }
}

TEST_F(StoredObstacles, AreMarkedUntilAnEqualRequestOrAChangeConfirmsThem) {
  apply({adding("a", 1.0), adding("b", 2.0), adding("c", 4.0)});
  tick();
  store();
  const auto second = restarted();
  const auto note = [&](const std::string& name) {
    return bodyOf(*second->tick(momentAt(time_))->snapshot, "obstacle/" + name).note;
  };
  EXPECT_EQ(note("a").substr(0, 8), "RESTORED");
  EXPECT_EQ(note("post"), "");
  msg::ApplyObstacles::Request request;
  request.changes = {adding("a", 1.0), moving("b", 2.5)};
  second->applyObstacles(obstacleChangesOf(request, "/caller", params(), *phase_, &readFile), momentAt(time_).ros);
  EXPECT_EQ(note("a"), "");
  EXPECT_EQ(note("b"), "");
  EXPECT_EQ(note("c").substr(0, 8), "RESTORED");
}

TEST_F(StoredObstacles, ThatCannotBeRestoredMakeTheWorldIncomplete) {
  apply({adding("a", 1.0), adding("b", 2.0)});
  tick();
  store();
  items_["obstacle obstacle/b"] = "nonsense\n";
  const auto second = restarted();
  const auto tick = second->tick(momentAt(time_));
  EXPECT_NE(tick->snapshot->reasonOf("obstacle").find("line 1 of the stored obstacle obstacle/b is not valid"),
            std::string::npos)
      << tick->snapshot->reasonOf("obstacle");
  EXPECT_EQ(second->obstacles().all().count("obstacle/a"), 1u);
  second->reset();
  EXPECT_EQ(second->tick(momentAt(time_))->snapshot->reasonOf("obstacle"), "");
}

TEST_F(StoredObstacles, BeginTheirLifetimeAgain) {
  msg::Obstacle short_lived = adding("a", 1.0);
  short_lived.lifetime = ros::Duration(10.0);
  apply({short_lived});
  tick();
  store();
  const auto second = restarted();
  second->tick(momentAt(time_ + 9.0));
  EXPECT_EQ(second->obstacles().all().count("obstacle/a"), 1u);
  second->tick(momentAt(time_ + 10.1));
  EXPECT_EQ(second->obstacles().all().count("obstacle/a"), 0u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
