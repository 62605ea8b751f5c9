// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include "hgrid_proximity/queries/query.h"
#include "test/support/models.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

/// Two spheres whose boxes are 1 m apart, up to a rounding error. The margin is 1/8 m.
class Growth : public ::testing::Test {
 protected:
  Growth() : scene_(optionsWithCap(2.0)) {}

  static SceneOptions optionsWithCap(double cap) {
    SceneOptions options;
    options.margin = 0.125;
    options.growth_cap = cap;
    return options;
  }
  static Body slowBall(const std::string& name, double max_speed) {
    Body body = test::ball(name);
    body.max_speed = max_speed;
    return body;
  }
  const Snapshot& now() {
    snapshot_ = scene_.commit(Time{++tick_}, {});
    return *snapshot_;
  }

  Scene scene_;
  std::shared_ptr<const Snapshot> snapshot_;
  int tick_ = 0;
};

/// A source whose poses are always old before the next one comes would begin and end the same pair with each pose.
TEST_F(Growth, OfABodyWhosePosesComeRarelyDoesNotComeAndGo) {
  const BodyId id = test::put(scene_, slowBall("a", 2.0), test::at(0));
  test::put(scene_, slowBall("b", 2.0), test::at(2.0));  // the two boxes are 1 m apart
  for (const double age : {0.0, 0.125, 0.25, 0.375, 0.5, 0.0, 0.25, 0.5}) {
    scene_.setState(id, Freshness::fresh, age, 0, 0.5);
    EXPECT_EQ(now().poses()[0].growth, 1.0) << "the reach after one period";
    EXPECT_EQ(snapshot_->poses()[0].reach, age > 0.25 ? 2.0 * age : 0.0) << "queries widen only by the age";
    EXPECT_EQ(snapshot_->pairs().size(), 1u);
    EXPECT_EQ(snapshot_->events().size(), snapshot_->sequence() == 1 ? 1u : 0u);
  }
  scene_.setState(id, Freshness::stale, 0.75, 0, 0.5);
  EXPECT_EQ(now().poses()[0].growth, 1.5) << "the source is late";
  scene_.setState(id, Freshness::fresh, 0.0, 0, 0.25);
  EXPECT_EQ(now().poses()[0].growth, 0.0) << "the next pose comes before this one is old";
  scene_.setState(id, Freshness::fresh, 0.0, 0, 5.0);
  EXPECT_EQ(now().poses()[0].growth, 2.0) << "the growth cap";
}

TEST_F(Growth, BeginsWhenThePoseIsOldWhateverTheStateIsCalled) {
  const BodyId id = test::put(scene_, slowBall("a", 2.0), test::at(0));
  test::put(scene_, slowBall("b", 2.0), test::at(1.75));  // the two boxes are 0.75 m apart
  scene_.setState(id, Freshness::fresh, 0.25);
  EXPECT_EQ(now().poses()[0].growth, 0.0);
  EXPECT_TRUE(snapshot_->pairs().empty());
  // The pose of body a is old. But its state is not STALE, because its frame is published rarely.
  for (const Freshness state : {Freshness::fresh, Freshness::late}) {
    scene_.setState(id, state, 0.375);
    EXPECT_EQ(now().poses()[0].growth, 0.75);
    ASSERT_EQ(snapshot_->pairs().size(), 1u);
    ASSERT_EQ(snapshot_->events().size(), state == Freshness::fresh ? 1u : 0u);
    if (state == Freshness::fresh) {
      EXPECT_EQ(snapshot_->events()[0].cause, EventCause::staleness);
    }
  }
  EXPECT_NE(query(*snapshot_, Sphere{Eigen::Vector3d(-1.0, 0.0, 0.0), 0.1}, {}).verdict, Verdict::clear);
  scene_.setState(id, Freshness::fresh, 0.0);
  EXPECT_TRUE(now().pairs().empty());
  ASSERT_EQ(snapshot_->events().size(), 1u);
  EXPECT_EQ(snapshot_->events()[0].cause, EventCause::staleness);
}

TEST_F(Growth, WidensTheMarginBySpeedTimesAgeUpToTheCap) {
  const BodyId id = test::put(scene_, slowBall("a", 0.5), test::at(0));
  test::put(scene_, slowBall("b", 0.5), test::at(2));
  for (const double age : {0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 100.0}) {
    scene_.setState(id, Freshness::stale, age);
    const double growth = std::min(2.0, 0.5 * age);
    const Snapshot& snapshot = now();
    EXPECT_EQ(snapshot.poses()[0].growth, growth);
    EXPECT_EQ(snapshot.poses()[1].growth, 0.0);
    ASSERT_EQ(snapshot.pairs().size(), growth + 0.125 >= 1.0 ? 1u : 0u) << age;
    if (snapshot.pairs().empty()) continue;
    EXPECT_EQ(snapshot.pairs()[0].margin, 0.125 + growth);
    EXPECT_NEAR(snapshot.pairs()[0].gap, 1.0, 1e-6) << "the growth must not change the gap";
  }
}

