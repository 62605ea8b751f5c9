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

NodeSetup threeBalls() {
  NodeSetup setup;
  setup.params = dict({{"late_after", 0.2}, {"stale_after", 0.5}});
  setup.beside["robot_description"] = balls({"a", "b", "c"});
  return setup;
}

void expectConflict(NodeUnderTest& node) {
  const auto status = node.waitForStatus("the conflict is listed", [](const msg::Status& s) {
    return entryOf(s, "robot/a") != nullptr && entryOf(s, "robot/a")->code.name == "CONFLICT";
  });
  EXPECT_TRUE(says(entryOf(*status, "robot/a")->code.text,
                   "on both /tf and /tf_static; it must be published on only one of them"));
  EXPECT_EQ(counter(*status, "tf.conflict.CONFLICT"), 1u);
  EXPECT_EQ(node.lines("tf.conflict.CONFLICT"), 1u);
  node.waitUntil("/diagnostics warn", [](const Heard& all) {
    const auto found = all.diagnostics.find("transforms");
    return found != all.diagnostics.end() && found->second.level == diagnostic_msgs::DiagnosticStatus::WARN &&
           found->second.message.find("'a'") != std::string::npos;
  });
}

TEST(TransformTree, AFrameFirstFixedThenMovingIsAConflict) {
  TransformSource transforms;
  NodeUnderTest node(threeBalls());
  transforms.fix({stamped("base", "a", at(0)), stamped("base", "b", at(0.25)), stamped("base", "c", at(9))});
  node.waitForComplete();
  transforms.stream("base", "a", at(0.01));
  expectConflict(node);
  transforms.stop("a");
  node.waitForStatus("a is STALE, because its newest transform on /tf is old",
                     [](const msg::Status& s) { return stateOf(s, "robot/a") == msg::BodyState::STALE; });
  EXPECT_EQ(stateOf(*node.heard().status.back(), "robot/b"), msg::BodyState::FRESH);
}

TEST(TransformTree, AFrameFirstMovingThenFixedIsAConflict) {
  TransformSource transforms;
  NodeUnderTest node(threeBalls());
  transforms.stream("base", "a", at(0));
  transforms.fix({stamped("base", "b", at(0.25)), stamped("base", "c", at(9))});
  node.waitForComplete();
  transforms.fix({stamped("base", "a", at(0.01))});
  expectConflict(node);
}

TEST(TransformTree, ALoopOfParentsDisconnectsOnlyTheFramesInTheLoop) {
  TransformSource transforms;
  NodeUnderTest node(threeBalls());
  transforms.stream("base", "a", at(0));
  transforms.stream("base", "b", at(0.25));
  transforms.stream("base", "c", at(9));
  node.waitForComplete();
  transforms.stream("c", "b", at(1));
  transforms.stream("b", "c", at(1));
  const auto status = node.waitForStatus("b and c are stale", [](const msg::Status& s) {
    return stateOf(s, "robot/b") == msg::BodyState::STALE && stateOf(s, "robot/c") == msg::BodyState::STALE;
  });
  for (const char* body : {"robot/b", "robot/c"}) {
    EXPECT_EQ(entryOf(*status, body)->code.name, "UNKNOWN_FRAME");
    EXPECT_TRUE(says(entryOf(*status, body)->code.text, "is not connected to 'base'"));
  }
  EXPECT_EQ(stateOf(*status, "robot/a"), msg::BodyState::FRESH);
  EXPECT_EQ(node.sphere(0, 0, 0, 0.05).answer.verdict, msg::Verdict::HIT);
  EXPECT_NEAR(xOf(node, "robot/b"), 0.25, 1e-6) << "the last pose is kept";
  EXPECT_EQ(node.sphere(0, 0, 0, 0.05, "b").answer.code.name, "UNKNOWN_FRAME");
  EXPECT_LE(node.lines(""), 10u + 3u * static_cast<std::size_t>(node.uptime()));

  transforms.stream("base", "b", at(0.25));
  transforms.stream("base", "c", at(9));
  node.waitForComplete();
  node.waitForStatus("all bodies are FRESH", [](const msg::Status& s) { return s.bodies_total == 0; });
}

TEST(TransformTree, AFrameWhoseParentAlternatesIsNeverFreshAndRecovers) {
  TransformSource transforms;
  NodeUnderTest node(threeBalls());
  transforms.stream("base", "a", at(1));
  transforms.stream("base", "c", at(9));
  const auto alternate = [&](int count) {
    for (int i = 0; i < count; ++i) {
      const bool odd = i % 2 == 1;
      transforms.send({stamped(odd ? "a" : "base", "b", at(odd ? 1.0 : 2.0), transforms.now())});
      node.waitForTicks(1);
    }
  };
  alternate(4);
  node.waitForStatus("the contested frame is listed", [](const msg::Status& s) { return !s.contested_frames.empty(); });
  const std::size_t begin = node.heard().status.size();
  alternate(36);
  const Heard all = node.heard();
  for (std::size_t i = begin; i < all.status.size(); ++i) {
    ASSERT_EQ(stateOf(*all.status[i], "robot/b"), msg::BodyState::INVALID);
    ASSERT_EQ(entryOf(*all.status[i], "robot/b")->code.name, "CONFLICT");
  }
  for (const auto& pairs : all.pairs) EXPECT_EQ(indexOf(*pairs, "robot/a", "robot/b"), -1);
  transforms.stream("a", "b", at(0.25));
  node.waitForPairs("b is near a", [](const msg::Pairs& p) { return p.total > 0; });
  const auto pairs = node.waitForPairs("the world is complete", [](const msg::Pairs& p) { return p.world.complete; });
  EXPECT_EQ(namesOf(*pairs), std::vector<std::string>({"robot/a|robot/b"}));
  EXPECT_EQ(pairs->world.worst_state, msg::BodyState::FRESH);
}

TEST(TransformTree, OneFrameTooManyThatNoBodyNeedsIsRefused) {
  TransformSource transforms;
  NodeSetup setup = threeBalls();
  setup.params = with(setup.params, {{"limits/max_frames", 3}});
  NodeUnderTest node(setup);
  node.waitForStatus("the robot", [](const msg::Status& s) { return s.robots == 1; });
  transforms.fix({stamped("base", "d", at(0)), stamped("base", "e", at(0)), stamped("base", "f", at(0)),
                  stamped("base", "g", at(0)), stamped("base", "a", at(0)), stamped("base", "b", at(0.25)),
                  stamped("base", "c", at(9))});
  const auto status = node.waitForStatus("one frame is refused",
                                         [](const msg::Status& s) { return counter(s, "tf.refused.LIMIT") > 0; });
  EXPECT_TRUE(says(node.output(), "frame 'g' would add one frame too many; ~limits/max_frames is 3"));
  node.waitForComplete();
}

}  // namespace
}  // namespace test
}  // namespace hgrid
