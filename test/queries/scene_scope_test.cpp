// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/queries/query.h"
#include "test/support/maps.h"
#include "test/support/refusals.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::Random;
using test::says;

const SourceGap kLostCamera{"cloud/front", "cloud/front", "LOST cloud/front: its newest points are 3 s old"};
const SourceGap kNoRobot{"left", "left/*", "NOT_READY robot 'left': its description was not read yet"};
const Sphere kPlace{{50, 0, 0}, 0.5};

Body linkOf(const std::string& robot, const std::string& name, double max_speed) {
  Body body = test::ball(name);
  body.name = robot + "/" + name;
  body.kind = BodyKind::link;
  body.robot = robot;
  body.max_speed = max_speed;
  return body;
}

QueryScope scopeOf(const std::vector<std::string>& include, const std::vector<std::string>& exclude = {}) {
  QueryScope scope;
  scope.include = include;
  scope.exclude = exclude;
  return scope;
}

/// A world with a robot and an obstacle. The links of the robot are FRESH.
struct Cell {
  Cell() : scene(SceneOptions{}) {
    link = test::put(scene, linkOf("robot", "tool", 0.5), test::at(0));
    test::put(scene, linkOf("robot", "arm", 0.5), test::at(2));
    test::put(scene, test::ball("table", 0.5, Mobility::fixed), test::at(-5));
  }
  const Snapshot& now(const std::vector<SourceGap>& gaps = {}) {
    snapshot = scene.commit(Time{++tick}, gaps);
    return *snapshot;
  }
  Scene scene;
  BodyId link;
  std::shared_ptr<const Snapshot> snapshot;
  int tick = 0;
};

TEST(Scope, ALostCameraLeavesQuestionsAboutTheRobotClear) {
  Cell cell;
  const Snapshot& snapshot = cell.now({kLostCamera});
  EXPECT_FALSE(snapshot.complete());
  EXPECT_EQ(snapshot.incompleteSources(), std::vector<std::string>({"cloud/front"}));
  EXPECT_EQ(snapshot.reasonOf("cloud/front"), kLostCamera.sentence);
  EXPECT_EQ(snapshot.reasonOf("robot"), "");
  for (const auto& scope : {scopeOf({"robot/*"}), scopeOf({"robot/*", "obstacle/*"}), scopeOf({}, {"cloud/*"}),
                            scopeOf({"*"}, {"cloud/f*"}), scopeOf({}, {"cloud/front"})}) {
    EXPECT_EQ(query(snapshot, kPlace, scope).verdict, Verdict::clear);
  }
  for (const auto& scope : {scopeOf({}), scopeOf({"*"}), scopeOf({"cloud/*"}), scopeOf({}, {"cloud/rear"}),
                            scopeOf({}, {"cloud/*rear"}), scopeOf({"robot/*", "*front"})}) {
    const QueryAnswer answer = query(snapshot, kPlace, scope);
    EXPECT_EQ(answer.verdict, Verdict::unknown);
    EXPECT_EQ(answer.because, Unknown::incomplete);
    EXPECT_TRUE(says(answer.reason, kLostCamera.sentence));
  }
}

TEST(Scope, ARobotWithoutAModelMakesUnknownWhatCanBeOneOfItsLinks) {
  Cell cell;
  const Snapshot& snapshot = cell.now({kNoRobot});
  for (const auto& scope : {scopeOf({"robot/*"}), scopeOf({}, {"left/*"}), scopeOf({}, {"l*"}), scopeOf({"rob*t/*"})}) {
    EXPECT_EQ(query(snapshot, kPlace, scope).verdict, Verdict::clear);
  }
  for (const auto& scope : {scopeOf({}), scopeOf({"*/tool"}), scopeOf({"left/gripper"}), scopeOf({}, {"left/gripper"}),
                            scopeOf({}, {"left/*a"})}) {
    EXPECT_EQ(query(snapshot, kPlace, scope).verdict, Verdict::unknown);
  }
}