TEST_F(Growth, OfBothBodiesAddsUp) {
  const BodyId a = test::put(scene_, slowBall("a", 0.5), test::at(0)),
               b = test::put(scene_, slowBall("b", 0.25), test::at(2));
  scene_.setState(a, Freshness::stale, 1.25);
  scene_.setState(b, Freshness::lost, 1.25);
  ASSERT_EQ(now().pairs().size(), 1u) << "the margin of 1/8 m + 5/8 m + 5/16 m exceeds the gap of 1 m";
  EXPECT_EQ(snapshot_->pairs()[0].margin, 0.125 + 0.625 + 0.3125);
  scene_.setState(b, Freshness::late, 0.125);
  EXPECT_TRUE(now().pairs().empty()) << "the state LATE alone must not cause growth";
}

TEST_F(Growth, WithoutASpeedLimitGoesToTheCapAtOnce) {
  const BodyId id = test::put(scene_, test::ball("a"), test::at(0));
  scene_.setState(id, Freshness::stale, 1e-6);
  EXPECT_EQ(now().poses()[0].growth, 2.0);
  scene_.setState(id, Freshness::stale, 0.0);
  EXPECT_EQ(now().poses()[0].growth, 0.0) << "infinite speed times age 0 must give 0, not NaN";
  scene_.setState(id, Freshness::lost, 1e300);
  EXPECT_EQ(now().poses()[0].growth, 2.0);
}

/// Claim: where queries say that a body may be farther away than margins grow, the source is incomplete, too.
TEST_F(Growth, LeavesTheSourceIncompleteWhereItIsNotEnough) {
  const BodyId id = test::put(scene_, slowBall("a", 1.0), test::at(0));
  for (const double age : {0.5, 1.9, 2.1, 60.0}) {
    SCOPED_TRACE(age);
    scene_.setState(id, Freshness::stale, age);
    EXPECT_EQ(now().incompleteSources().empty(), age < 2.0) << "the margin grows by at most 2 m";
    if (age < 2.0) continue;
    EXPECT_NE(snapshot_->reasonOf("obstacle").find("it may have moved " + text(age) + " m"), std::string::npos)
        << snapshot_->reasonOf("obstacle");
  }
}

TEST_F(Growth, EndsWhenTheBodyIsFreshAgain) {
  const BodyId id = test::put(scene_, slowBall("a", 1.0), test::at(0));
  test::put(scene_, slowBall("b", 1.0), test::at(2));
  scene_.setState(id, Freshness::lost, 9.0);
  EXPECT_EQ(now().pairs().size(), 1u);
  scene_.setState(id, Freshness::fresh, 0.0);
  EXPECT_TRUE(now().pairs().empty());
  EXPECT_EQ(snapshot_->poses()[0].growth, 0.0);
}

/// Claim: the margin that is configured for a pair counts for it, whether it is larger or smaller than the others.
TEST_F(Growth, OfPairsWithAMarginOfTheirOwnBeginsThere) {
  SceneOptions options = optionsWithCap(2.0);
  options.pair_margins = {{"obstacle/a", "obstacle/b", 0.01}, {"obstacle/a", "obstacle/c", 0.8}};
  Scene scene(options);
  const BodyId a = test::put(scene, slowBall("a", 1.0), test::at(0));
  test::put(scene, slowBall("b", 1.0), test::at(1.1));    // the boxes are 0.1 m apart
  test::put(scene, slowBall("c", 1.0), test::at(-1.75));  // 0.75 m
  EXPECT_EQ(test::namedPairs(*scene.commit(Time{1}, {})), test::NamePairs({{"obstacle/a", "obstacle/c"}}));
  scene.setState(a, Freshness::late, 0.3);
  EXPECT_EQ(test::namedPairs(*scene.commit(Time{2}, {})).size(), 2u) << "0.3 m and the margin of 0.01 m";
}

/// Claim: a body whose pose is newer than the tick was elsewhere at the tick, so the way back counts.
TEST_F(Growth, TheTimeWithoutContactCountsTheWayBackFromALaterPose) {
  Body fast = slowBall("a", 1.0);
  fast.speed_bound = 1.0;
  test::put(scene_, fast, test::at(0), std::chrono::milliseconds(300));
  test::put(scene_, test::ball("wall", 0.5, Mobility::fixed), test::at(2));
  const auto snapshot = scene_.commit(std::chrono::milliseconds(100), {});
  EXPECT_NEAR(snapshot->noContactBefore(0, 1, 0.5).before, 0.3, 1e-9);
  EXPECT_EQ(snapshot->noContactBefore(0, 1, 0.1).before, 0.0);
  EXPECT_FALSE(snapshot->noContactBefore(0, 1, 0.5).assumed);
}

