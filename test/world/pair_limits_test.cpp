// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests which pairs a snapshot lists if there are more than SceneOptions::max_pairs pairs.
#include <gtest/gtest.h>

#include <numeric>
#include <tuple>

#include "hgrid_proximity/explain/explain.h"
#include "hgrid_proximity/queries/query.h"
#include "test/support/maps.h"
#include "test/support/rules.h"

namespace hgrid {
namespace {

using test::at;
using test::Random;

constexpr std::size_t kCollected = 65536;  // number of pairs of boxes that a tick collects if max_pairs is small

using Pairs = std::vector<NearPair>;

bool same(const Pairs& a, const Pairs& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const NearPair& one, const NearPair& other) {
    return std::tie(one.first, one.second, one.gap, one.margin, one.since, one.flags) ==
           std::tie(other.first, other.second, other.gap, other.margin, other.since, other.flags);
  });
}

/// A reference for the selection. Returns the `most` pairs with the smallest gaps. Among pairs with equal gaps, the
/// first by name are taken. The result is sorted by name.
Pairs nearestOf(Pairs pairs, std::size_t most) {
  std::sort(pairs.begin(), pairs.end(), [](const NearPair& a, const NearPair& b) {
    return std::tie(a.gap, a.first, a.second) < std::tie(b.gap, b.first, b.second);
  });
  pairs.resize(std::min(pairs.size(), most));
  std::sort(pairs.begin(), pairs.end(), [](const NearPair& a, const NearPair& b) {
    return std::tie(a.first, a.second) < std::tie(b.first, b.second);
  });
  return pairs;
}

/// Claim: a snapshot lists the pairs with the smallest gaps. Among pairs with equal gaps, it lists the first by name.
/// This also holds for bodies with several shapes, for maps, and for pairs that are near because of the horizon.
TEST(PairLimits, ListTheNearestPairs) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    SceneOptions options;
    options.margin = 0.25;
    options.horizon = seed % 2 == 0 ? 0.5 : 0.0;
    Random random(seed);
    const auto snapshotOf = [&](std::size_t max_pairs) {
      options.max_pairs = max_pairs;
      Scene scene(options);
      Random same_world(seed);
      const BodyId map = test::put(scene, test::mapBody("room", Mobility::moving), at(0));
      scene.setCells(map, test::cellsOf(0.1, test::randomVoxels(same_world, 100, 20)));
      for (int i = 0; i < 40; ++i) test::putRandom(scene, same_world, std::to_string(i), 2.0);
      return scene.commit(Time{1}, {});
    };
    const auto all = snapshotOf(0);
    EXPECT_FALSE(all->truncated());
    EXPECT_EQ(all->pairsFound(), all->pairs().size());
    for (const std::size_t most : {std::size_t{1}, std::size_t(random.between(2, 60)), all->pairs().size() - 1,
                                   all->pairs().size(), all->pairs().size() + 1}) {
      const auto some = snapshotOf(most);
      ASSERT_TRUE(same(some->pairs(), nearestOf(all->pairs(), most))) << most;
      EXPECT_EQ(some->truncated(), most < all->pairs().size());
      EXPECT_FALSE(some->searchCut());
      EXPECT_EQ(some->pairsFound(), all->pairs().size());
    }
  }
}

/// 500 small bodies that are all within the margin of each other. They form more pairs than a tick collects.
class Pile {
 public:
  static constexpr int kBodies = 500;
  static constexpr std::size_t kPairs = kBodies * (kBodies - 1) / 2, kListed = 1000;

  /// @param order  indices of the bodies in the order in which they are added
  Pile(SceneOptions options, const std::vector<int>& order) : scene_(withLimit(options)), ids_(kBodies) {
    for (const int i : order) ids_[std::size_t(i)] = scene_.add(test::ball(nameOf(i), 0.005));
    for (int i = 0; i < kBodies; ++i) place(i, poseOf(i));
  }
  void place(int i, const Pose& pose) {
    scene_.place(ids_[std::size_t(i)], pose, Time{1});
    scene_.setState(ids_[std::size_t(i)], Freshness::fresh, 0.0);
  }
  std::shared_ptr<const Snapshot> commit() { return scene_.commit(Time{1}, {}); }
  Scene& scene() { return scene_; }

  static std::string nameOf(int i) { return std::to_string(1000 + i); }
  static Pose poseOf(int i) {
    Random random(std::uint64_t(i) + 77);
    return at(random.uniform(0, 0.05), random.uniform(0, 0.05), random.uniform(0, 0.05));
  }
  static SceneOptions withLimit(SceneOptions options) {
    options.margin = 0.1;
    options.max_pairs = kListed;
    return options;
  }