TEST(Scope, ALostBodyMakesUnknownOnlyWhatItCanHaveReached) {
  Cell cell;
  cell.scene.setState(cell.link, Freshness::lost, 10.0);  // at 0.5 m/s, the link has moved by at most 5 m
  const Snapshot& snapshot = cell.now();
  EXPECT_EQ(snapshot.incompleteSources(), std::vector<std::string>({"robot"}));
  EXPECT_EQ(snapshot.poses()[test::indexOf(snapshot, "robot/tool")].reach, 5.0);
  EXPECT_EQ(snapshot.poses()[test::indexOf(snapshot, "robot/tool")].growth, 1.0)
      << "the growth of margins must stay within the cap";
  const QueryAnswer near = query(snapshot, Sphere{{0, 5.9, 0}, 0.5}, {});
  EXPECT_EQ(near.verdict, Verdict::unknown);
  EXPECT_EQ(near.because, Unknown::stale_body);
  EXPECT_TRUE(says(near.reason, "LOST robot/tool"));
  EXPECT_EQ(query(snapshot, Sphere{{0, 6.1, 0}, 0.5}, {}).verdict, Verdict::clear);
  EXPECT_EQ(query(snapshot, Sphere{{0, 5.9, 0}, 0.5}, scopeOf({"robot/arm", "obstacle/*"})).verdict, Verdict::clear);
  EXPECT_EQ(query(snapshot, Segment{{-9, 5.9, 0}, {9, 5.9, 0}, 0.5}, {}).verdict, Verdict::unknown);
  EXPECT_EQ(query(snapshot, Segment{{-9, 6.1, 0}, {9, 6.1, 0}, 0.5}, {}).verdict, Verdict::clear);
  EXPECT_EQ(nearest(snapshot, Eigen::Vector3d(0, 5.9, 0), 0.5, {}).verdict, Verdict::unknown);
  EXPECT_EQ(nearest(snapshot, Eigen::Vector3d(0, 6.1, 0), 0.5, {}).verdict, Verdict::clear);
}

TEST(Scope, ABodyWithAnOldPoseCanHaveMovedAlthoughItIsFreshAndMarginsDoNotGrow) {
  SceneOptions options;
  options.growth_cap = 0.0;
  options.growth_after = 0.25;
  Scene scene(options);
  const BodyId link = test::put(scene, linkOf("robot", "tool", 1.0), test::at(0));
  scene.setState(link, Freshness::fresh, 2.0);
  const auto snapshot = scene.commit(Time{1}, {});
  EXPECT_FALSE(snapshot->complete()) << "pairs that the body can have now are not listed";
  EXPECT_EQ(query(*snapshot, Sphere{{2.0, 0, 0}, 0.5}, {}).verdict, Verdict::unknown)
      << "the body can have come 2 m nearer";
  EXPECT_EQ(query(*snapshot, Sphere{{9.0, 0, 0}, 0.5}, {}).verdict, Verdict::clear);
}

/// Claim: links of one robot whose joint states stopped may have moved against each other, except those of one rigid
/// group, and except while their poses are not stale.
TEST(Scope, StaleLinksOfOneRobotMayHaveMovedAgainstEachOther) {
  Scene scene(SceneOptions{});
  std::vector<BodyId> links;
  for (std::uint32_t i = 0; i < 3; ++i) {
    Body link = linkOf("robot", std::to_string(i), 0.5);
    link.rigid_group = i / 2;  // links 0 and 1 are of one group
    links.push_back(test::put(scene, link, test::at(3.0 * i)));
  }
  const auto verdict = [&](Freshness state, double age, const std::string& other) {
    for (const BodyId id : links) scene.setState(id, state, age, 7);
    const auto snapshot = scene.commit(Time{1}, {});
    return nearest(*snapshot, snapshot->structure().find("robot/1"), 0.5, scopeOf({other})).verdict;
  };
  EXPECT_EQ(verdict(Freshness::late, 0.2, "robot/2"), Verdict::clear) << "the poses are not that old";
  EXPECT_EQ(verdict(Freshness::fresh, 5.0, "robot/2"), Verdict::unknown) << "a slow frame is FRESH for longer";
  EXPECT_EQ(verdict(Freshness::stale, 1.0, "robot/2"), Verdict::clear) << "each of them may have moved 0.5 m";
  EXPECT_EQ(verdict(Freshness::stale, 2.0, "robot/2"), Verdict::unknown);
  EXPECT_EQ(verdict(Freshness::lost, 3600.0, "robot/2"), Verdict::unknown);
  EXPECT_EQ(verdict(Freshness::stale, 5.0, "robot/0"), Verdict::clear) << "a rigid group does not bend";
}

