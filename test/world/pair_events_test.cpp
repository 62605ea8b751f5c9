// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "test/support/events.h"
#include "test/support/models.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::at;
using test::eventsOf;
using Events = std::vector<std::string>;

/// Spheres of radius 0.5 m on the x axis; margin 1/8 m, hysteresis 1/16 m.
class PairEvents : public ::testing::Test {
 protected:
  static SceneOptions options() {
    SceneOptions options;
    options.margin = 0.125;
    options.event_hysteresis = 0.0625;
    options.growth_cap = 2.0;
    return options;
  }
  BodyId put(const std::string& name, double x, double max_speed = 1.0) {
    Body body = test::ball(name);
    body.max_speed = max_speed;
    return test::put(scene_, body, at(x), Time{tick_ + 1});
  }
  void place(BodyId id, double x) { scene_.place(id, at(x), Time{tick_ + 1}); }
  Events next() {
    snapshot_ = scene_.commit(Time{++tick_}, {});
    return eventsOf(*snapshot_);
  }
  const PairEvent& event(std::size_t i = 0) const { return snapshot_->events().at(i); }

  Scene scene_{options()};
  std::shared_ptr<const Snapshot> snapshot_;
  int tick_ = 0;
};

TEST_F(PairEvents, APairBeginsWithinItsMarginAndEndsBeyondTheHysteresis) {
  put("a", 0);
  const BodyId b = put("b", 1.3);
  EXPECT_EQ(next(), Events());
  place(b, 1.15);
  EXPECT_EQ(next(), Events()) << "a gap within the hysteresis must not begin a pair";
  place(b, 1.1);
  EXPECT_EQ(next(), Events({"1 BEGIN MOVED obstacle/a obstacle/b"}));
  EXPECT_EQ(event().since, Time{3});
  EXPECT_NEAR(event().gap, 0.1, 1e-6);
  for (const double x : {1.1, 1.15, 1.18, 1.0, 1.18}) {
    place(b, x);
    EXPECT_EQ(next(), Events()) << x;
    EXPECT_EQ(snapshot_->pairs().size(), x < 1.125 ? 1u : 0u) << "the hysteresis must not count for the list of pairs";
  }
  place(b, 1.2);
  EXPECT_EQ(next(), Events({"2 END MOVED obstacle/a obstacle/b"}));
  EXPECT_EQ(event().since, Time{3}) << "an END event must hold the time when the pair began";
  EXPECT_NEAR(event().gap, 0.2, 1e-6);
  for (const double x : {1.18, 1.13}) {
    place(b, x);
    EXPECT_EQ(next(), Events()) << x;
    EXPECT_EQ(snapshot_->lastEvent(), 2u);
  }
}

TEST_F(PairEvents, AreTheSameWithAnyOfTheTwoMoving) {
  const BodyId a = put("a", 0);
  put("b", 1.1);
  EXPECT_EQ(next(), Events({"1 BEGIN BODIES obstacle/a obstacle/b"}));
  place(a, -0.08);
  EXPECT_EQ(next(), Events());
  place(a, -0.1);
  EXPECT_EQ(next(), Events({"2 END MOVED obstacle/a obstacle/b"}));
}

TEST_F(PairEvents, TheNearestShapesDecide) {
  put("a", 0);
  Body two = test::ball("b");
  two.shapes.push_back(two.shapes[0]);
  two.shapes[0].body_from_shape = at(5);
  const BodyId b = test::put(scene_, two, at(1.1));
  EXPECT_EQ(next(), Events({"1 BEGIN BODIES obstacle/a obstacle/b"}));
  place(b, 1.18);
  EXPECT_EQ(next(), Events());
  place(b, -6.18);
  EXPECT_EQ(next(), Events()) << "the other shape of b is now as near as the first one was";
  place(b, -6.2);
  EXPECT_EQ(next(), Events({"2 END MOVED obstacle/a obstacle/b"}));
  EXPECT_NEAR(event().gap, 0.2, 1e-6);
}

TEST_F(PairEvents, ComeEndsFirstThenByName) {
  const BodyId b = put("b", 0);
  put("c", 1.05);
  put("a", -1.05);
  next();
  put("d", 3);
  EXPECT_EQ(next(), Events());
  place(b, 4.05);
  EXPECT_EQ(next(), Events({"3 END MOVED obstacle/a obstacle/b", "4 END MOVED obstacle/b obstacle/c",
                            "5 BEGIN MOVED obstacle/b obstacle/d"}));
}

TEST_F(PairEvents, OfABodyThatIsGoneStillKnowItsName) {
  const BodyId a = put("a", 0);
  put("b", 1.1);
  put("c", 2.2);
  EXPECT_EQ(next(), Events({"1 BEGIN BODIES obstacle/a obstacle/b", "2 BEGIN BODIES obstacle/b obstacle/c"}));
  scene_.remove(a);
  EXPECT_EQ(next(), Events({"3 END BODIES obstacle/a obstacle/b"}))
      << "the pair of b and c must not end when the indices of its bodies change";
  EXPECT_TRUE(std::isnan(event().gap));
  EXPECT_EQ(event().since, Time{1});
  EXPECT_EQ(next(), Events());
}

