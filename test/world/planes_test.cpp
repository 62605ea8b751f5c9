// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Pairs with planes, compared with a brute-force scan without rounding.
#include <gtest/gtest.h>

#include "test/support/plane_oracle.h"
#include "test/support/refusals.h"
#include "test/support/scenes.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace {

using test::at;
using test::Exact;
using test::NamePairs;
using test::planeBody;
using test::Random;

/// Returns a scene with the plane z = 0.
Scene sceneWithFloor(const SceneOptions& options) {
  Scene scene(options);
  test::put(scene, planeBody("floor"), at(0));
  return scene;
}

bool isPlane(const Body& body, std::size_t shape) { return body.shapes[shape].shape.kind() == ShapeKind::plane; }

/// What the exact scan says about a pair of bodies.
struct Expected {
  bool must = false;                                     // the pair must be listed
  bool may = false;                                      // the pair may be listed: rounding can decide
  double gap = std::numeric_limits<double>::infinity();  // [m] least gap, nearly exact
};

Expected expectedOf(const Snapshot& snapshot, std::uint32_t i, std::uint32_t j, double margin) {
  const Structure& structure = snapshot.structure();
  const Body &a = structure.bodies[i], &b = structure.bodies[j];
  Expected result;
  for (std::size_t k = 0; k < a.shapes.size(); ++k) {
    for (std::size_t l = 0; l < b.shapes.size(); ++l) {
      if (isPlane(a, k) && isPlane(b, l)) continue;
      const Aabb &one = snapshot.boxes()[structure.first_proxy[i] + k],
                 &other = snapshot.boxes()[structure.first_proxy[j] + l];
      if (!isPlane(a, k) && !isPlane(b, l)) {
        const bool near = test::oracleWithin(one, other, margin);
        result.must = result.must || near;
        result.may = result.may || near;
        result.gap = std::min(result.gap, distance(one, other));
        continue;
      }
      const bool first = isPlane(a, k);
      const BodyShape& plane = first ? a.shapes[k] : b.shapes[l];
      const Pose pose = snapshot.poses()[first ? i : j].world_from_body * plane.body_from_shape;
      const Aabb& box = first ? other : one;
      const Exact height = test::exactHeight(box, pose, plane.padding, snapshot.origin());
      const double slack = test::planeRounding(box, pose, plane.padding, snapshot.origin());
      result.must = result.must || height <= Exact(margin);
      result.may = result.may || height <= Exact(margin) + Exact(slack);
      result.gap = std::min(result.gap, snapshot.gapOfProxies(structure.first_proxy[i] + std::uint32_t(k),
                                                              structure.first_proxy[j] + std::uint32_t(l)));
    }
  }
  return result;
}

/// Expects that the snapshot has all pairs that the exact scan finds, and no others. @returns the number of pairs with
/// a plane
std::size_t expectExactPairs(const Snapshot& snapshot, double global_margin) {
  const Structure& structure = snapshot.structure();
  const NamePairs listed = test::namedPairs(snapshot);
  std::size_t next = 0, with_planes = 0;
  for (std::uint32_t i = 0; i < structure.bodies.size(); ++i) {
    for (std::uint32_t j = i + 1; j < structure.bodies.size(); ++j) {
      const Body &a = structure.bodies[i], &b = structure.bodies[j];
      const BodyPose &p = snapshot.poses()[i], &q = snapshot.poses()[j];
      const bool on = p.state != Freshness::unplaced && q.state != Freshness::unplaced && test::reported(a, b);
      const double margin = std::max({global_margin, a.margin, b.margin}) + p.growth + q.growth;
      const Expected expected = on ? expectedOf(snapshot, i, j, margin) : Expected{};
      const bool is_listed = listed.count({a.name, b.name}) != 0;
      EXPECT_TRUE(is_listed || !expected.must) << a.name << " and " << b.name << " are missing";
      EXPECT_TRUE(!is_listed || expected.may) << a.name << " and " << b.name << " are too far apart";
      if (!is_listed) continue;
      const NearPair& pair = snapshot.pairs()[next++];
      EXPECT_EQ(pair.first, i);
      EXPECT_EQ(pair.second, j);
      EXPECT_EQ(pair.margin, margin);
      EXPECT_DOUBLE_EQ(pair.gap, std::min(expected.gap, margin));
      with_planes += structure.hasPlane(i) || structure.hasPlane(j);
    }
  }
  EXPECT_EQ(next, snapshot.pairs().size());
  return with_planes;
}

