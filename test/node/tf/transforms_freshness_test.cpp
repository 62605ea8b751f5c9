// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/Verdict.h>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

NodeSetup aging() {
  NodeSetup setup;
  setup.params = dict({{"late_after", 0.2},
                       {"stale_after", 0.5},
                       {"lost_after", 1.2},
                       {"growth_cap", 0.25},
                       {"default_max_speed", 0.2}});
  setup.beside["robot_description"] = balls({"a", "b", "c"});
  return setup;
}

void streamAll(TransformSource& transforms) {
  transforms.stream("base", "a", at(0));
  transforms.stream("base", "b", at(0.25));
  transforms.stream("base", "c", at(9));
}

TEST(Freshness, AFrameThatWasNeverPublishedIsNamedAndTheRestServes) {
  TransformSource transforms;
  NodeUnderTest node(aging());
  streamAll(transforms);
  transforms.stop("c");
  const auto status = node.waitForStatus("a and b are placed", [](const msg::Status& s) {
    return stateOf(s, "robot/a") == msg::BodyState::FRESH && stateOf(s, "robot/b") == msg::BodyState::FRESH &&
           entryOf(s, "robot/c") != nullptr;
  });
  EXPECT_EQ(stateOf(*status, "robot/c"), msg::BodyState::UNPLACED);
  EXPECT_EQ(entryOf(*status, "robot/c")->code.name, "UNKNOWN_FRAME");
  EXPECT_TRUE(says(entryOf(*status, "robot/c")->code.text, "'c'"));
  EXPECT_TRUE(std::isnan(entryOf(*status, "robot/c")->age));
  EXPECT_EQ(status->missing_frames, std::vector<std::string>({"c"}));
  EXPECT_FALSE(status->world.complete);
  EXPECT_EQ(status->world.worst_state, msg::BodyState::UNPLACED);
  EXPECT_TRUE(oneSays(status->world.reasons, "UNPLACED robot/c"));
  EXPECT_TRUE(oneSays(status->world.reasons, "links never had a pose: frame 'c' was never published; start"));

  const auto pairs = node.waitForPairs("the others are near", [](const msg::Pairs& p) { return p.total > 0; });
  EXPECT_EQ(namesOf(*pairs), std::vector<std::string>({"robot/a|robot/b"}));
  EXPECT_EQ(node.sphere(0, 0, 0, 0.05).answer.verdict, msg::Verdict::HIT);
  const auto far = node.sphere(20, 0, 0, 0.1).answer;
  EXPECT_TRUE(far.success);
  EXPECT_EQ(far.verdict, msg::Verdict::UNKNOWN) << "robot/c may be there, because its pose is not known";
  EXPECT_TRUE(says(far.code.text, "robot/c"));

  transforms.stream("base", "c", at(9));
  node.waitForComplete();
  EXPECT_EQ(node.sphere(20, 0, 0, 0.1).answer.verdict, msg::Verdict::CLEAR);
}

