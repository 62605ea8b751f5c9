// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <limits>

#include "test/support/maps.h"
#include "test/support/random.h"
#include "test/support/refusals.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::at;
using test::put;

class HorizonTest : public ::testing::Test {
 protected:
  static SceneOptions withHorizon(double horizon) {
    SceneOptions options;
    options.margin = 0.1;
    options.horizon = horizon;
    return options;
  }
  static Body ballOf(const std::string& name, double max_speed) {
    Body body = test::ball(name);
    body.max_speed = max_speed;
    return body;
  }
  static std::shared_ptr<const Snapshot> commit(Scene& scene, int milliseconds) {
    return scene.commit(std::chrono::milliseconds(milliseconds), {});
  }
  static void move(Scene& scene, BodyId id, const Pose& pose, int milliseconds) {
    scene.place(id, pose, std::chrono::milliseconds(milliseconds));
  }
};

TEST_F(HorizonTest, PairsThatCanMeetWithinItAreCandidates) {
  for (const double gap : {0.05, 0.3, 0.49, 0.51, 2.0}) {
    SCOPED_TRACE(gap);
    Scene scene(withHorizon(0.5));
    put(scene, ballOf("a", 0.6), at(0.0));
    put(scene, ballOf("b", 0.4), at(1.0 + gap));  // the two bodies approach each other with at most 1 m/s
    const auto snapshot = commit(scene, 1);
    ASSERT_EQ(snapshot->pairs().size(), gap <= 0.5 ? 1u : 0u);
    if (gap > 0.5) continue;
    const NearPair& pair = snapshot->pairs()[0];
    EXPECT_NEAR(pair.gap, gap, 1e-6);
    EXPECT_EQ(pair.flags, gap > 0.1 ? kHorizonFlag : 0);
  }
}

TEST_F(HorizonTest, CountsWhatABodyCanHaveMovedSinceItsPose) {
  for (const double age : {0.0, 0.19, 0.21, 0.5, 100.0}) {
    SCOPED_TRACE(age);
    SceneOptions options = withHorizon(0.5);
    options.growth_cap = 0.75;
    options.growth_after = 0.25;
    Scene scene(options);
    const BodyId a = put(scene, ballOf("a", 1.0), at(0.0));
    put(scene, ballOf("b", 0.0), at(1.7));   // its box is 0.7 m from the box of body a
    put(scene, ballOf("c", 0.0), at(-2.5));  // its box is 1.5 m from the box of body a, too far for the horizon
    scene.setState(a, Freshness::late, age);
    const auto pairs = test::namedPairs(*commit(scene, 1));
    EXPECT_EQ(pairs.count({"obstacle/a", "obstacle/b"}), age > 0.2 ? 1u : 0u);
    EXPECT_EQ(pairs.count({"obstacle/a", "obstacle/c"}), 0u);
  }
}

TEST_F(HorizonTest, FixedBodiesGoNowhereAndWithoutAHorizonNothingDoes) {
  for (const double horizon : {0.0, 10.0}) {
    Scene scene(withHorizon(horizon));
    Body fixed = ballOf("b", 100.0);
    fixed.mobility = Mobility::fixed;
    put(scene, ballOf("a", 0.01), at(0.0));
    put(scene, fixed, at(1.5));
    EXPECT_TRUE(commit(scene, 1)->pairs().empty()) << horizon;
  }
}