TEST_F(Growth, TheTimeWithoutContactOfABodyWithoutBoundIsAssumed) {
  Body bounded = slowBall("a", 4.0);
  bounded.speed_bound = 1.0;
  test::put(scene_, bounded, test::at(0));
  test::put(scene_, slowBall("b", 3.0), test::at(2));
  Body any = test::ball("c");
  any.max_speed = std::numeric_limits<double>::infinity();
  test::put(scene_, any, test::at(4));
  now();
  const NoContact assumed = snapshot_->noContactBefore(0, 1, 0.5);
  EXPECT_NEAR(assumed.before, 0.5 / (1.0 + 3.0), 1e-9);
  EXPECT_TRUE(assumed.assumed);
  EXPECT_TRUE(std::isnan(snapshot_->noContactBefore(0, 2, 0.5).before));
  EXPECT_FALSE(snapshot_->noContactBefore(0, 2, 0.5).assumed);
}

/// Links 0 and 2 of one arm, which no joint connects directly, and link 2 of another arm.
class RobotGrowth : public Growth {
 protected:
  RobotGrowth() {
    RobotModel model;
    for (int i = 0; i < 3; ++i) test::addLink(model, std::to_string(i), i - 1);
    findRigidGroups(model);
    matrix_ = std::make_shared<const LinkMatrix>(test::matrixOf(model));
    first_ = test::put(scene_, linkOf("left", 0), test::at(0));
    second_ = test::put(scene_, linkOf("left", 2), test::at(2));
    stranger_ = test::put(scene_, linkOf("right", 2), test::at(0, 2));
  }
  Body linkOf(const std::string& robot, std::uint32_t link) const {
    Body body = slowBall("", 1.0);
    body.name = robot + "/" + std::to_string(link);
    body.kind = BodyKind::link;
    body.robot = robot;
    body.link = body.rigid_group = link;
    body.links = matrix_;
    return body;
  }
  void allStale(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    scene_.setState(first_, Freshness::stale, 1.0, a);
    scene_.setState(second_, Freshness::stale, 1.0, b);
    scene_.setState(stranger_, Freshness::stale, 1.0, c);
  }
  std::shared_ptr<const LinkMatrix> matrix_;
  BodyId first_, second_, stranger_;
};

TEST_F(RobotGrowth, LinksOfOneRobotThatAreEquallyOldDoNotGrowAgainstEachOther) {
  allStale(7, 7, 7);
  EXPECT_EQ(test::namedPairs(now()), test::NamePairs({{"left/0", "right/2"}, {"left/2", "right/2"}}))
      << "equal cohorts of links of two robots must have no effect";
  EXPECT_EQ(snapshot_->poses()[0].growth, 1.0) << "the margins of pairs with other bodies must still grow";
}

TEST_F(RobotGrowth, ButTheRobotIsIncompleteBecauseItsJointsMayHaveMoved) {
  scene_.setState(first_, Freshness::late, 0.2, 7);
  scene_.setState(second_, Freshness::late, 0.2, 7);
  EXPECT_TRUE(now().incompleteSources().empty()) << "no pose is that old yet";
  scene_.setState(first_, Freshness::fresh, 1.0, 7);
  EXPECT_EQ(now().incompleteSources(), std::vector<std::string>{"left"}) << "a slow frame is FRESH for longer";
  allStale(7, 7, 9);
  ASSERT_EQ(now().incompleteSources(), std::vector<std::string>{"left"})
      << "the other robot has one link only, so nothing can bend";
  EXPECT_NE(snapshot_->reasonOf("left").find("STALE left/0: its pose is 1 s old"), std::string::npos)
      << snapshot_->reasonOf("left");
  EXPECT_NE(snapshot_->reasonOf("left").find("joints"), std::string::npos);
}

TEST_F(RobotGrowth, LinksThatAreNotEquallyOldDo) {
  for (const auto& cohorts : {std::pair<std::uint32_t, std::uint32_t>{7, 8}, {0, 0}, {0, 7}, {7, 0}}) {
    allStale(cohorts.first, cohorts.second, 9);
    EXPECT_EQ(test::namedPairs(now()).count({"left/0", "left/2"}), 1u) << cohorts.first << " " << cohorts.second;
  }
}

}  // namespace
}  // namespace hgrid
