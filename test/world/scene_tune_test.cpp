// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests of Scene::tune(): settings that change between two commits.
#include <gtest/gtest.h>

#include <limits>

#include "test/support/events.h"
#include "test/support/random.h"
#include "test/support/refusals.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::at;
using test::Random;

SceneOptions optionsWith(const SceneTuning& tuning) {
  SceneOptions options;
  options.margin = tuning.margin;
  options.event_hysteresis = tuning.event_hysteresis;
  options.growth_cap = tuning.growth_cap;
  options.horizon = tuning.horizon;
  return options;
}

SceneTuning randomTuning(Random& random) {
  return {test::sixtyFourths(random, 0, 1), test::sixtyFourths(random, 0, 0.5), test::sixtyFourths(random, 0, 1),
          random.chance(0.5) ? 0.0 : test::sixtyFourths(random, 0, 1)};
}

/// The same random bodies in each scene, some of them with old poses.
class Crowd {
 public:
  Crowd(Random& random, int count) : random_(random) {
    for (int i = 0; i < count; ++i) bodies_.push_back(test::randomBody(random, std::to_string(i)));
    poses_.resize(bodies_.size());
    ages_.resize(bodies_.size());
    move();
  }
  void move() {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      poses_[i] = test::randomPose(random_, 3.0);
      ages_[i] = random_.chance(0.2) ? test::sixtyFourths(random_, 0, 1) : 0.0;
    }
  }
  std::vector<BodyId> addTo(Scene& scene) const { return scene.exchange({}, bodies_); }
  void place(Scene& scene, const std::vector<BodyId>& ids, Time stamp) const {
    for (std::size_t i = 0; i < ids.size(); ++i) {
      scene.place(ids[i], poses_[i], stamp);
      scene.setState(ids[i], ages_[i] > 0.25 ? Freshness::stale : Freshness::fresh, ages_[i]);
    }
  }

 private:
  Random& random_;
  std::vector<Body> bodies_;
  std::vector<Pose> poses_;
  std::vector<double> ages_;
};

void expectSamePairs(const Snapshot& snapshot, const Snapshot& expected) {
  ASSERT_EQ(snapshot.pairs().size(), expected.pairs().size());
  for (std::size_t i = 0; i < expected.pairs().size(); ++i) {
    const NearPair &pair = snapshot.pairs()[i], &other = expected.pairs()[i];
    EXPECT_EQ(pair.first, other.first);
    EXPECT_EQ(pair.second, other.second);
    EXPECT_EQ(pair.gap, other.gap);
    EXPECT_EQ(pair.margin, other.margin);
    EXPECT_EQ(pair.flags, other.flags);
  }
}

TEST(SceneTune, TheNextCommitListsThePairsOfANewSceneWithTheseSettings) {
  std::size_t pairs = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Crowd crowd(random, 30);
    Scene scene(optionsWith(randomTuning(random)));
    const std::vector<BodyId> ids = crowd.addTo(scene);
    Time stamp{0};
    for (int change = 0; change < 4; ++change) {
      crowd.move();
      crowd.place(scene, ids, stamp += std::chrono::milliseconds(20));
      scene.commit(stamp, {});
      const SceneTuning tuning = randomTuning(random);
      scene.tune(tuning);
      Scene fresh(optionsWith(tuning));
      const std::vector<BodyId> fresh_ids = crowd.addTo(fresh);
      crowd.place(fresh, fresh_ids, stamp);
      // In the first commit no body has moved, so that swept boxes are the present boxes in both scenes.
      expectSamePairs(*scene.commit(stamp, {}), *fresh.commit(stamp, {}));
      crowd.move();
      crowd.place(scene, ids, stamp += std::chrono::milliseconds(20));
      crowd.place(fresh, fresh_ids, stamp);
      const auto snapshot = scene.commit(stamp, {});
      expectSamePairs(*snapshot, *fresh.commit(stamp, {}));
      pairs += snapshot->pairs().size();
    }
  }
  EXPECT_GT(pairs, 1000u);
}

