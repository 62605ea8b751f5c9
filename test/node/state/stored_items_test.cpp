// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// What the world holds is stored, read by a new world, and compared. The tests need no ROS master.
#include "src/node/state/stored_items.h"

#include "src/node/moveit/scene_gaps.h"
#include "src/node/state/state_log.h"
#include "test/node/support/settings.h"
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
  what->body.group = random.between(0, 1) == 0 ? "" : "a group";
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
  const auto phase = makeCoreNarrowPhase();
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
  const auto phase = makeCoreNarrowPhase();
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
  const auto phase = makeCoreNarrowPhase();
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

TEST(StoredItems, RobotsKeepTheirDescriptionsFramesAndAbsence) {
  const auto phase = makeCoreNarrowPhase();
  const auto text = std::make_shared<const RobotDescription>(RobotDescription{"<robot %\n\"ä\"/>", "<robot/>"});
  StoredRobot told, like, named;
  told.spec.params = {"told", "", "", ""};
  told.spec.text = like.spec.text = text;
  told.absent = true;
  like.spec.params = {"like", "", "", "like"};
  named.spec.params = {"named", "/cell/description", "/cell/semantic", "a prefix"};
  StateItems items;
  applyEdits({editOfRobot("told", told), editOfRobot("like", like), editOfRobot("named", named),
              editOfRobot("gone", std::nullopt), editOf(*text)},
             items);
  EXPECT_EQ(items.size(), 5u) << "the text is stored once";
  const StoredWorld stored = storedWorldOf(items, *phase, kClocks);
  EXPECT_TRUE(stored.troubles.empty());
  ASSERT_EQ(stored.robots.size(), 4u);
  EXPECT_FALSE(stored.robots.at("gone").has_value());
  for (const auto& [name, robot] : {std::pair("told", &told), std::pair("like", &like), std::pair("named", &named)}) {
    const std::optional<StoredRobot>& read = stored.robots.at(name);
    ASSERT_TRUE(read.has_value()) << name;
    EXPECT_EQ(read->spec.params.name, name);
    EXPECT_EQ(read->absent, robot->absent) << name;
    EXPECT_TRUE(isSame(read->spec, robot->spec)) << name;
  }
  EXPECT_EQ(stored.robots.at("told")->spec.text, stored.robots.at("like")->spec.text) << "they share the text again";
  applyEdits({removalOf(*text)}, items);
  const StoredWorld torn = storedWorldOf(items, *phase, kClocks);
  EXPECT_EQ(torn.troubles.size(), 2u);
  EXPECT_EQ(torn.robots.size(), 2u);
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
  World second(settingsOf(params), false, 2, ledger_, phase_, stored);
  second.setRobot(std::make_shared<const LoadedRobot>(arm()));
  const auto tick = second.tick(momentAt(time_));
  EXPECT_EQ(tick->snapshot->reasonOf("map/hall"), "");
  EXPECT_NE(tick->snapshot->reasonOf("map/yard"), "");
  EXPECT_NE(tick->snapshot->reasonOf("map/late"), "");
}

TEST(StoredItems, AnItemThatCannotBeReadIsATrouble) {
  const auto phase = makeCoreNarrowPhase();
  const StoredWorld stored = storedWorldOf({{"obstacle obstacle/a", "nonsense\n"}}, *phase, kClocks);
  EXPECT_TRUE(stored.obstacles.empty());
  EXPECT_EQ(stored.troubles, std::vector<std::string>({"line 1 of the stored obstacle obstacle/a is not valid: it "
                                                       "should begin with 'obstacle'"}));
}