TEST(Scope, ABodyWhoseNewestDataContradictsItsPoseCanBeAnywhere) {
  for (const Freshness state : {Freshness::frozen, Freshness::invalid}) {
    SCOPED_TRACE(name(state));
    Cell cell;
    cell.scene.setState(cell.link, state, 0.01);
    const QueryAnswer answer = query(cell.now(), kPlace, {});
    EXPECT_EQ(answer.verdict, Verdict::unknown);
    EXPECT_EQ(answer.because, Unknown::incomplete);
    EXPECT_EQ(query(*cell.snapshot, kPlace, scopeOf({"robot/arm"})).verdict, Verdict::clear);
  }
}

TEST(Scope, WhatIsNearALostBodyIsUnknownAsFarAsTheBodyCanHaveMoved) {
  Cell cell;
  cell.scene.setState(cell.link, Freshness::lost, 6.0);  // the link may have moved by 3 m; the table is 4 m away
  const std::uint32_t tool = test::indexOf(cell.now(), "robot/tool");
  EXPECT_EQ(nearest(*cell.snapshot, tool, 0.9, scopeOf({"obstacle/*"})).verdict, Verdict::clear);
  const QueryAnswer answer = nearest(*cell.snapshot, tool, 1.1, scopeOf({"obstacle/*"}));
  EXPECT_EQ(answer.verdict, Verdict::unknown);
  EXPECT_TRUE(says(answer.reason, "robot/tool"));
}

TEST(Scope, ALostCameraWithARangeHidesNothingBeyondIt) {
  Cell cell;
  SourceGap camera = kLostCamera;
  camera.within = Sphere{{40, 0, 0}, 5.0};
  const Snapshot& snapshot = cell.now({camera});
  EXPECT_FALSE(snapshot.complete());
  for (const double x : {44.0, 45.4}) {
    EXPECT_EQ(query(snapshot, Sphere{{x, 0, 0}, 0.5}, {}).verdict, Verdict::unknown) << x;
    EXPECT_EQ(query(snapshot, Segment{{x, -9, 0}, {x, 9, 0}, 0.5}, {}).verdict, Verdict::unknown) << x;
    EXPECT_EQ(nearest(snapshot, Eigen::Vector3d(x, 0, 0), 0.5, {}).verdict, Verdict::unknown) << x;
  }
  EXPECT_EQ(query(snapshot, Sphere{{45.6, 0, 0}, 0.5}, {}).verdict, Verdict::clear);
  EXPECT_EQ(query(snapshot, Segment{{45.6, -9, 0}, {45.6, 9, 0}, 0.5}, {}).verdict, Verdict::clear);
  EXPECT_EQ(nearest(snapshot, Eigen::Vector3d(45.6, 0, 0), 0.5, {}).verdict, Verdict::clear);
}

TEST(Scope, ALostCloudWithoutAGapOfItsOwnHidesAnything) {
  Cell cell;
  Body body = test::mapBody("front", Mobility::moving);
  body.name = "cloud/front";
  body.kind = BodyKind::cloud;
  const BodyId cloud = test::put(cell.scene, body, test::at(0));
  cell.scene.setState(cloud, Freshness::lost, 0.01);
  EXPECT_EQ(query(cell.now(), kPlace, {}).verdict, Verdict::unknown);
  EXPECT_EQ(query(*cell.snapshot, kPlace, scopeOf({"robot/*"})).verdict, Verdict::clear);
  SourceGap gap = kLostCamera;
  gap.within = Sphere{{0, 0, 0}, 5.0};
  EXPECT_EQ(query(cell.now({gap}), kPlace, {}).verdict, Verdict::clear);
  EXPECT_EQ(cell.snapshot->reasonsTotal(), 1u) << "a lost cloud must be counted only once";
}

TEST(Scope, AMapOrACloudCannotBeAskedFrom) {
  Cell cell;
  test::put(cell.scene, test::mapBody("room"), test::at(0));
  Body cloud = test::mapBody("front", Mobility::moving);
  cloud.name = "cloud/front";
  cloud.kind = BodyKind::cloud;
  test::put(cell.scene, cloud, test::at(0));
  const Snapshot& snapshot = cell.now();
  std::string sentence;
  const auto ask = [&](const char* name) {
    return test::refusalOf([&] { nearest(snapshot, test::indexOf(snapshot, name), 1.0, {}); }, &sentence);
  };
  EXPECT_EQ(ask("map/room"), Code::unsupported);
  EXPECT_EQ(sentence, "'map/room' is a map; ask from a link or an obstacle");
  EXPECT_EQ(ask("cloud/front"), Code::unsupported);
  EXPECT_EQ(sentence, "'cloud/front' is a cloud; ask from a link or an obstacle");
}