class Story {
 public:
  explicit Story(unsigned seed) : random_(seed), scene_(optionsOf()) {}

  std::size_t run(int ticks) {
    std::size_t with_planes = 0;
    for (int tick = 1; tick <= ticks && !testing::Test::HasFailure(); ++tick) {
      SCOPED_TRACE("tick " + std::to_string(tick));
      for (int changes = random_.below(8); changes > 0; --changes) change(tick);
      const auto snapshot = scene_.commit(Time{tick}, {});
      with_planes += expectExactPairs(*snapshot, options_.margin);
      followEvents(*snapshot);
      snapshot->broadPhase().checkInvariants();
    }
    return with_planes;
  }

 private:
  const SceneOptions& optionsOf() {
    options_.margin = random_.chance(0.2) ? 0.0 : test::sixtyFourths(random_, 0, 0.5);
    options_.event_hysteresis = 0.0;  // then the pairs between BEGIN and END are the listed pairs
    options_.growth_cap = test::sixtyFourths(random_, 0, 2);
    if (random_.chance(0.3)) center_ = test::randomVector(random_, -9e5, 9e5);
    if (random_.chance(0.5)) options_.origin = center_ + test::randomVector(random_, -10, 10);
    options_.threads = 1 + random_.below(2);
    return options_;
  }

  void change(int tick) {
    const int kind = random_.below(100);
    const std::string local = std::string(1, char('a' + random_.below(26))) + std::to_string(random_.below(2));
    BodyId id;
    const bool known = scene_.find("obstacle/" + local, id);
    if (kind < 40 && !known) {
      scene_.add(randomOne(local));
    } else if (known && kind < 50) {
      scene_.remove(id);
    } else if (known && kind < 90) {
      Pose pose = test::randomPose(random_, 3.0);
      pose.translation() += center_;
      if (random_.chance(0.2)) pose.translation() = center_;  // planes and boxes meet at one point
      scene_.place(id, pose, Time{tick});
    } else if (known) {
      scene_.setState(id, static_cast<Freshness>(random_.below(6)), test::sixtyFourths(random_, 0, 3));
    }
  }

  Body randomOne(const std::string& local) {
    Body body = test::randomBody(random_, local);
    if (random_.chance(0.7)) return body;
    body.mobility = Mobility::fixed;
    if (random_.chance(0.7)) body.shapes.clear();
    for (int planes = random_.between(1, 2); planes > 0; --planes) {
      BodyShape plane = test::shapeOf(Shape::plane());
      plane.body_from_shape = random_.chance(0.5) ? Pose::Identity() : test::randomPose(random_, 1.0);
      if (random_.chance(0.3)) plane.padding = random_.uniform(0, 0.2);
      body.shapes.insert(body.shapes.begin() + random_.below(int(body.shapes.size()) + 1), plane);
    }
    return body;
  }

  /// Expects that the pairs between their BEGIN and END events are the listed pairs.
  void followEvents(const Snapshot& snapshot) {
    for (const PairEvent& event : snapshot.events()) {
      const BodyList& bodies = snapshot.structureOf(event).bodies;
      const auto names = std::make_pair(std::string(bodies[event.first].name), std::string(bodies[event.second].name));
      if (event.kind == EventKind::begin) {
        EXPECT_TRUE(on_.insert(names).second) << names.first << " and " << names.second << " begin twice";
      } else {
        EXPECT_EQ(on_.erase(names), 1u) << names.first << " and " << names.second << " end without a begin";
      }
    }
    EXPECT_EQ(on_, test::namedPairs(snapshot));
  }

