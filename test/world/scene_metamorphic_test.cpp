// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>

#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::contains;
using test::namedPairs;
using test::NamePairs;
using test::Random;

/// The settings that a test varies. Everything else in the random world depends only on the seed.
struct Variation {
  double margin = 0.125;
  int count = 40;
  double growth_cap = 1.0;
  bool degraded = false;   ///< whether no body is FRESH
  bool backwards = false;  ///< whether the bodies are added in the opposite order
  double finest_edge = 0.0;
  int threads = 1;
  std::function<std::string(int)> name = [](int i) { return "o" + std::to_string(i); };
};

std::shared_ptr<const Snapshot> snapshotOf(unsigned seed, const Variation& variation) {
  SceneOptions options;
  options.margin = variation.margin;
  options.growth_cap = variation.growth_cap;
  options.finest_edge = variation.finest_edge;
  options.threads = variation.threads;
  Scene scene(options);
  std::vector<int> order;
  for (int i = 0; i < variation.count; ++i) order.push_back(i);
  if (variation.backwards) std::reverse(order.begin(), order.end());
  for (const int i : order) {
    Random random(seed * 1000 + unsigned(i));
    const BodyId id = test::putRandom(scene, random, variation.name(i));
    const auto state = static_cast<Freshness>(random.between(1, 5));
    if (variation.degraded) scene.setState(id, state, random.uniform(0, 5), std::uint32_t(random.below(3)));
  }
  return scene.commit(Time{1}, {});
}

TEST(SceneMetamorphic, ALargerMarginFindsNoFewerPairs) {
  std::size_t more = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    NamePairs before;
    for (const double margin : {0.0, 0.01, 0.125, 0.5, 2.0}) {
      Variation variation;
      variation.margin = margin;
      const NamePairs pairs = namedPairs(*snapshotOf(seed, variation));
      ASSERT_TRUE(contains(pairs, before)) << "margin " << margin;
      more += pairs.size() > before.size();
      before = pairs;
    }
  }
  EXPECT_GT(more, 60u);
}

TEST(SceneMetamorphic, WorseDataNeverMeansFewerPairs) {
  std::size_t more = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Variation variation;
    const NamePairs fresh = namedPairs(*snapshotOf(seed, variation));
    for (const double cap : {0.0, 0.25, 1.0}) {
      variation.growth_cap = cap;
      variation.degraded = true;
      const NamePairs degraded = namedPairs(*snapshotOf(seed, variation));
      ASSERT_TRUE(contains(degraded, fresh)) << "cap " << cap;
      if (cap == 0.0) {
        ASSERT_EQ(degraded, fresh);
      }
      more += degraded.size() > fresh.size();
    }
  }
  EXPECT_GT(more, 60u) << "growth has too little effect in these worlds to be tested";
}

TEST(SceneMetamorphic, AddingABodyRemovesNoPairAndRemovingOneRemovesOnlyItsOwn) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Variation variation;
    const NamePairs all = namedPairs(*snapshotOf(seed, variation));
    variation.count -= 1;
    const NamePairs without = namedPairs(*snapshotOf(seed, variation));
    ASSERT_TRUE(contains(all, without));
    const std::string last = "obstacle/o" + std::to_string(variation.count);
    for (const auto& pair : all) {
      ASSERT_TRUE(without.count(pair) != 0 || pair.first == last || pair.second == last);
    }
  }
}

TEST(SceneMetamorphic, OrderCellsAndThreadsDoNotShow) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto expected = snapshotOf(seed, {});
    for (int i = 0; i < 4; ++i) {
      Variation variation;
      variation.backwards = i % 2 == 1;
      variation.threads = 1 + i % 3;
      variation.finest_edge = i < 2 ? 0.0 : std::ldexp(1.0, 10 * i - 30);
      const auto snapshot = snapshotOf(seed, variation);
      ASSERT_EQ(snapshot->boxes(), expected->boxes());
      ASSERT_EQ(snapshot->pairs().size(), expected->pairs().size());
      for (std::size_t k = 0; k < snapshot->pairs().size(); ++k) {
        const NearPair &a = snapshot->pairs()[k], &b = expected->pairs()[k];
        ASSERT_TRUE(a.first == b.first && a.second == b.second && a.gap == b.gap && a.margin == b.margin);
      }
    }
  }
}

/// Returns the pairs of a snapshot, with the numbers of the bodies instead of their names.
std::map<std::pair<int, int>, std::pair<double, double>> numberedPairs(const Snapshot& snapshot,
                                                                       const Variation& variation) {
  std::map<std::string, int> number;
  for (int i = 0; i < variation.count; ++i) number["obstacle/" + variation.name(i)] = i;
  std::map<std::pair<int, int>, std::pair<double, double>> pairs;
  const BodyList& bodies = snapshot.structure().bodies;
  for (const NearPair& pair : snapshot.pairs()) {
    const auto both = std::minmax(number.at(bodies[pair.first].name), number.at(bodies[pair.second].name));
    pairs[both] = {pair.gap, pair.margin};
  }
  return pairs;
}

/// Claim: bodies with other names form the same pairs, with the same gaps and margins. The names only change the order.
TEST(SceneMetamorphic, NamesDoNotShow) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto expected = numberedPairs(*snapshotOf(seed, {}), {});
    ASSERT_GT(expected.size(), 10u);
    Variation reversed, scattered, longer;
    reversed.name = [](int i) { return std::to_string(1000 - i); };
    scattered.name = [](int i) { return std::to_string((i + 1) * 7919 % 1009); };
    longer.name = [](int i) { return std::string(std::size_t(i + 1), 'x'); };
    for (const Variation& variation : {reversed, scattered, longer}) {
      EXPECT_EQ(numberedPairs(*snapshotOf(seed, variation), variation), expected) << variation.name(0);
    }
  }
}

}  // namespace
}  // namespace hgrid