TEST_F(HorizonTest, WhatPassedThroughBetweenTwoTicksIsNotMissed) {
  Scene scene(withHorizon(0.01));
  const BodyId a = put(scene, ballOf("a", 1000.0), at(-5.0), std::chrono::milliseconds(1));
  put(scene, ballOf("b", 1.0), at(0.0), std::chrono::milliseconds(1));
  scene.add(ballOf("unplaced", 1.0));
  // Within the horizon, the fast body a can move by 10 m, so it always forms a pair. The second scene has a
  // slow body that jumps. It tests only the box around the path of a body.
  EXPECT_EQ(commit(scene, 1)->pairs().size(), 1u);
  Scene slow(withHorizon(0.001));
  const BodyId jumper = put(slow, ballOf("a", 1.0), at(-5.0), std::chrono::milliseconds(1));
  put(slow, ballOf("b", 1.0), at(0.0), std::chrono::milliseconds(1));
  EXPECT_TRUE(commit(slow, 1)->pairs().empty());
  move(slow, jumper, at(5.0), 11);  // on its way, the body passes through b
  const auto snapshot = commit(slow, 11);
  ASSERT_EQ(snapshot->pairs().size(), 1u);
  EXPECT_EQ(snapshot->pairs()[0].flags, kHorizonFlag | kTeleportFlag)
      << "it moved 10 m in 10 ms, but its max_speed is 1 m/s";
  EXPECT_TRUE(commit(slow, 21)->pairs().empty()) << "in the next tick the two bodies are far apart";
  move(scene, a, at(-5.1), 11);
  for (const NearPair& pair : commit(scene, 11)->pairs()) EXPECT_EQ(pair.flags & kTeleportFlag, 0);
}

/// Claim: no pair that came within its margin between two ticks is missing in the later tick, although poses lag behind
/// the ticks and bodies come and go. The bodies move in straight lines, which a fine simulation follows.
TEST_F(HorizonTest, WhatPassedThroughIsNotMissedWhilePosesLagAndBodiesComeAndGo) {
  constexpr int kBodies = 6, kTick = 10;  // [ms] period of the ticks
  std::size_t passed = 0, passed_lagging = 0, passed_changed = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::Random random(seed);
    SceneOptions options = withHorizon(0.0001);
    options.growth_cap = 100.0;
    Scene scene(options);
    struct Mover {
      BodyId id;
      Eigen::Vector3d start, speed;  // [m], [m/s]
      int known = 0;                 // [ms] stamp of its pose
      Eigen::Vector3d at(double milliseconds) const { return start + 1e-3 * milliseconds * speed; }
    };
    std::vector<Mover> movers(kBodies);
    for (int i = 0; i < kBodies; ++i) {
      Mover& mover = movers[std::size_t(i)];
      for (int k = 0; k < 3; ++k) {
        mover.speed[k] = random.uniform(-40, 40);
        mover.start[k] = random.uniform(-0.5, 0.5) - 0.1 * mover.speed[k];  // all meet after about 100 ms
      }
      Body body = test::ball(std::string(1, char('b' + i)), 0.1);
      body.max_speed = mover.speed.norm();
      mover.id = put(scene, body, Pose(Eigen::Translation3d(mover.start)), std::chrono::milliseconds(0));
    }
    commit(scene, 0);
    BodyId guest;
    bool has_guest = false;
    for (int now = kTick; now <= 20 * kTick; now += kTick) {
      const bool changes = random.chance(0.3);
      if (changes && has_guest) scene.remove(guest);
      if (changes && !has_guest) guest = put(scene, test::ball("a"), at(1000.0));  // first by name: all others move up
      has_guest = has_guest != changes;
      for (Mover& mover : movers) {
        if (random.chance(0.4)) continue;  // no new pose, so the last one lags behind the tick
        mover.known = now;
        move(scene, mover.id, Pose(Eigen::Translation3d(mover.at(now))), now);
      }
      for (const Mover& mover : movers) scene.setState(mover.id, Freshness::fresh, 1e-3 * (now - mover.known), 0);
      const auto snapshot = commit(scene, now);
      const auto pairs = test::namedPairs(*snapshot);
      for (std::size_t i = 0; i < movers.size(); ++i) {
        for (std::size_t j = i + 1; j < movers.size(); ++j) {
          double least = std::numeric_limits<double>::infinity();  // [m] distance of the boxes, which are cubes
          for (double time = now - kTick; time <= now; time += 0.05) {
            const Eigen::Vector3d apart = (movers[i].at(time) - movers[j].at(time)).cwiseAbs().array() - 0.2;
            least = std::min(least, apart.cwiseMax(0.0).norm());
          }
          if (least > 0.0999) continue;
          ++passed;
          passed_lagging += movers[i].known < now || movers[j].known < now;
          passed_changed += changes;
          const std::string a = scene.body(movers[i].id).name, b = scene.body(movers[j].id).name;
          EXPECT_EQ(pairs.count({a, b}), 1u) << a << ", " << b << " at " << now << " ms";
        }
      }
    }
  }
  EXPECT_GT(passed, 300u);
  EXPECT_GT(passed_lagging, 100u);
  EXPECT_GT(passed_changed, 50u);
}

