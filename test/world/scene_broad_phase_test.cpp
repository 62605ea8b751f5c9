// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "hgrid_proximity/broadphase/hgrid.h"
#include "hgrid_proximity/partitions/partitions.h"
#include "test/support/scenes.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace {

using test::Random;

/// What a snapshot says, in a form that tests can compare.
struct Said {
  std::vector<std::tuple<std::uint32_t, std::uint32_t, double, double>> pairs;
  std::size_t found = 0, events = 0;
  bool truncated = false;
  std::vector<ProxyId> near, in_sphere, along;
  bool operator==(const Said& other) const {
    return pairs == other.pairs && found == other.found && events == other.events && truncated == other.truncated &&
           near == other.near && in_sphere == other.in_sphere && along == other.along;
  }
};

Said saidBy(const Snapshot& snapshot) {
  Said said;
  for (const NearPair& pair : snapshot.pairs()) said.pairs.emplace_back(pair.first, pair.second, pair.gap, pair.margin);
  said.found = snapshot.pairsFound();
  said.events = snapshot.events().size();
  said.truncated = snapshot.truncated();
  std::vector<NearHit> near;
  snapshot.broadPhase().nearest({0.3, 0.1, 0.0}, 5, 10.0, near);
  for (const NearHit& hit : near) said.near.push_back(hit.id);
  snapshot.broadPhase().overlapping(Sphere{{0.5, 0.0, 0.0}, 1.0}, said.in_sphere);
  std::vector<SegmentHit> hits;
  snapshot.broadPhase().along(Segment{{-3, -2, 0}, {3, 2, 1}, 0.1}, hits);
  for (const SegmentHit& hit : hits) said.along.push_back(hit.id);
  return said;
}

/// Makes ticks in which bodies move, come and go, with a broad phase of this type; without a type, with the usual one.
std::vector<Said> ticksWith(std::optional<BroadPhaseType> type, unsigned seed, std::size_t max_pairs) {
  SceneOptions options;
  if (type) options.broad_phase = [type](double edge, int threads) { return makeBroadPhase({*type, edge, threads}); };
  options.max_pairs = max_pairs;
  Scene scene(options);
  Random random(seed);
  std::vector<BodyId> bodies;
  for (int i = 0; i < 60; ++i) bodies.push_back(test::putRandom(scene, random, "b" + std::to_string(i)));
  std::vector<Said> said;
  std::vector<std::shared_ptr<const Snapshot>> kept;  // several snapshots exist at the same time
  for (int tick = 1; tick <= 12; ++tick) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (scene.body(bodies[i]).mobility == Mobility::fixed || !random.chance(tick % 3 == 0 ? 1.0 : 0.2)) continue;
      Pose pose = scene.poseOf(bodies[i]).world_from_body;
      pose.translation() += test::randomVector(random, -0.3, 0.3);
      scene.place(bodies[i], pose, Time{tick});
    }
    if (tick % 4 == 0) {
      scene.remove(bodies.back());
      bodies.back() = test::putRandom(scene, random, "n" + std::to_string(tick));
    }
    kept.push_back(scene.commit(Time{tick}, {}));
    if (kept.size() > 3) kept.erase(kept.begin());
    said.push_back(saidBy(*kept.back()));
  }
  return said;
}

/// Claim: the type of the broad phase changes neither pairs nor events nor answers, also if the pairs are cut.
TEST(SceneBroadPhase, AllTypesSayTheSame) {
  for (const std::size_t max_pairs : {std::size_t{100000}, std::size_t{20}}) {
    const std::vector<Said> expected = ticksWith({}, 3, max_pairs);
    EXPECT_GT(expected.back().pairs.size(), 15u);
    EXPECT_EQ(expected.back().truncated, max_pairs == 20);
    EXPECT_FALSE(expected.back().in_sphere.empty());
    EXPECT_FALSE(expected.back().along.empty());
    for (const BroadPhaseType type : broadPhaseTypes()) {
      SCOPED_TRACE(name(type));
      const std::vector<Said> said = ticksWith(type, 3, max_pairs);
      for (std::size_t tick = 0; tick < said.size(); ++tick) ASSERT_TRUE(said[tick] == expected[tick]) << tick;
    }
  }
}

TEST(SceneBroadPhase, IsMadeForTheEdgeAndTheThreadsOfTheScene) {
  SceneOptions options;
  options.finest_edge = 0.5;
  options.threads = 2;
  std::vector<std::pair<double, int>> asked;
  options.broad_phase = [&](double edge, int threads) {
    asked.emplace_back(edge, threads);
    return std::make_unique<HGrid>();
  };
  Scene scene(options);
  const auto snapshot = scene.commit(Time{1}, {});
  EXPECT_EQ(asked, (std::vector<std::pair<double, int>>{{0.5, 2}}));
  EXPECT_EQ(snapshot->broadPhase().size(), 0u);
}

TEST(SceneBroadPhase, MustNotBeNull) {
  SceneOptions options;
  options.broad_phase = [](double, int) { return nullptr; };
  Scene scene(options);
  EXPECT_THROW(scene.commit(Time{1}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace hgrid
