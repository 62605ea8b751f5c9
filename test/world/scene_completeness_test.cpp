// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include "hgrid_proximity/queries/query.h"
#include "test/support/refusals.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::says;

const Sphere kFarAway{{500, 500, 500}, 1.0};
const Segment kFarRay{{500, 500, 500}, {600, 500, 500}, 0.0};
const Sphere kHere{{0, 0, 0}, 1.0};

struct Cell {
  Cell() : scene(SceneOptions{}) {
    good = test::put(scene, test::ball("good"), test::at(0));
    other = test::put(scene, test::ball("other"), test::at(0.2));
  }
  const Snapshot& now(const std::vector<SourceGap>& gaps = {}) {
    snapshot = scene.commit(Time{++tick}, gaps);
    return *snapshot;
  }
  Scene scene;
  BodyId good, other;
  std::shared_ptr<const Snapshot> snapshot;
  int tick = 0;
};

/// Checks an incomplete world: queries far from all bodies answer UNKNOWN instead of CLEAR, and a query near a body
/// still answers HIT.
/// @param word  text that the first reason of the snapshot must contain
void expectDoubt(const Snapshot& snapshot, const std::string& word) {
  EXPECT_FALSE(snapshot.complete());
  ASSERT_FALSE(snapshot.reasons().empty());
  EXPECT_TRUE(says(snapshot.reasons()[0], word));
  EXPECT_GE(snapshot.reasonsTotal(), 1u);
  for (const QueryAnswer& answer : {query(snapshot, kFarAway, {}), query(snapshot, kFarRay, {})}) {
    EXPECT_EQ(answer.verdict, Verdict::unknown);
    EXPECT_FALSE(answer.reason.empty());
    EXPECT_TRUE(answer.hits.empty());
  }
  EXPECT_EQ(query(snapshot, kHere, {}).verdict, Verdict::hit);
}

TEST(Completeness, AWorldOfFreshBodiesIsComplete) {
  Cell cell;
  EXPECT_TRUE(cell.now().complete());
  EXPECT_EQ(cell.snapshot->reasonsTotal(), 0u);
  EXPECT_TRUE(cell.snapshot->reasons().empty());
  EXPECT_EQ(cell.snapshot->worstState(), Freshness::fresh);
  EXPECT_EQ(query(*cell.snapshot, kFarAway, {}).verdict, Verdict::clear);
  EXPECT_EQ(query(*cell.snapshot, kFarRay, {}).verdict, Verdict::clear);
  EXPECT_EQ(cell.snapshot->pairs().size(), 1u);
}

TEST(Completeness, AnEmptyWorldIsCompleteAndClear) {
  Scene scene{SceneOptions{}};
  const auto snapshot = scene.commit(Time{1}, {});
  EXPECT_TRUE(snapshot->complete());
  EXPECT_EQ(query(*snapshot, kHere, {}).verdict, Verdict::clear);
  EXPECT_TRUE(snapshot->pairs().empty());
}

TEST(Completeness, ABodyThatNeverHadAPoseIsMissedByName) {
  Cell cell;
  const BodyId ghost = cell.scene.add(test::ball("ghost"));
  cell.scene.setState(ghost, Freshness::fresh, 0.0);  // setState() does not place the body
  expectDoubt(cell.now(), "obstacle/ghost");
  EXPECT_EQ(cell.snapshot->poses()[test::indexOf(*cell.snapshot, "obstacle/ghost")].state, Freshness::unplaced);
  EXPECT_EQ(cell.snapshot->worstState(), Freshness::unplaced);
  EXPECT_EQ(cell.snapshot->pairs().size(), 1u) << "an unplaced body must not be in a pair";
  EXPECT_EQ(query(*cell.snapshot, kHere, {}).total, 2u) << "an unplaced body must not be a hit";
  cell.scene.place(ghost, test::at(0), Time{1});
  cell.scene.setState(ghost, Freshness::fresh, 0.0);
  EXPECT_TRUE(cell.now().complete());
  EXPECT_EQ(cell.snapshot->pairs().size(), 3u);
}

TEST(Completeness, LostFrozenAndInvalidBodiesStayWhereTheyWereAndMakeDoubt) {
  for (const Freshness state : {Freshness::lost, Freshness::frozen, Freshness::invalid}) {
    SCOPED_TRACE(name(state));
    Cell cell;
    cell.scene.setState(cell.other, state, 3.0);
    expectDoubt(cell.now(), "obstacle/other");
    EXPECT_TRUE(says(cell.snapshot->reasons()[0], name(state)));
    EXPECT_EQ(cell.snapshot->worstState(), state);
    EXPECT_EQ(cell.snapshot->pairs().size(), 1u);
    EXPECT_EQ(query(*cell.snapshot, kHere, {}).total, 2u);
    cell.scene.setState(cell.other, Freshness::fresh, 0.0);
    EXPECT_TRUE(cell.now().complete());
  }
}

TEST(Completeness, LateAndStaleBodiesAreFlaggedOnlyWhileMarginsGrowFarEnough) {
  for (const Freshness state : {Freshness::late, Freshness::stale}) {
    Cell cell;
    Body slow = test::ball("slow");
    slow.max_speed = 0.5;
    const BodyId id = test::put(cell.scene, slow, test::at(5));
    cell.scene.setState(id, state, 0.5);
    EXPECT_TRUE(cell.now().complete()) << name(state);
    EXPECT_EQ(cell.snapshot->worstState(), state);
    EXPECT_EQ(cell.snapshot->maxAge(), 0.5);
  }
}

