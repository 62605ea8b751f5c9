// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/queries/quick_query.h"

#include <gtest/gtest.h>

#include "test/support/maps.h"
#include "test/support/rules.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace test {
namespace {

/// A query about a scene. It may be quick unless a test changes something.
struct Asked {
  std::string frame, as_body;
  std::vector<std::string> include, exclude;
  bool exact = false, respect_allowed = false;

  bool isQuick(Scene& scene, const std::vector<SourceGap>& gaps = {}) const {
    Tick tick;
    tick.world_frame = "world";
    tick.snapshot = scene.commit(Time{1}, gaps);
    return mayBeQuick({frame, include, exclude, 0, exact, respect_allowed, as_body, std::nullopt}, tick);
  }
  bool isQuick() const {
    Scene scene{SceneOptions{}};
    put(scene, ball("one"), at(0));
    return isQuick(scene);
  }
};

TEST(QuickQuery, AsksForBoxesOfAllBodiesInTheWorldFrame) {
  EXPECT_TRUE(Asked().isQuick());
  const auto isQuickWith = [](const auto& change) {
    Asked asked;
    change(asked);
    return asked.isQuick();
  };
  EXPECT_TRUE(isQuickWith([](Asked& asked) { asked.frame = "world"; }));
  EXPECT_TRUE(isQuickWith([](Asked& asked) { asked.frame = "/world"; }));
  EXPECT_FALSE(isQuickWith([](Asked& asked) { asked.frame = "base"; }));
  EXPECT_FALSE(isQuickWith([](Asked& asked) { asked.exact = true; }));
  EXPECT_FALSE(isQuickWith([](Asked& asked) { asked.include = {"*"}; }));
  EXPECT_FALSE(isQuickWith([](Asked& asked) { asked.exclude = {"x"}; }));
  EXPECT_FALSE(isQuickWith([](Asked& asked) { asked.respect_allowed = true; }));
}

TEST(QuickQuery, AsksASmallWorldWithoutMaps) {
  Scene boxes{SceneOptions{}};
  for (std::size_t i = 0; i < kQuickBoxes; ++i) put(boxes, ball(std::to_string(i)), at(static_cast<double>(3 * i)));
  EXPECT_TRUE(Asked().isQuick(boxes));
  put(boxes, ball("one more"), at(-3));
  EXPECT_FALSE(Asked().isQuick(boxes));

  Scene map{SceneOptions{}};
  map.setCells(put(map, mapBody("room"), at(0)), cellsOf(0.1, {}));
  EXPECT_FALSE(Asked().isQuick(map));

  Scene gaps{SceneOptions{}};
  put(gaps, ball("one"), at(0));
  std::vector<SourceGap> few(kQuickGaps);
  EXPECT_TRUE(Asked().isQuick(gaps, few));
  few.emplace_back();
  EXPECT_FALSE(Asked().isQuick(gaps, few));

  SceneOptions options;
  for (std::size_t i = 0; i < kQuickRules; ++i) options.allowed_pairs.push_back(allow("a" + std::to_string(i), "b"));
  Scene rules{options};
  put(rules, ball("one"), at(0));
  EXPECT_TRUE(Asked().isQuick(rules));
  options.allowed_pairs.push_back(allow("a", "b"));
  Scene more_rules{options};
  put(more_rules, ball("one"), at(0));
  EXPECT_FALSE(Asked().isQuick(more_rules));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