  Random random_;
  SceneOptions options_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  Scene scene_;
  NamePairs on_;
};

TEST(Planes, EverySnapshotOfALongStoryHasThePairsOfAnExactScan) {
  std::size_t with_planes = 0;
  for (unsigned seed = 1; seed <= 40 && !HasFailure(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    with_planes += Story(seed).run(40);
  }
  EXPECT_GT(with_planes, 3000u);
}

TEST(Planes, FloorIsNearOnlyWhatIsNearIt) {
  for (const char* floor : {"a_floor", "z_floor"}) {  // before and after the other bodies
    SceneOptions options;
    options.margin = 0.25;
    Scene scene(options);
    test::put(scene, planeBody(floor), at(0, 0, 0));
    test::put(scene, test::ball("high"), at(1000, 0, 2));
    test::put(scene, test::ball("low"), at(-1000, 5, 0.625));
    test::put(scene, test::ball("deep"), at(0, 0, -1000));
    test::put(scene, test::ball("fixed", 0.5, Mobility::fixed), at(0, 0, 0));
    Random random(3);
    test::put(scene, planeBody("wall"), test::randomPose(random, 1.0));
    const auto snapshot = scene.commit(Time{1}, {});
    const std::string name = "obstacle/" + std::string(floor);
    NamePairs with_floor;
    for (const auto& pair : test::namedPairs(*snapshot)) {
      if (pair.first == name || pair.second == name) with_floor.insert(pair);
    }
    EXPECT_EQ(with_floor, (NamePairs{std::minmax<std::string>(name, "obstacle/deep"),
                                     std::minmax<std::string>(name, "obstacle/low")}));
  }
}

TEST(Planes, TouchingExactlyIsNearWithTheMarginZeroAndALittleFartherIsNot) {
  SceneOptions options;
  options.margin = 0.0;
  Scene scene = sceneWithFloor(options);
  const BodyId ball = test::put(scene, test::ball("ball"), at(0, 0, 0.5));
  EXPECT_EQ(scene.commit(Time{1}, {})->pairs().size(), 1u);
  double z = 0.5;
  for (int i = 2; i < 40; ++i) {
    z += 3e-9;
    scene.place(ball, at(0, 0, z), Time{i});
    const auto snapshot = scene.commit(Time{i}, {});
    const double gap = double(snapshot->boxes()[0].min.z());
    ASSERT_EQ(snapshot->structure().bodies[0].name, "obstacle/ball");
    ASSERT_EQ(snapshot->pairs().size(), gap <= 0.0 ? 1u : 0u) << gap;
  }
  EXPECT_TRUE(scene.commit(Time{50}, {})->pairs().empty());
}

TEST(Planes, PaddingMovesThePlaneOutward) {
  SceneOptions options;
  options.margin = 0.0;
  Scene scene(options);
  test::put(scene, planeBody("floor", 0.25), at(0));
  test::put(scene, test::ball("in"), at(0, 0, 0.7));
  test::put(scene, test::ball("out"), at(0, 9, 0.8));
  EXPECT_EQ(test::namedPairs(*scene.commit(Time{1}, {})), (NamePairs{{"obstacle/floor", "obstacle/in"}}));
}

TEST(Planes, MovedPlaneEndsAndBeginsPairs) {
  Scene scene(SceneOptions{});
  const BodyId floor = test::put(scene, planeBody("floor"), at(0));
  test::put(scene, test::ball("ball"), at(0, 0, 2));
  EXPECT_TRUE(scene.commit(Time{1}, {})->pairs().empty());
  scene.place(floor, at(0, 0, 1.5), Time{2});
  const auto raised = scene.commit(Time{2}, {});
  ASSERT_EQ(raised->events().size(), 1u);
  EXPECT_EQ(raised->events()[0].kind, EventKind::begin);
  EXPECT_EQ(raised->events()[0].cause, EventCause::moved);
  scene.place(floor, at(0, 0, 1.0), Time{3});
  const auto lowered = scene.commit(Time{3}, {});
  ASSERT_EQ(lowered->events().size(), 1u);
  EXPECT_EQ(lowered->events()[0].kind, EventKind::end);
  EXPECT_NEAR(lowered->events()[0].gap, 0.5, 1e-6);
}

TEST(Planes, PlaneThatMovesAlongItselfIsComparedAgainBecauseItsRoundingGrows) {
  SceneOptions options;
  options.margin = 0.0;
  Scene scene(options);
  for (int i = 0; i < 20; ++i) test::put(scene, test::ball("far" + std::to_string(i)), at(0, 0, 50 + 3 * i));
  test::put(scene, test::ball("near"), at(0.5 + 7e-9, 0, 0.5 + 7e-9));
  const double s = std::sqrt(0.5);
  Pose tilted = Pose::Identity();
  tilted.linear() << s, 0, s, 0, 1, 0, -s, 0, s;
  const BodyId slope = test::put(scene, planeBody("slope"), tilted);
  EXPECT_TRUE(scene.commit(Time{1}, {})->pairs().empty()) << "the gap is 1e-8 m";
  tilted.translation() << 9e5, 0, -9e5;
  scene.place(slope, tilted, Time{2});
  const auto moved = scene.commit(Time{2}, {});
  ASSERT_EQ(moved->halfSpaces()[0].offset, 0.0) << "the half-space is the same, but less exactly known";
  EXPECT_EQ(moved->pairs().size(), 1u);
}

TEST(Planes, PairStaysOnWithinTheHysteresis) {
  SceneOptions options;
  options.margin = 0.1;
  options.event_hysteresis = 0.1;
  Scene scene = sceneWithFloor(options);
  const BodyId ball = test::put(scene, test::ball("ball"), at(0, 0, 0.55));
  EXPECT_EQ(scene.commit(Time{1}, {})->events().size(), 1u);
  scene.place(ball, at(0, 0, 0.65), Time{2});
  EXPECT_TRUE(scene.commit(Time{2}, {})->events().empty());
  scene.place(ball, at(0, 0, 0.75), Time{3});
  EXPECT_EQ(scene.commit(Time{3}, {})->events().size(), 1u);
}

TEST(Planes, HorizonFindsWhatCanMeetThePlaneSoonAndWhatPassed) {
  SceneOptions options;
  options.margin = 0.1;
  options.horizon = 1.0;
  Scene scene = sceneWithFloor(options);
  Body slow = test::ball("slow"), fast = test::ball("fast");
  slow.max_speed = 0.5;
  fast.max_speed = 2.0;
  test::put(scene, slow, at(0, 0, 2));
  const BodyId moving = test::put(scene, fast, at(5, 0, 2));
  const auto soon = scene.commit(Time{1}, {});
  ASSERT_EQ(test::namedPairs(*soon), (NamePairs{{"obstacle/fast", "obstacle/floor"}}));
  EXPECT_EQ(soon->pairs()[0].flags & kHorizonFlag, kHorizonFlag);
  EXPECT_NEAR(soon->pairs()[0].gap, 1.5, 1e-6);
  scene.place(moving, at(5, 0, 0), Time{2});
  scene.commit(Time{2}, {});
  scene.place(moving, at(5, 0, 50), Time{3});  // it was in the plane in the tick before
  EXPECT_EQ(scene.commit(Time{3}, {})->pairs().size(), 1u);
  EXPECT_TRUE(scene.commit(Time{4}, {})->pairs().empty());
}

TEST(Planes, TruncationKeepsTheNearestAndEndsNothing) {
  SceneOptions options;
  options.margin = 1.0;
  options.max_pairs = 3;
  Scene scene = sceneWithFloor(options);
  std::vector<BodyId> balls;
  for (int i = 0; i < 3; ++i) {
    balls.push_back(test::put(scene, test::ball("b" + std::to_string(i)), at(10 * i, 0, 0.6 + 0.1 * i)));
  }
  EXPECT_EQ(scene.commit(Time{1}, {})->events().size(), 3u);
  scene.place(balls[2], at(20, 0, 1.45), Time{2});
  test::put(scene, test::ball("b9"), at(90, 0, 0.5));
  const auto cut = scene.commit(Time{2}, {});
  EXPECT_TRUE(cut->truncated());
  EXPECT_FALSE(cut->searchCut());
  EXPECT_EQ(cut->pairsFound(), 4u);
  EXPECT_EQ(test::namedPairs(*cut), (NamePairs{{"obstacle/b0", "obstacle/floor"},
                                               {"obstacle/b1", "obstacle/floor"},
                                               {"obstacle/b9", "obstacle/floor"}}));
  for (const PairEvent& event : cut->events()) EXPECT_EQ(event.kind, EventKind::begin);
  BodyId nearest;
  ASSERT_TRUE(scene.find("obstacle/b9", nearest));
  scene.remove(nearest);
  const auto whole = scene.commit(Time{3}, {});
  ASSERT_EQ(whole->pairs().size(), 3u);
  EXPECT_EQ(whole->pairs()[2].since, Time{1}) << "the truncation did not interrupt the pair";
}

TEST(Planes, SearchStopsAtItsLimitAndSaysSo) {
  SceneOptions options;
  options.max_pairs = 1;
  options.max_bodies = 2000;
  Scene scene(options);
  for (int i = 0; i < 64; ++i) test::put(scene, planeBody("p" + std::to_string(i)), at(0));
  for (int i = 0; i < 1100; ++i) test::put(scene, test::ball("b" + std::to_string(i)), at(3 * i, 0, 0));
  const auto snapshot = scene.commit(Time{1}, {});
  EXPECT_TRUE(snapshot->searchCut());
  EXPECT_TRUE(snapshot->truncated());
  EXPECT_EQ(snapshot->pairs().size(), 1u);
}

TEST(Planes, BodiesThatMoveAndPlanesBeyondTheLimitAreRefused) {
  SceneOptions options;
  options.max_planes = 2;
  Scene scene(options);
  Body moving = planeBody("moving");
  moving.mobility = Mobility::moving;
  std::string sentence;
  EXPECT_EQ(test::refusalOf([&] { scene.add(moving); }, &sentence), Code::unsupported);
  EXPECT_TRUE(test::says(sentence, "obstacle/moving"));
  const BodyId one = scene.add(planeBody("one"));
  Body two = planeBody("two");
  two.shapes.push_back(two.shapes[0]);
  EXPECT_EQ(test::refusalOf([&] { scene.add(two); }, &sentence), Code::limit);
  EXPECT_TRUE(test::says(sentence, "max_planes"));
  EXPECT_EQ(scene.size(), 1u);
  scene.exchange({one}, {two});  // the plane that leaves makes room
  EXPECT_EQ(test::refusalOf([&] { scene.add(planeBody("one")); }), Code::limit);
  BodyId id;
  ASSERT_TRUE(scene.find("obstacle/two", id));
  scene.remove(id);
  scene.add(planeBody("one"));
  scene.add(planeBody("three"));
}

TEST(Planes, PlanesDoNotChangeTheCellsOfTheGrid) {
  SceneOptions options;
  Scene with(options), without(options);
  test::put(with, planeBody("floor"), at(0));
  Random random(7);
  for (int i = 0; i < 50; ++i) {
    const Body body = test::randomBody(random, "b" + std::to_string(i));
    const Pose pose = test::randomPose(random, 5.0);
    test::put(with, body, pose);
    test::put(without, body, pose);
  }
  const auto a = with.commit(Time{1}, {}), b = without.commit(Time{1}, {});
  ASSERT_EQ(a->broadPhase().levels().size(), b->broadPhase().levels().size());
  for (std::size_t i = 0; i < a->broadPhase().levels().size(); ++i) {
    EXPECT_EQ(a->broadPhase().levels()[i].edge, b->broadPhase().levels()[i].edge);
  }
}

}  // namespace
}  // namespace hgrid