TEST(SceneTune, ARefusedChangeChangesNothing) {
  Scene scene(optionsWith({0.5, 0.1, 1.0, 0.0}));
  test::put(scene, test::ball("a"), at(0));
  test::put(scene, test::ball("b"), at(1.25));
  const std::uint64_t revision = scene.commit(Time{1}, {})->structure().revision;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::pair<SceneTuning, const char*> wrong[] = {{{-0.1, 0.2, 0.2, 0.5}, "margin is -0.1 m"},
                                                       {{0.1, 1001.0, 0.2, 0.5}, "event_hysteresis is 1001 m"},
                                                       {{0.1, 0.2, nan, 0.5}, "growth_cap is nan m"},
                                                       {{0.1, 0.2, 0.2, 61.0}, "horizon is 61 s"}};
  for (const auto& [tuning, words] : wrong) {
    std::string sentence;
    EXPECT_EQ(test::refusalOf([&, &change = tuning] { scene.tune(change); }, &sentence), Code::out_of_range);
    EXPECT_TRUE(test::says(sentence, words));
    const auto snapshot = scene.commit(Time{2}, {});
    EXPECT_EQ(snapshot->pairs().size(), 1u);
    EXPECT_EQ(snapshot->structure().revision, revision);
  }
}

TEST(SceneTune, PairsThatStayListedAreNotInterruptedAndOthersEndBecauseOfTheSettings) {
  Scene scene(optionsWith({0.5, 0.25, 1.0, 0.0}));
  test::put(scene, test::ball("a"), at(0));
  test::put(scene, test::ball("b"), at(1.125));
  test::put(scene, test::ball("c"), at(-1.4375));
  EXPECT_EQ(scene.commit(Time{1}, {})->pairs().size(), 2u);
  scene.tune({0.25, 0.25, 1.0, 0.0});
  auto snapshot = scene.commit(Time{2}, {});
  ASSERT_EQ(snapshot->pairs().size(), 1u);
  EXPECT_EQ(snapshot->pairs()[0].since, Time{1});
  EXPECT_EQ(test::eventsOf(*snapshot), std::vector<std::string>()) << "the hysteresis keeps the other pair";
  scene.tune({0.25, 0.125, 1.0, 0.0});
  EXPECT_EQ(test::eventsOf(*scene.commit(Time{3}, {})),
            std::vector<std::string>({"3 END FILTER obstacle/a obstacle/c"}));
  scene.tune({0.5, 0.125, 1.0, 0.0});
  EXPECT_EQ(test::eventsOf(*scene.commit(Time{4}, {})),
            std::vector<std::string>({"4 BEGIN FILTER obstacle/a obstacle/c"}));
}

TEST(SceneTune, ABodyThatMovedWhileTheHorizonWasOffWasNotSwept) {
  Scene scene(optionsWith({0.125, 0.0, 1.0, 0.5}));
  Body still = test::ball("still"), quick = test::ball("quick");
  still.max_speed = quick.max_speed = 0.0;
  test::put(scene, still, at(0));
  const BodyId id = test::put(scene, quick, at(-5));
  scene.commit(Time{1}, {});
  scene.tune({0.125, 0.0, 1.0, 0.0});
  scene.place(id, at(-5.5), Time{2});
  scene.commit(Time{2}, {});
  scene.place(id, at(5), Time{3});
  scene.tune({0.125, 0.0, 1.0, 0.5});
  EXPECT_TRUE(scene.commit(Time{3}, {})->pairs().empty()) << "nothing is known about the way of the body";
  scene.place(id, at(-5), Time{4});
  EXPECT_EQ(scene.commit(Time{4}, {})->pairs().size(), 1u) << "the body passed the other one";
}

}  // namespace
}  // namespace hgrid