TEST_F(HorizonTest, WhatMovesAsFastAsItMayDidNotTeleport) {
  Scene scene(withHorizon(1.0));
  const BodyId a = put(scene, ballOf("a", 1.0), at(0.0), std::chrono::milliseconds(1));
  put(scene, ballOf("b", 1.0), at(1.2), std::chrono::milliseconds(1));
  commit(scene, 1);
  for (int tick = 1; tick < 50; ++tick) {
    move(scene, a, at(-0.01 * tick), 1 + 10 * tick);
    const auto snapshot = commit(scene, 1 + 10 * tick);
    ASSERT_EQ(snapshot->pairs().size(), 1u);
    ASSERT_EQ(snapshot->pairs()[0].flags & kTeleportFlag, 0) << tick;
  }
  move(scene, a, at(-0.6), 511);
  EXPECT_EQ(commit(scene, 511)->pairs().at(0).flags & kTeleportFlag, kTeleportFlag)
      << "it moved 0.11 m in 10 ms, but its max_speed is 1 m/s";
}

/// Claim: a body that turns does not stay within the box around its boxes of two ticks, and what it passed outside of
/// that box is not missed: shapes, planes and cells.
TEST_F(HorizonTest, WhatATurningStickPassedBetweenTwoTicksIsNotMissed) {
  for (const double turn : {0.4, 0.7, 1.1}) {  // [rad] in 10 ms
    SCOPED_TRACE(turn);
    SceneOptions options = withHorizon(1e-4);
    options.margin = 0.001;
    Scene scene(options);
    constexpr double kLength = 2.0;
    const auto turned = [](double angle) { return Pose(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ())); };
    Body stick = ballOf("stick", kLength * turn / 0.01 * 1.001);
    stick.shapes = {test::shapeOf(Shape::box({kLength, 0.01, 0.01}))};
    stick.shapes[0].body_from_shape.translation() << 0.5 * kLength, 0, 0;
    const BodyId id = put(scene, stick, turned(-0.5 * turn), std::chrono::milliseconds(1));
    Body post = test::ball("post", 0.01);
    post.mobility = Mobility::fixed;
    put(scene, post, at(kLength));  // the end of the stick passes it in the middle of its way
    Body wall = test::ball("wall");
    wall.mobility = Mobility::fixed;
    wall.shapes = {test::shapeOf(Shape::plane())};
    put(scene, wall, at(kLength - 0.001) * Eigen::AngleAxisd(-0.5 * M_PI, Eigen::Vector3d::UnitY()));
    Body map = test::ball("map");
    map.name = "map/cells";
    map.kind = BodyKind::map;
    map.mobility = Mobility::fixed;
    map.shapes.clear();
    const BodyId cells = put(scene, map, at(0.0));
    scene.setCells(cells, test::cellsOf(0.02, {{32768 + 100, 32768, 32768, 0}}));
    EXPECT_TRUE(commit(scene, 1)->pairs().empty());
    move(scene, id, turned(0.5 * turn), 11);
    const auto pairs = test::namedPairs(*commit(scene, 11));
    EXPECT_EQ(pairs.count({"obstacle/post", "obstacle/stick"}), 1u);
    EXPECT_EQ(pairs.count({"obstacle/stick", "obstacle/wall"}), 1u);
    EXPECT_EQ(pairs.count({"map/cells", "obstacle/stick"}), 1u);
  }
}

TEST_F(HorizonTest, IsCheckedAtTheDoor) {
  for (const double wrong : {-0.1, 61.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(test::refusalOf([&] { Scene scene(withHorizon(wrong)); }), Code::out_of_range);
  }
}

}  // namespace
}  // namespace hgrid