TEST_F(PairEvents, OfABodyThatIsReplacedEndAndBegin) {
  const BodyId a = put("a", 0);
  put("b", 1.1);
  next();
  scene_.remove(a);
  put("a", 0);
  EXPECT_EQ(next(), Events({"2 END BODIES obstacle/a obstacle/b", "3 BEGIN BODIES obstacle/a obstacle/b"}));
  scene_.remove(scene_.add(test::ball("0")));  // creates a new structure with the same bodies
  EXPECT_EQ(next(), Events());
}

TEST_F(PairEvents, OfABodyThatWasNowhereBeginWithItsFirstPose) {
  put("a", 0);
  const BodyId b = scene_.add(test::ball("b"));
  EXPECT_EQ(next(), Events());
  EXPECT_EQ(next(), Events());
  place(b, 1.1);
  EXPECT_EQ(next(), Events({"1 BEGIN BODIES obstacle/a obstacle/b"}));
}

TEST_F(PairEvents, SayWhenOnlyTheStalenessOfABodyMadeThePair) {
  put("a", 0);
  const BodyId b = put("b", 1.5);
  EXPECT_EQ(next(), Events());
  scene_.setState(b, Freshness::stale, 0.25);
  EXPECT_EQ(next(), Events());
  scene_.setState(b, Freshness::stale, 0.5);
  EXPECT_EQ(next(), Events({"1 BEGIN STALENESS obstacle/a obstacle/b"}));
  scene_.setState(b, Freshness::stale, 0.35);
  EXPECT_EQ(next(), Events()) << "the hysteresis must be added to the margin of the stale body";
  scene_.setState(b, Freshness::fresh, 0.0);
  EXPECT_EQ(next(), Events({"2 END STALENESS obstacle/a obstacle/b"}));
}

TEST_F(PairEvents, SayThatTheyMovedWhereTheMarginOfBeforeIsEnough) {
  const BodyId a = put("a", 0);
  const BodyId b = put("b", 3.5);
  scene_.setState(b, Freshness::stale, 2.0);
  EXPECT_EQ(next(), Events());
  place(a, 1.0);
  scene_.setState(b, Freshness::stale, 2.01);
  EXPECT_EQ(next(), Events({"1 BEGIN MOVED obstacle/a obstacle/b"}))
      << "the previous margin of 2.125 m is larger than the gap of 1.5 m";
  place(a, 0.0);
  scene_.setState(b, Freshness::fresh, 0.0);
  EXPECT_EQ(next(), Events({"2 END MOVED obstacle/a obstacle/b"})) << "the gap also exceeds the previous, wider margin";
}

TEST_F(PairEvents, OfLinksOfOneRobotAreNotCausedByEqualAge) {
  RobotModel model;
  for (int i = 0; i < 3; ++i) test::addLink(model, std::to_string(i), i - 1);
  findRigidGroups(model);
  const auto matrix = std::make_shared<const LinkMatrix>(test::matrixOf(model));
  const auto put_link = [&](std::uint32_t link, double x) {
    Body body = test::ball("");
    body.name = "arm/" + std::to_string(link);
    body.kind = BodyKind::link;
    body.robot = "arm";
    body.link = link;
    body.links = matrix;
    body.max_speed = 1.0;
    return test::put(scene_, body, at(x));
  };
  const BodyId base = put_link(0, 0), tip = put_link(2, 1.5);
  EXPECT_EQ(next(), Events());
  const auto set_age = [&](double age, std::uint32_t cohort_of_tip) {
    scene_.setState(base, Freshness::stale, age, 7);
    scene_.setState(tip, Freshness::stale, age, cohort_of_tip);
  };
  set_age(0.5, 7);
  EXPECT_EQ(next(), Events());
  set_age(0.5, 8);
  EXPECT_EQ(next(), Events({"1 BEGIN STALENESS arm/0 arm/2"}))
      << "the margin is 1/8 m + 1/2 m + 1/2 m, which is more than the gap";
  set_age(0.5, 7);
  EXPECT_EQ(next(), Events({"2 END STALENESS arm/0 arm/2"}));
}

TEST_F(PairEvents, BeginAgainInANewEpochFromNumberOne) {
  put("a", 0);
  const BodyId b = put("b", 1.1);
  put("c", 1.25);
  next();
  place(b, 1.15);
  EXPECT_EQ(next(), Events());
  EXPECT_EQ(snapshot_->lastEvent(), 2u);
  scene_.beginEpoch(77);
  EXPECT_EQ(next(), Events({"1 BEGIN EPOCH obstacle/b obstacle/c"}))
      << "a and b are not within their margin, so they must not begin again";
  EXPECT_EQ(event().since, Time{3});
  EXPECT_EQ(snapshot_->lastEvent(), 1u);
  place(b, 1.1);
  EXPECT_EQ(next(), Events({"2 BEGIN MOVED obstacle/a obstacle/b"}));
}