 private:
  Scene scene_;
  std::vector<BodyId> ids_;
};

std::vector<int> ascending() {
  std::vector<int> order(Pile::kBodies);
  std::iota(order.begin(), order.end(), 0);
  return order;
}

/// Returns the pairs that a snapshot of the pile must list: the nearest of the first kCollected pairs, sorted by name.
Pairs expectedOf(const Snapshot& snapshot) {
  Pairs collected;
  for (std::uint32_t i = 0; i < Pile::kBodies; ++i) {
    for (std::uint32_t j = i + 1; j < Pile::kBodies && collected.size() < kCollected; ++j) {
      collected.push_back({i, j, distance(snapshot.boxes()[i], snapshot.boxes()[j]), 0.1, Time{1}, 0});
    }
  }
  return nearestOf(collected, Pile::kListed);
}

TEST(PairLimits, StopCollectingByName) {
  ASSERT_GT(Pile::kPairs, kCollected);
  Pile pile({}, ascending());
  const auto snapshot = pile.commit();
  EXPECT_TRUE(snapshot->truncated());
  EXPECT_TRUE(snapshot->searchCut());
  EXPECT_EQ(snapshot->pairsFound(), kCollected);
  EXPECT_TRUE(same(snapshot->pairs(), expectedOf(*snapshot)));
}

/// Claim: the list does not depend on the number of threads, on the order in which bodies were added, or on earlier
/// ticks.
TEST(PairLimits, SelectTheSamePairsInEveryHistory) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<int> order = ascending();
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[std::size_t(random.below(int(i)))]);
    SceneOptions options;
    options.threads = random.between(1, 3);
    Pile pile(options, order);
    const double share = random.uniform(0, 1) * random.uniform(0, 1);
    for (int tick = 0; tick < 4; ++tick) {  // some bodies move away and come back
      for (int i = 0; i < Pile::kBodies; ++i) {
        if (random.chance(share)) pile.place(i, tick % 2 == 0 ? at(i) : Pile::poseOf(i));
      }
      pile.commit();
    }
    for (int i = 0; i < Pile::kBodies; ++i) pile.place(i, Pile::poseOf(i));
    const auto snapshot = pile.commit();
    ASSERT_TRUE(same(snapshot->pairs(), expectedOf(*snapshot)));
  }
}

TEST(PairLimits, ThatAreZeroListAllPairs) {
  SceneOptions options;
  options.max_pairs = 0;
  Scene scene(options);
  for (int i = 0; i < Pile::kBodies; ++i) test::put(scene, test::ball(Pile::nameOf(i)), Pile::poseOf(i));
  const auto snapshot = scene.commit(Time{1}, {});
  EXPECT_FALSE(snapshot->truncated());
  EXPECT_EQ(snapshot->pairs().size(), Pile::kPairs);
}

/// Claim: if a rule switches off all pairs of a pile, the search for pairs still takes bounded work. The snapshot says
/// that the search stopped at its limit.
TEST(PairLimits, ApplyToPairsThatARuleSwitchesOff) {
  SceneOptions options;
  options.max_pairs = 1000;
  options.allowed_pairs = {test::allow("obstacle/*", "obstacle/*")};
  for (const int bodies : {1000, 1800}) {
    Scene scene(options);
    for (int i = 0; i < bodies; ++i) test::put(scene, test::ball(std::to_string(i)), at(0));
    const auto snapshot = scene.commit(Time{1}, {});
    EXPECT_TRUE(snapshot->pairs().empty());
    EXPECT_EQ(snapshot->truncated(), bodies == 1800) << "the search must stop after 16 * 65536 + 32 * bodies overlaps";
    EXPECT_EQ(snapshot->searchCut(), snapshot->truncated());
  }
}

/// Claim: in a pile of 100,000 bodies in one place, the search stops at its limits, and the nearest of the pairs that
/// it found are listed. Queries find all bodies.
TEST(PairLimits, BoundTheSearchInAPileOf100000Bodies) {
  constexpr int kBodies = 100000;
  SceneOptions options;
  options.max_pairs = 1000;
  options.max_bodies = kBodies;
  Scene scene(options);
  std::vector<Body> bodies;
  for (int i = 0; i < kBodies; ++i) bodies.push_back(test::ball(std::to_string(i), 0.01));
  for (const BodyId id : scene.exchange({}, bodies)) {
    scene.place(id, at(1, 2, 3), Time{1});
    scene.setState(id, Freshness::fresh, 0.0);
  }
  const auto snapshot = scene.commit(Time{1}, {});
  EXPECT_TRUE(snapshot->truncated());
  EXPECT_TRUE(snapshot->searchCut());
  EXPECT_EQ(snapshot->pairsFound(), kCollected);
  EXPECT_EQ(snapshot->pairs().size(), options.max_pairs);
  EXPECT_EQ(query(*snapshot, Sphere{{1, 2, 3}, 0.1}, {}).total, std::uint64_t(kBodies));
}