// A stale body may have moved since the time of its pose, so a query near it must not answer CLEAR.
TEST(Completeness, WhereAStaleBodyMayHaveComeIsNotClear) {
  Cell cell;
  Body body = test::ball("drifter");
  body.max_speed = 0.5;
  const BodyId drifter = test::put(cell.scene, body, test::at(100));
  const Sphere near{{102, 0, 0}, 1.0};
  const Segment beside{{102, -5, 0}, {102, 5, 0}, 1.0};
  EXPECT_EQ(query(cell.now(), near, {}).verdict, Verdict::clear);
  cell.scene.setState(drifter, Freshness::stale, 1.5);  // the body may have moved by 0.75 m; the query is 0.5 m away
  cell.now();
  for (const QueryAnswer& answer : {query(*cell.snapshot, near, {}), query(*cell.snapshot, beside, {})}) {
    EXPECT_EQ(answer.verdict, Verdict::unknown);
    EXPECT_TRUE(says(answer.reason, "obstacle/drifter"));
    EXPECT_EQ(answer.total, 0u);
  }
  EXPECT_EQ(query(*cell.snapshot, kFarAway, {}).verdict, Verdict::clear);
  QueryScope others;
  others.exclude = {"*/drifter"};
  EXPECT_EQ(query(*cell.snapshot, near, others).verdict, Verdict::clear);
  cell.scene.setState(drifter, Freshness::stale, 0.5);
  EXPECT_EQ(query(cell.now(), near, {}).verdict, Verdict::clear)
      << "a body that may have moved by 0.25 m cannot reach a query 0.5 m away";
}

TEST(Completeness, AnUncoveredBodyMakesDoubtUnlessItIsWaived) {
  Cell cell;
  Body broken = test::obstacle("broken");
  broken.covered = false;
  broken.note = "mesh 'x.stl' is missing";
  const BodyId id = test::put(cell.scene, broken, test::at(300));
  expectDoubt(cell.now(), "obstacle/broken");
  EXPECT_TRUE(says(cell.snapshot->reasons()[0], "x.stl"));
  EXPECT_EQ(cell.snapshot->worstState(), Freshness::fresh);
  cell.scene.remove(id);
  broken.waived = true;
  const BodyId waived = test::put(cell.scene, broken, test::at(300));
  EXPECT_TRUE(cell.now().complete());
  EXPECT_EQ(query(*cell.snapshot, kFarAway, {}).verdict, Verdict::clear);
  cell.scene.setState(waived, Freshness::lost, 9.0);
  EXPECT_FALSE(cell.now().complete()) << "a waiver covers unreadable shapes, but not a lost pose";
}

TEST(Completeness, WhatElseIsMissingCounts) {
  Cell cell;
  expectDoubt(cell.now({{"left", "left/*", "robot 'left' has no description yet"}}), "robot 'left'");
  EXPECT_TRUE(cell.now().complete());
}

TEST(Completeness, ReasonsAreAllCountedAndTheWorstFewAreListed) {
  SceneOptions options;
  options.max_reasons = 3;
  Scene scene(options);
  const Freshness states[] = {Freshness::invalid, Freshness::lost, Freshness::stale, Freshness::frozen,
                              Freshness::lost};
  for (int i = 0; i < 5; ++i) {
    Body body = test::ball("b" + std::to_string(i));
    body.max_speed = 0.5;
    scene.setState(test::put(scene, body, test::at(i)), states[i], 1.0);
  }
  scene.add(test::ball("z"));
  const auto snapshot = scene.commit(Time{1}, {});
  EXPECT_EQ(snapshot->reasonsTotal(), 5u);
  ASSERT_EQ(snapshot->reasons().size(), 3u);
  EXPECT_TRUE(says(snapshot->reasons()[0], "obstacle/z"));
  EXPECT_TRUE(says(snapshot->reasons()[1], "obstacle/b0"));
  EXPECT_TRUE(says(snapshot->reasons()[2], "obstacle/b3"));
  const auto more = scene.commit(Time{2}, {{"a", "a/*", "a"}, {"b", "b/*", "b"}, {"c", "c/*", "c"}, {"d", "d/*", "d"}});
  EXPECT_EQ(more->reasonsTotal(), 9u);
  EXPECT_EQ(more->reasons().size(), 3u);
}

TEST(Completeness, TheOldestMovingBodyTellsTheAge) {
  Cell cell;
  cell.scene.setState(cell.good, Freshness::late, 0.25);
  cell.scene.setState(cell.other, Freshness::fresh, 0.125);
  EXPECT_EQ(cell.now().maxAge(), 0.25);
  const BodyId wall = test::put(cell.scene, test::ball("wall", 0.5, Mobility::fixed), test::at(9));
  cell.scene.setState(wall, Freshness::fresh, 1e6);
  EXPECT_EQ(cell.now().maxAge(), 0.25) << "the age of a fixed body must not count";
}

}  // namespace
}  // namespace hgrid