TEST(Scope, ARequiredBodyThatIsNotThereMakesItsSourceIncomplete) {
  SceneOptions options;
  options.required = {"map/hall", "robot/tool*", "obstacle/*"};
  Scene scene(options);
  const BodyId tool = test::put(scene, linkOf("robot", "tool0", 0.5), test::at(0));
  test::put(scene, test::ball("table", 0.5, Mobility::fixed), test::at(-5));
  auto snapshot = scene.commit(Time{1}, {});
  EXPECT_EQ(snapshot->incompleteSources(), std::vector<std::string>({"map/hall"}));
  EXPECT_TRUE(says(snapshot->reasons().at(0), "REQUIRED 'map/hall'"));
  EXPECT_EQ(query(*snapshot, kPlace, {}).verdict, Verdict::unknown);
  EXPECT_EQ(query(*snapshot, kPlace, scopeOf({"robot/*"})).verdict, Verdict::clear);
  const BodyId map = test::put(scene, test::mapBody("hall"), test::at(0));
  scene.setCells(map, test::cellsOf(0.1, {}));
  EXPECT_TRUE(scene.commit(Time{2}, {})->complete());
  scene.remove(tool);
  snapshot = scene.commit(Time{3}, {});
  EXPECT_EQ(snapshot->incompleteSources(), std::vector<std::string>({"robot"}));
  EXPECT_EQ(query(*snapshot, kPlace, {}).verdict, Verdict::unknown);
  EXPECT_EQ(query(*snapshot, kPlace, scopeOf({"obstacle/*"})).verdict, Verdict::clear);
}

TEST(Scope, AnUncoveredBodyCountsOnlyWhereItIsAskedAbout) {
  Cell cell;
  Body broken = linkOf("robot", "broken", 0.5);
  broken.covered = false;
  broken.note = "mesh 'x.stl' is missing";
  test::put(cell.scene, broken, test::at(0));
  EXPECT_EQ(query(cell.now(), kPlace, {}).because, Unknown::incomplete);
  EXPECT_EQ(query(*cell.snapshot, kPlace, scopeOf({"robot/tool"})).verdict, Verdict::clear);
  EXPECT_EQ(
      nearest(*cell.snapshot, test::indexOf(*cell.snapshot, "robot/broken"), 0.1, scopeOf({"obstacle/*"})).verdict,
      Verdict::unknown)
      << "a body of unknown extent may be near to anything";
}

/// A random world in which some sources are incomplete. The test looks at every body and every incomplete source to
/// decide whether a query may answer CLEAR. It compares this with the answer of the query.
class RandomScopes {
 public:
  explicit RandomScopes(std::uint64_t seed) : random_(seed), scene_(SceneOptions{}) {
    for (int i = random_.between(1, 8); i > 0; --i) addBody(i);
    for (const SourceGap& gap : {kLostCamera, kNoRobot}) {
      if (!random_.chance(0.3)) continue;
      gaps_.push_back(gap);
      if (random_.chance(0.5)) gaps_.back().within = Sphere{somewhere(), random_.uniform(0, 5)};
    }
    snapshot_ = scene_.commit(Time{1}, gaps_);
  }

  void expectRight() {
    static const std::vector<std::vector<std::string>> globs = {
        {}, {"*"}, {"robot/*"}, {"left/*", "obstacle/*"}, {"cloud/*"}, {"*/1"}, {"obstacle/*"}};
    const QueryScope scope = scopeOf(globs[std::size_t(random_.below(7))], globs[std::size_t(random_.below(7))]);
    const Eigen::Vector3d from = somewhere(), to = random_.chance(0.5) ? from : somewhere();
    const double radius = random_.uniform(0, 2);
    const QueryAnswer answer = from == to ? query(*snapshot_, Sphere{from, radius}, scope)
                                          : query(*snapshot_, Segment{from, to, radius}, scope);
    if (answer.verdict == Verdict::hit) return;
    bool surely = false, perhaps = false;  // whether the verdict must be UNKNOWN; whether it may be UNKNOWN
    for (std::uint32_t i = 0; i < snapshot_->poses().size(); ++i)
      judgeBody(i, scope, from, to, radius, surely, perhaps);
    for (const SourceGap& gap : gaps_) judgeGap(gap, scope, from, to, radius, surely, perhaps);
    (answer.verdict == Verdict::clear ? clear : unknown) += 1;
    if (answer.verdict == Verdict::clear) {
      ASSERT_FALSE(surely);
    } else {
      ASSERT_TRUE(perhaps) << answer.reason;
    }
  }

