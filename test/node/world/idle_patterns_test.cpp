// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/robots/idle_patterns.h"

#include <gtest/gtest.h>

namespace hgrid {
namespace {

const std::vector<std::string> kBodies = {"arm/hand", "obstacle/post"};
const std::vector<std::string> kBare = {"arm/flange"};  // links without collision geometry

using Warnings = std::vector<std::string>;

TEST(IdlePatterns, AreNamedWithTheirParameter) {
  Params params;
  params.margins = {{"arm/*", 0.1}, {"amr/*", 0.2}};
  params.padding = {{"arm/flange", 0.1}};
  EXPECT_EQ(idlePatterns(params, kBodies, kBare),
            (Warnings{"~margins: 'amr/*' matches no body", "~padding: 'arm/flange' matches no body"}));
}

TEST(IdlePatterns, WithAQuestionMarkMayBeMeantAsGlobs) {
  Params params;
  params.padding = {{"arm/han?", 0.1}};
  EXPECT_EQ(idlePatterns(params, kBodies, kBare),
            (Warnings{"~padding: 'arm/han?' matches no body; only * stands for other characters"}));
}

TEST(IdleMargins, AreBelowTheMarginOfAllBodiesOrHiddenByALaterEntry) {
  Params params;
  params.margin = 0.1;
  params.margins = {{"arm/*", 0.1}, {"arm/hand", 0.05}, {"obstacle/*", 0.3}};
  params.pair_margins = {{"arm/hand", "obstacle/*", 0.01}, {"arm/*", "arm/*", 0.02}, {"obstacle/*", "arm/*", 0.05}};
  EXPECT_EQ(idleMargins(params),
            (Warnings{"~margins: 'arm/hand' has 0.05 m, but ~margin is 0.1 m for all bodies; only ~pair_margins can be "
                      "smaller",
                      "~pair_margins: 'arm/hand' with 'obstacle/*' has no effect, because a later entry matches the "
                      "same pairs; put the general one first"}));
}

TEST(IdlePatterns, ForMapsAreNotReported) {
  Params params;
  params.margins = {{"map/hall", 0.1}, {"map/*", 0.1}, {"map*", 0.1}};
  EXPECT_EQ(idlePatterns(params, kBodies, kBare), (Warnings{"~margins: 'map*' matches no body"}))
      << "a pattern that may match other bodies is reported";
}

TEST(IdlePatterns, ThatCanMatchATrackOfAConfiguredTrackerAreNotReported) {
  Params params;
  PairRule rule;
  rule.first = rule.second = "track/*";
  params.allowed_pairs = {rule};
  params.margins = {{"track/people/7", 0.1}, {"track/*/legs", 0.1}, {"track/carts/*", 0.1}};
  const std::string margins = "~margins: 'track/", allowed = "~allowed_pairs: 'track/*' matches no body";
  EXPECT_EQ(idlePatterns(params, kBodies, kBare),
            (Warnings{margins + "people/7' matches no body", margins + "*/legs' matches no body",
                      margins + "carts/*' matches no body", allowed, allowed}))
      << "no tracker is configured";
  params.trackers.emplace_back().name = "people";
  EXPECT_EQ(idlePatterns(params, kBodies, kBare), (Warnings{margins + "carts/*' matches no body"}));
}

TEST(IdlePatterns, ThatMatchAConfiguredMapAreNotReported) {
  Params params;
  params.margins = {{"ma*/hall", 0.1}};
  EXPECT_EQ(idlePatterns(params, kBodies, kBare), (Warnings{"~margins: 'ma*/hall' matches no body"}));
  params.maps.emplace_back().name = "hall";
  EXPECT_EQ(idlePatterns(params, kBodies, kBare), Warnings());
}

TEST(IdlePatterns, OfWaiversAndVisualGeometryMayMeanLinksWithoutBodies) {
  Params params;
  params.accept_uncovered = {{"arm/flange", "thin"}, {"arm/nothing", "thin"}};
  params.use_visual = {"arm/flange", "arm/hand", "none"};
  EXPECT_EQ(idlePatterns(params, kBodies, kBare),
            (Warnings{"~accept_uncovered: 'arm/nothing' matches no body", "~use_visual: 'none' matches no body"}));
}

TEST(IdlePatterns, OfPairsAreCheckedOnBothSides) {
  Params params;
  PairMargin margin{};
  margin.first = "arm/hand";
  margin.second = "obstacle/pots";
  params.pair_margins = {margin};
  PairRule rule;
  rule.first = "none";
  rule.second = "obstacle/*";
  params.allowed_pairs = {rule};
  EXPECT_EQ(idlePatterns(params, kBodies, kBare),
            (Warnings{"~pair_margins: 'obstacle/pots' matches no body", "~allowed_pairs: 'none' matches no body"}));
}

}  // namespace
}  // namespace hgrid