TEST_F(PairEvents, OfANewEpochGoByName) {
  const BodyId a = put("a", 0);
  put("b", 1.1);
  const BodyId c = put("c", 2.2);
  next();
  scene_.remove(a);
  scene_.remove(c);
  put("a", 0);
  put("d", 2.2);
  scene_.beginEpoch(77);
  EXPECT_EQ(next(), Events({"1 BEGIN EPOCH obstacle/a obstacle/b", "2 BEGIN BODIES obstacle/b obstacle/d"}))
      << "a pair must not end in an epoch in which it did not begin";
}

TEST_F(PairEvents, WithoutHysteresisAreTheChangesOfThePairs) {
  SceneOptions sharp = options();
  sharp.event_hysteresis = 0.0;
  Scene scene(sharp);
  test::put(scene, test::ball("a"), at(0));
  const BodyId b = test::put(scene, test::ball("b"), at(1.1));
  bool was_near = false;
  for (const double x : {1.1, 1.12, 1.13, 1.12, 1.3, 1.126, 1.124}) {
    scene.place(b, at(x), Time{2});
    const auto snapshot = scene.commit(Time{2}, {});
    const bool near = !snapshot->pairs().empty();
    EXPECT_EQ(snapshot->events().size(), near != was_near ? 1u : 0u) << x;
    was_near = near;
  }
}

TEST_F(PairEvents, OfASnapshotStayWhatTheyWere) {
  put("a", 0);
  const BodyId b = put("b", 1.1);
  next();
  const auto first = snapshot_;
  scene_.remove(b);
  next();
  const auto second = snapshot_;
  for (int i = 0; i < 10; ++i) {
    put("c" + std::to_string(i), -1.05);
    next();
  }
  EXPECT_EQ(eventsOf(*first), Events({"1 BEGIN BODIES obstacle/a obstacle/b"}));
  EXPECT_EQ(eventsOf(*second), Events({"2 END BODIES obstacle/a obstacle/b"}));
}

TEST_F(PairEvents, OfAFixedObstacleContinueIfOnlyItsPoseChanges) {
  Body table = test::ball("table", 0.5, Mobility::fixed);
  table.shapes[0].solid = makeCoreNarrowPhase()->solidOf(table.shapes[0].shape);
  BodyId id = test::put(scene_, table, at(1.05));
  put("a", 0);
  EXPECT_EQ(next(), Events({"1 BEGIN BODIES obstacle/a obstacle/table"}));
  table.frame_from_body = at(-1.05);
  ASSERT_EQ(scene_.exchange({id}, {table}), std::vector<BodyId>{id});
  place(id, -1.05);
  EXPECT_EQ(next(), Events()) << "it went to the other side within one tick";
  EXPECT_EQ(snapshot_->structure().bodies[1].frame_from_body.translation().x(), -1.05);
  ASSERT_EQ(snapshot_->pairs().size(), 1u);

  Body other = table;
  other.shapes[0].solid = makeCoreNarrowPhase()->solidOf(other.shapes[0].shape);
  const BodyId replaced = scene_.exchange({id}, {other}).front();
  EXPECT_NE(replaced, id) << "another solid may be another shape";
  place(replaced, -1.05);
  EXPECT_EQ(next().size(), 2u) << "END and BEGIN";
  const BodyId moving = scene_
                            .exchange({replaced}, {[&] {
                                        other.mobility = Mobility::moving;
                                        return other;
                                      }()})
                            .front();
  EXPECT_NE(moving, replaced) << "the pose of a body that can move may not be known";
}

/// Claim: bodies that keep their slots and bodies that get other slots can be in one exchange.
TEST_F(PairEvents, OfManyFixedObstaclesContinueIfOnlySomeAreReplaced) {
  const auto phase = makeCoreNarrowPhase();
  std::vector<Body> tables;
  std::vector<BodyId> ids;
  for (int i = 0; i < 6; ++i) {
    tables.push_back(test::ball("t" + std::to_string(i), 0.25, Mobility::fixed));
    tables.back().shapes[0].solid = phase->solidOf(tables.back().shapes[0].shape);
    ids.push_back(test::put(scene_, tables.back(), at(i)));
  }
  put("a", 2.5);
  EXPECT_EQ(next().size(), 2u);  // it is near t2 and t3
  std::vector<Body> in{tables[5], test::ball("new", 0.25, Mobility::fixed), tables[2], tables[1]};
  const std::vector<BodyId> now = scene_.exchange({ids[1], ids[2], ids[3], ids[5]}, in);
  EXPECT_EQ(now[0], ids[5]);
  EXPECT_EQ(now[2], ids[2]);
  EXPECT_EQ(now[3], ids[1]);
  EXPECT_EQ(scene_.size(), 7u);
  for (std::size_t i = 0; i < in.size(); ++i) EXPECT_EQ(scene_.body(now[i]).name, in[i].name);
  place(now[1], 3);
  EXPECT_EQ(next(), Events({"3 END BODIES obstacle/a obstacle/t3", "4 BEGIN BODIES obstacle/a obstacle/new"}));
  EXPECT_EQ(snapshot_->pairs().size(), 2u);
}

}  // namespace
}  // namespace hgrid