  static int clear, unknown;

 private:
  Eigen::Vector3d somewhere() { return {random_.uniform(-10, 10), random_.uniform(-10, 10), random_.uniform(-10, 10)}; }
  void addBody(int number) {
    const std::string name = std::to_string(number);
    Body body = random_.chance(0.5) ? linkOf("robot", name, random_.uniform(0, 2)) : test::ball(name);
    body.max_speed = random_.chance(0.1) ? std::numeric_limits<double>::infinity() : random_.uniform(0, 2);
    body.covered = !random_.chance(0.05);
    body.waived = random_.chance(0.5);
    if (random_.chance(0.05)) {
      scene_.add(body);
      return;
    }
    const BodyId id = test::put(scene_, body, test::at(random_.uniform(-10, 10), random_.uniform(-10, 10)));
    const Freshness states[] = {Freshness::fresh, Freshness::late,   Freshness::stale,
                                Freshness::lost,  Freshness::frozen, Freshness::invalid};
    if (random_.chance(0.4)) scene_.setState(id, states[random_.below(6)], random_.uniform(0, 5));
  }
  static bool isMeant(const QueryScope& scope, const std::string& name) {
    return (scope.include.empty() || matchesAny(scope.include, name)) && !matchesAny(scope.exclude, name);
  }
  void judgeBody(std::uint32_t i, const QueryScope& scope, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                 double radius, bool& surely, bool& perhaps) const {
    const Body& body = snapshot_->structure().bodies[i];
    const BodyPose& pose = snapshot_->poses()[i];
    if (!isMeant(scope, body.name)) return;
    const bool anywhere = (!body.covered && !body.waived) || pose.state == Freshness::unplaced ||
                          pose.state == Freshness::frozen || pose.state == Freshness::invalid;
    const bool old = pose.state >= Freshness::stale || pose.age > SceneOptions().growth_after;
    const double reach = old && pose.age > 0.0 ? body.max_speed * pose.age : 0.0;
    const Aabb& box = snapshot_->boxes()[snapshot_->structure().first_proxy[i]];
    const double distance = anywhere ? 0.0 : double(test::approachOf(box, from, to, radius).least) - radius;
    const bool moved = reach > 0.0;
    surely = surely || anywhere || (moved && distance < reach - 1e-6);
    perhaps = perhaps || anywhere || (moved && distance < reach + 1e-6);
  }
  static bool coversAny(const std::vector<std::string>& globs, const std::string& bodies) {
    return std::any_of(globs.begin(), globs.end(), [&](const std::string& glob) { return coversGlob(glob, bodies); });
  }
  static void judgeGap(const SourceGap& gap, const QueryScope& scope, const Eigen::Vector3d& from,
                       const Eigen::Vector3d& to, double radius, bool& surely, bool& perhaps) {
    // These names are enough, because for the globs of this test all other names are like one of them.
    bool meant = false, included = false;
    for (const char* name : {"cloud/front", "left/1", "left/2", "left/long"}) {
      if (!matches(gap.bodies, name)) continue;
      meant = meant || isMeant(scope, name);
      included = included || isMeant(scopeOf(scope.include), name);
    }
    if (!included || (!meant && coversAny(scope.exclude, gap.bodies))) return;
    const Eigen::Vector3d way = to - from;
    double distance = -1.0;
    if (gap.within) {
      double least = std::numeric_limits<double>::infinity();
      for (int k = 0; k <= 2000; ++k) least = std::min(least, (from + k / 2000.0 * way - gap.within->center).norm());
      distance = least - radius - gap.within->radius;
    }
    surely = surely || (meant && distance < -0.02);
    perhaps = perhaps || distance < 0.02;
  }

  Random random_;
  Scene scene_;
  std::vector<SourceGap> gaps_;
  std::shared_ptr<const Snapshot> snapshot_;
};
int RandomScopes::clear = 0;
int RandomScopes::unknown = 0;

TEST(Scope, ClearIsAnsweredExactlyWhereNothingAskedAboutCanBe) {
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomScopes world(seed);
    for (int i = 0; i < 10; ++i) world.expectRight();
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(RandomScopes::clear, 3000);
  EXPECT_GT(RandomScopes::unknown, 3000);
}

}  // namespace
}  // namespace hgrid
