// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Queries with QueryScope::respect_allowed leave out the bodies that a given body may touch.
#include <gtest/gtest.h>

#include "hgrid_proximity/queries/query.h"
#include "test/support/maps.h"
#include "test/support/refusals.h"
#include "test/support/scenes.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace test {
namespace {

QueryScope respecting(const Snapshot& snapshot, const std::string& body) {
  QueryScope scope;
  scope.respect_allowed = indexOf(snapshot, body);
  return scope;
}

/// Returns the bodies of the hits for which `left_out` returns false.
template <class LeftOut>
std::vector<std::uint32_t> bodiesOf(const QueryAnswer& answer, const LeftOut& left_out) {
  std::vector<std::uint32_t> bodies;
  for (const QueryHit& hit : answer.hits) {
    if (!left_out(hit.body)) bodies.push_back(hit.body);
  }
  return bodies;
}

TEST(AllowedScope, LeavesOutTheBodyAndWhatItMayTouchAndNothingElse) {
  std::size_t kept = 0, gone = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    SceneOptions options;
    for (int i = 0; i < 6; ++i) {
      options.allowed_pairs.push_back({"obstacle/o" + std::to_string(random.below(25)),
                                       random.chance(0.5) ? "*" + std::to_string(random.below(10)) : "map/*", "rule"});
    }
    Scene scene(options);
    for (int i = 0; i < 25; ++i) putRandom(scene, random, "o" + std::to_string(i), 2.0);
    scene.setCells(put(scene, mapBody("room"), randomPose(random, 1.0)), cellsOf(0.1, randomVoxels(random, 50, 15)));
    const auto snapshot = scene.commit(Time{1}, {});
    for (int i = 0; i < 30; ++i) {
      QueryScope scope;
      scope.respect_allowed = std::uint32_t(random.below(int(snapshot->structure().bodies.size())));
      const auto left_out = [&](std::uint32_t body) {
        return body == scope.respect_allowed || snapshot->structure().filter.allowed(body, scope.respect_allowed);
      };
      const auto none = [](std::uint32_t) { return false; };
      const Sphere sphere{randomVector(random, -2, 2), random.uniform(0, 2)};
      const Segment segment{sphere.center, randomVector(random, -2, 2), 0.1};
      const QueryAnswer all[] = {query(*snapshot, sphere, {}), query(*snapshot, segment, {})};
      const QueryAnswer some[] = {query(*snapshot, sphere, scope), query(*snapshot, segment, scope)};
      for (int kind = 0; kind < 2; ++kind) {
        const std::vector<std::uint32_t> expected = bodiesOf(all[kind], left_out);
        ASSERT_EQ(bodiesOf(some[kind], none), expected);
        ASSERT_EQ(some[kind].verdict, expected.empty() ? Verdict::clear : Verdict::hit);
        kept += expected.size();
        gone += all[kind].hits.size() - expected.size();
      }
      QueryScope everything;
      everything.limit = 1000;
      scope.limit = 3;
      std::vector<std::uint32_t> nearest_three = bodiesOf(nearest(*snapshot, sphere.center, 0.0, everything), left_out);
      nearest_three.resize(std::min<std::size_t>(3, nearest_three.size()));
      ASSERT_EQ(bodiesOf(nearest(*snapshot, sphere.center, 0.0, scope), none), nearest_three);
    }
  }
  EXPECT_GT(kept, 500u);
  EXPECT_GT(gone, 100u);
}