TEST(Freshness, AFrameThatStopsGrowsOldStepByStepAndKeepsItsPairs) {
  TransformSource transforms;
  NodeUnderTest node(aging());
  streamAll(transforms);
  node.waitForComplete();
  const std::size_t before = node.heard().pairs.size();
  transforms.stop("b");
  node.waitForStatus("b is LOST and its growth is ~growth_cap", [](const msg::Status& s) {
    const auto* b = entryOf(s, "robot/b");
    return b != nullptr && b->state == msg::BodyState::LOST && b->age > 1.4;
  });
  const Heard all = node.heard();
  int state = msg::BodyState::FRESH;
  double margin = 0.0;
  std::vector<bool> seen(7, false);
  for (std::size_t k = before; k < all.pairs.size(); ++k) {
    const msg::Pairs& pairs = *all.pairs[k];
    const int i = indexOf(pairs, "robot/a", "robot/b");
    ASSERT_GE(i, 0) << "the pair is kept, however old the pose is";
    const auto n = static_cast<std::size_t>(i);
    EXPECT_NEAR(pairs.gap[n], 0.05, 1e-6) << "the age of a pose does not change the gap";
    EXPECT_GE(pairs.state[n], state) << "without new data, the state never improves";
    EXPECT_GE(pairs.margin[n], margin);
    EXPECT_EQ(pairs.margin[n] > 0.1, pairs.state[n] >= msg::BodyState::STALE) << "LATE does not widen the margin";
    EXPECT_LE(pairs.margin[n], 0.1 + 0.25) << "the growth is at most ~growth_cap";
    EXPECT_FALSE(pairs.world.complete && pairs.state[n] >= msg::BodyState::LOST);
    EXPECT_TRUE(pairs.world.complete || pairs.state[n] >= msg::BodyState::STALE);
    EXPECT_EQ(pairs.world.worst_state, pairs.state[n]);
    state = pairs.state[n];
    margin = pairs.margin[n];
    seen[pairs.state[n]] = true;
  }
  EXPECT_TRUE(seen[msg::BodyState::FRESH] && seen[msg::BodyState::LATE] && seen[msg::BodyState::STALE] &&
              seen[msg::BodyState::LOST]);
  EXPECT_DOUBLE_EQ(margin, 0.35);
  const auto status = node.heard().status.back();
  EXPECT_EQ(stateOf(*status, "robot/a"), msg::BodyState::FRESH);
  EXPECT_EQ(entryOf(*status, "robot/b")->code.name, "TF_TIMEOUT");
  EXPECT_TRUE(says(entryOf(*status, "robot/b")->code.text, "frame 'b' is"));
  EXPECT_TRUE(oneSays(status->world.reasons, "LOST robot/b"));
  EXPECT_LE(node.lines("LOST robot/b"), 2u) << "the log has one line per change, not one per tick";

  transforms.stream("base", "b", at(0.27));
  const auto again = node.waitForPairs("b is back", [](const msg::Pairs& p) { return p.world.complete; });
  EXPECT_EQ(namesOf(*again), std::vector<std::string>({"robot/a|robot/b"})) << "the pair is listed once";
  EXPECT_NEAR(again->gap.at(0), 0.07, 1e-6);
  EXPECT_EQ(again->margin.at(0), 0.1);
  EXPECT_EQ(
      node.waitForStatus("all bodies are FRESH", [](const msg::Status& s) { return s.bodies_total == 0; })->body_count,
      4u);
}

TEST(Freshness, NearAStaleBodyNothingIsClear) {
  TransformSource transforms;
  NodeSetup setup = aging();
  setup.params = with(setup.params, {{"lost_after", 3600.0}, {"default_max_speed", 10.0}});
  NodeUnderTest node(setup);
  streamAll(transforms);
  node.waitForComplete();
  EXPECT_EQ(node.sphere(9, 0.3, 0, 0.1).answer.verdict, msg::Verdict::CLEAR);
  transforms.stop("c");
  node.waitForStatus("c is stale", [](const msg::Status& s) { return stateOf(s, "robot/c") == msg::BodyState::STALE; });
  const auto beside = node.sphere(9, 0.3, 0, 0.1).answer;
  EXPECT_EQ(beside.verdict, msg::Verdict::UNKNOWN) << "at 10 m/s, c may have moved there";
  EXPECT_TRUE(says(beside.code.text, "STALE robot/c"));
  EXPECT_EQ(node.sphere(9, 1e5, 0, 0.1).answer.verdict, msg::Verdict::CLEAR) << "c cannot have moved that far";
  EXPECT_EQ(node.sphere(9, 0, 0, 0.1).answer.verdict, msg::Verdict::HIT) << "the last pose is kept";
  EXPECT_EQ(node.sphere(9, 0, 0, 0.1).answer.hits.at(0).state, msg::BodyState::STALE);
  EXPECT_FALSE(node.heard().status.back()->world.complete) << "margins do not grow as far as c may have moved";
}

TEST(Freshness, LinksThatAreEquallyOldDoNotGrowAgainstEachOther) {
  TransformSource transforms;
  NodeSetup setup = aging();
  setup.params = with(setup.params, {{"lost_after", 3600.0}, {"obstacles", list({ball("post", 0, 0.3, 0, 0.1)})}});
  NodeUnderTest node(setup);
  streamAll(transforms);
  node.waitForComplete();
  for (const char* frame : {"a", "b", "c"}) transforms.stop(frame);
  const auto pairs = node.waitForPairs("all links are STALE", [](const msg::Pairs& p) {
    return p.world.worst_state == msg::BodyState::STALE && p.total >= 2 && p.state[0] == msg::BodyState::STALE &&
           p.state[1] == msg::BodyState::STALE;
  });
  const int self = indexOf(*pairs, "robot/a", "robot/b"), post = indexOf(*pairs, "obstacle/post", "robot/a");
  ASSERT_GE(self, 0);
  ASSERT_GE(post, 0);
  EXPECT_EQ(pairs->margin[static_cast<std::size_t>(self)], 0.1);
  EXPECT_GT(pairs->margin[static_cast<std::size_t>(post)], 0.1);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