TEST(StoredItems, RulesAreReadTogetherOrNotAtAll) {
  const auto phase = makeCoreNarrowPhase();
  StateEdit edit = editOf({{"obstacle/a", "robot/*", "grip"}, {"obstacle/b", "robot/*", "held"}}, kClocks);
  edit.text.resize(edit.text.rfind("rule"));
  const StoredWorld stored = storedWorldOf({{edit.key, edit.text}}, *phase, kClocks);
  EXPECT_EQ(stored.rules.size(), 0u) << "a rule can be an exception from the rule before it";
  EXPECT_EQ(stored.troubles.size(), 1u);
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
  std::unique_ptr<World> restarted() { return restarted(params()); }
  std::unique_ptr<World> restarted(const Params& params) {
    auto world =
        std::make_unique<World>(settingsOf(params), false, 2, ledger_, phase_, storedWorldOf(items_, *phase_, kClocks));
    world->setRobot(std::make_shared<const LoadedRobot>(arm()));
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

TEST_F(StoredObstacles, ThatCannotBeRestoredStayMissingWhateverMoveItAndTheObstacleNamedStarSay) {
  items_["obstacle obstacle/b"] = "nonsense\n";
  const auto second = restarted();
  const auto reason = [&] { return second->tick(momentAt(time_))->snapshot->reasonOf("obstacle"); };
  SceneGaps gaps;
  showGaps(gaps, *second);
  EXPECT_NE(reason(), "") << "MoveIt lacks nothing, but the stored obstacle is still not there";
  msg::ApplyObstacles::Request request;
  request.changes = {adding("*", 1.0)};
  second->applyObstacles(obstacleChangesOf(request, "/caller", params(), *phase_, &readFile), momentAt(time_).ros);
  EXPECT_NE(reason(), "") << "'*' is the name of an obstacle, too";
  gaps.noteRefused({{"obstacle/c", SceneGaps::Lack::shapes}}, "why");
  showGaps(gaps, *second);
  second->reset();
  EXPECT_EQ(reason(), "");
}

TEST_F(StoredObstacles, AreWhereTheyWereIfTheWorldFrameIsAnother) {
  apply({adding("a", 1.0)});
  tick();
  store();
  Params params = Obstacles::params();
  params.world_frame = "cart";
  const auto second = restarted(params);
  const auto ask = [&](bool replace) {
    msg::ApplyObstacles::Request request;
    request.changes = {adding("a", 1.0)};
    request.changes[0].replace = replace;
    second->applyObstacles(obstacleChangesOf(request, "/caller", params, *phase_, &readFile), momentAt(time_).ros);
  };
  EXPECT_EQ(second->obstacles().all().at("obstacle/a").frame, "world");
  EXPECT_THROW(ask(false), Refusal) << "the same numbers are another place now";
  EXPECT_EQ(second->obstacles().all().at("obstacle/a").asked.frame, "world") << "~save_scene writes it";
  ask(true);
  EXPECT_EQ(second->obstacles().all().at("obstacle/a").frame, "cart");
}

TEST_F(StoredObstacles, ThatWereLostAreLostAgain) {
  msg::Obstacle seen = adding("seen", 1.0), unseen = adding("unseen", 1.0, 0.1, "never_there");
  seen.lifetime = unseen.lifetime = ros::Duration(0.1);
  seen.lifetime_end = unseen.lifetime_end = msg::LifetimeEnd::LOST;
  apply({seen, unseen});
  tick();
  store();
  tick();
  ASSERT_TRUE(world_.obstacles().all().at("obstacle/seen").lost);
  store();
  auto world =
      std::make_unique<World>(settingsOf(params()), false, 2, ledger_, phase_, storedWorldOf(items_, *phase_, kClocks));
  world->setRobot(std::make_shared<const LoadedRobot>(arm()));
  const auto pose = [&](const std::string& name, double later) {
    const auto tick = world->tick(momentAt(time_ + later));
    return tick->snapshot->poses()[indexOf(*tick->snapshot, "obstacle/" + name)];
  };
  EXPECT_EQ(pose("seen", 0.0).state, Freshness::lost) << "from the first tick on";
  EXPECT_EQ(pose("seen", 0.0).world_from_body.translation().x(), 1.0);
  EXPECT_EQ(pose("unseen", 0.0).state, Freshness::unplaced);
  EXPECT_DOUBLE_EQ(pose("seen", 4.0).age, 4.0);
  msg::ApplyObstacles::Request request;
  request.changes = {adding("seen", 1.0)};
  request.changes[0].replace = true;
  world->applyObstacles(obstacleChangesOf(request, "/caller", params(), *phase_, &readFile), momentAt(time_ + 4.0).ros);
  EXPECT_EQ(pose("seen", 4.0).state, Freshness::fresh);
}

TEST_F(StoredObstacles, HaveTheSpeedBoundsOfTheParameters) {
  apply({adding("a", 1.0)});
  tick();
  store();
  Params params = Obstacles::params();
  params.max_speed = {{"obstacle/*", 2.0}};
  const auto second = restarted(params);
  EXPECT_EQ(bodyOf(*second->tick(momentAt(time_))->snapshot, "obstacle/a").speed_bound, 2.0);
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