/// A world with a tool that may touch the cup and the cloud of the camera, but not the box.
class AllowedDoubt : public ::testing::Test {
 protected:
  AllowedDoubt() {
    put(scene_, ball("tool"), at(-20));
    for (const char* name : {"cup", "box"}) {
      Body body = ball(name);
      body.max_speed = 1.0;
      ids_[name] = put(scene_, body, at(0));
    }
    Body cloud = mapBody("front", Mobility::moving);
    cloud.name = "cloud/front";
    cloud.kind = BodyKind::cloud;
    ids_["cloud"] = put(scene_, cloud, at(0));
    scene_.setCells(ids_["cloud"], cellsOf(0.1, {}));
  }
  static SceneOptions options() {
    SceneOptions options;
    options.allowed_pairs = {{"obstacle/tool", "obstacle/cup", ""}, {"obstacle/tool", "cloud/front", ""}};
    return options;
  }
  Verdict verdict(const std::vector<SourceGap>& gaps = {}) {
    const auto snapshot = scene_.commit(Time{++tick_}, gaps);
    EXPECT_EQ(query(*snapshot, Sphere{{3, 0, 0}, 0.5}, {}).verdict, Verdict::unknown)
        << "without respect_allowed, the answer must be UNKNOWN";
    return query(*snapshot, Sphere{{3, 0, 0}, 0.5}, respecting(*snapshot, "obstacle/tool")).verdict;
  }

  Scene scene_{options()};
  std::map<std::string, BodyId> ids_;
  int tick_ = 0;
};

TEST_F(AllowedDoubt, AStaleBodyThatMayBeTouchedLeavesNone) {
  scene_.setState(ids_["cup"], Freshness::lost, 10.0);
  EXPECT_EQ(verdict(), Verdict::clear);
}

TEST_F(AllowedDoubt, AnotherStaleBodyDoes) {
  scene_.setState(ids_["box"], Freshness::lost, 10.0);
  EXPECT_EQ(verdict(), Verdict::unknown);
}

TEST_F(AllowedDoubt, ALostCloudThatMayBeTouchedLeavesNone) {
  scene_.setState(ids_["cloud"], Freshness::lost, 1.0);
  EXPECT_EQ(verdict(), Verdict::clear);
  EXPECT_EQ(verdict({{"cloud/front", "cloud/front", "LOST cloud/front"}}), Verdict::clear);
}

TEST_F(AllowedDoubt, AGapThatMayHideOtherBodiesDoes) {
  EXPECT_EQ(verdict({{"cloud/rear", "cloud/rear", "LOST cloud/rear"}}), Verdict::unknown);
  EXPECT_EQ(verdict({{"cloud/front", "cloud/*", "LOST all clouds"}}), Verdict::unknown);
}

TEST(AllowedScope, AMapThatMayBeTouchedNeedNotKnowTheSpace) {
  SceneOptions options;
  options.report_unmapped = true;
  options.allowed_pairs = {{"obstacle/tool", "map/*", ""}};
  Scene scene(options);
  put(scene, ball("tool"), at(0));
  scene.setCells(put(scene, mapBody("room"), at(0)), cellsOf(0.1, {}));
  const auto snapshot = scene.commit(Time{1}, {});
  EXPECT_EQ(query(*snapshot, Sphere{{3, 0, 0}, 0.5}, {}).because, Unknown::unmapped);
  EXPECT_EQ(query(*snapshot, Sphere{{3, 0, 0}, 0.5}, respecting(*snapshot, "obstacle/tool")).verdict, Verdict::clear);
}

TEST(AllowedScope, RefusesABodyThatIsNotThere) {
  Scene scene{SceneOptions{}};
  put(scene, ball("a"), at(0));
  const auto snapshot = scene.commit(Time{1}, {});
  QueryScope scope;
  scope.respect_allowed = 1;
  EXPECT_EQ(refusalOf([&] { query(*snapshot, Sphere{{0, 0, 0}, 1}, scope); }), Code::unknown_id);
  EXPECT_EQ(refusalOf([&] { nearest(*snapshot, 0u, 1.0, scope); }), Code::unknown_id);
  scope.respect_allowed = 0;
  EXPECT_EQ(query(*snapshot, Sphere{{0, 0, 0}, 1}, scope).verdict, Verdict::clear)
      << "the body of respect_allowed must not be a hit";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