TEST(PairLimits, DoNotApplyToFixedBodiesAmongEachOther) {
  SceneOptions options;
  options.max_pairs = 1000;
  Scene scene(options);
  for (int i = 0; i < 3000; ++i) test::put(scene, test::ball(std::to_string(i), 0.5, Mobility::fixed), at(0));
  EXPECT_FALSE(scene.commit(Time{1}, {})->truncated());
}

/// Claim: a tick collects at most kCollected pairs with maps. It collects the pairs of the first map by name first. For
/// each map, it collects the pairs in the order of the names of the other bodies.
TEST(PairLimits, ApplyToPairsWithMaps) {
  constexpr int kMaps = 270, kBodies = 250;
  SceneOptions options;
  options.max_pairs = 1000;
  options.allowed_pairs = {test::allow("obstacle/*", "obstacle/*")};
  Scene scene(options);
  const auto cells = test::cellsOf(0.1, {{Voxel::kOriginKey, Voxel::kOriginKey, Voxel::kOriginKey, 0}});
  for (int i = 0; i < kMaps; ++i) {
    scene.setCells(test::put(scene, test::mapBody(std::to_string(1000 + i)), at(0)), cells);
  }
  std::vector<BodyId> bodies;
  for (int i = 0; i < kBodies; ++i) {
    bodies.push_back(test::put(scene, test::ball(std::to_string(1000 + i), 0.01), at(1.0 + i)));
  }
  EXPECT_FALSE(scene.commit(Time{1}, {})->truncated());
  for (int i = 0; i < kBodies; ++i) scene.place(bodies[std::size_t(i)], at(0.19 - 0.0001 * i, 0.05, 0.05), Time{2});
  const auto snapshot = scene.commit(Time{2}, {});
  EXPECT_TRUE(snapshot->searchCut());
  EXPECT_EQ(snapshot->pairsFound(), kCollected);
  Pairs collected;
  for (std::uint32_t map = 0; map < kMaps; ++map) {
    for (std::uint32_t body = kMaps; body < kMaps + kBodies && collected.size() < kCollected; ++body) {
      collected.push_back({map, body, snapshot->gapOf(map, body), 0.1, Time{2}, 0});
    }
  }
  EXPECT_TRUE(same(snapshot->pairs(), nearestOf(collected, 1000)));
}

TEST(PairLimits, LeaveQueriesAlone) {
  Pile pile({}, ascending());
  const auto snapshot = pile.commit();
  ASSERT_TRUE(snapshot->truncated());
  EXPECT_TRUE(snapshot->complete());
  EXPECT_EQ(query(*snapshot, Sphere{{5, 0, 0}, 0.5}, {}).verdict, Verdict::clear);
  EXPECT_EQ(query(*snapshot, Sphere{{0, 0, 0}, 0.5}, {}).total, std::uint64_t(Pile::kBodies));
}

TEST(PairLimits, AreNamedWhereAPairIsExplained) {
  SceneOptions options;
  options.max_pairs = 1;
  Scene scene(options);
  test::put(scene, test::ball("a"), at(0));
  test::put(scene, test::ball("b"), at(1.05));
  test::put(scene, test::ball("c"), at(-1.0));
  test::put(scene, test::ball("d"), at(0, 5));
  const auto snapshot = scene.commit(Time{1}, {});
  const Explanation cut = explain(*snapshot, "obstacle/a", "obstacle/b", nullptr);
  EXPECT_FALSE(cut.reported);
  EXPECT_TRUE(cut.cut);
  EXPECT_NE(cut.text.find("obstacle/a and obstacle/b are not reported, although their boxes are 0.05 m apart, within "
                          "the margin of 0.1 m: there are more pairs than SceneOptions::max_pairs allows."),
            std::string::npos)
      << cut.text;
  EXPECT_TRUE(explain(*snapshot, "obstacle/a", "obstacle/c", nullptr).reported);
  EXPECT_FALSE(explain(*snapshot, "obstacle/a", "obstacle/d", nullptr).cut)
      << "a pair beyond its margin was not removed by truncation";
}

}  // namespace
}  // namespace hgrid
