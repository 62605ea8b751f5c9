// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/Mobility.h>
#include <hgrid_proximity/PairFlags.h>
#include <hgrid_proximity/Verdict.h>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

/// Setup with two spheres of one robot, "a" and "b", that are 0.05 m apart, and with two obstacles. The obstacle "near"
/// is 0.05 m away from "a", the obstacle "far" 0.3 m.
NodeSetup nearBodies(std::initializer_list<std::pair<const char*, Value>> more = {}) {
  NodeSetup setup;
  setup.params =
      with(dict({{"obstacles", list({ball("far", -0.5, 0, 0, 0.1), ball("near", -0.25, 0, 0, 0.1)})}}), more);
  setup.beside["robot_description"] = balls({"a", "b"});
  return setup;
}

/// Runs a node with nearBodies() and these parameters, and returns its pairs.
msg::Pairs pairsWith(std::initializer_list<std::pair<const char*, Value>> more) {
  TransformSource transforms;
  transforms.fix({stamped("base", "a", at(0)), stamped("base", "b", at(0.25))});
  NodeUnderTest node(nearBodies(more));
  node.waitForComplete();
  return *node.heard().pairs.back();
}

using Names = std::vector<std::string>;

TEST(Pairs, AreThoseWithinTheMarginByNameWithGapMarginAndSince) {
  TransformSource transforms;
  transforms.fix({stamped("base", "a", at(0)), stamped("base", "b", at(0.25))});
  NodeUnderTest node(nearBodies());
  node.waitForComplete();
  const auto pairs = node.heard().pairs.back();
  EXPECT_EQ(namesOf(*pairs), Names({"obstacle/near|robot/a", "robot/a|robot/b"}));
  EXPECT_EQ(pairs->names, Names({"obstacle/near", "robot/a", "robot/b"})) << "each name once, sorted";
  EXPECT_EQ(pairs->total, 2u);
  EXPECT_NEAR(pairs->gap[0], 0.05, 1e-6);
  EXPECT_EQ(pairs->margin[0], 0.1);
  node.waitForTicks(5);
  const auto later = node.heard().pairs.back();
  EXPECT_EQ(later->since, pairs->since) << "the pairs did not end meanwhile";
  EXPECT_GT(later->header.stamp, later->since[0]);
}

/// Claim: with ~horizon, a body that jumps on /tf farther than its speed allows misses no pair on its way, and these
/// pairs have the flag TELEPORT.
TEST(Pairs, OnTheWayOfABodyThatJumpsAreListedAndFlagged) {
  TransformSource transforms;
  transforms.stream("base", "a", at(0));
  NodeSetup setup;
  setup.params = dict({{"world_frame", "base"},
                       {"horizon", 0.1},
                       {"max_speed", list({dict({{"pattern", "robot/a"}, {"speed", 1.0}})})},
                       {"obstacles", list({ball("between", 5, 0, 0, 0.1)})}});
  setup.beside["robot_description"] = balls({"a"});
  NodeUnderTest node(setup);
  node.waitForComplete();
  EXPECT_TRUE(node.heard().pairs.back()->first.empty());
  transforms.stream("base", "a", at(10));
  node.waitUntil("the pair of the body that jumped", [](const Heard& all) {
    for (const auto& pairs : all.pairs) {
      if (namesOf(*pairs) == Names({"obstacle/between|robot/a"}) && (pairs->flags[0] & msg::PairFlags::TELEPORT) != 0) {
        return true;
      }
    }
    return false;
  });
  node.waitForPairs("the end of the pair", [](const msg::Pairs& pairs) { return pairs.first.empty(); });
}

/// Three obstacles are near robot/base: obstacle/b touches it, obstacle/a is 0.02 m and obstacle/c 0.04 m away.
TEST(Pairs, AreTruncatedToTheNearestAndTheWorldIsThenNotComplete) {
  NodeSetup setup;
  setup.params = dict(
      {{"world_frame", "base"},
       {"limits/max_pairs", 2},
       {"obstacles", list({ball("a", 0, 0, -5.22, 0.1), ball("b", 0, 0, -5.15, 0.1), ball("c", 0, 0, -5.24, 0.1)})}});
  setup.beside["robot_description"] = balls({});
  NodeUnderTest node(setup);
  const auto pairs = node.waitForPairs("all bodies", [](const msg::Pairs& p) { return p.total == 3; });
  EXPECT_EQ(namesOf(*pairs), Names({"obstacle/a|robot/base", "obstacle/b|robot/base"}));
  EXPECT_TRUE(pairs->truncated);
  EXPECT_FALSE(pairs->world.complete);
  EXPECT_EQ(pairs->world.reasons, Names({"TRUNCATED: more than 2 pairs are near; ~pairs lists only 2 pairs "
                                         "(~limits/max_pairs)"}));
  EXPECT_EQ(pairs->world.reasons_total, 1u);
  const auto response = node.sphere(5, 0, 0, 0.1);
  EXPECT_EQ(response.answer.verdict, msg::Verdict::CLEAR) << "queries do not depend on pairs";
  EXPECT_FALSE(response.world.complete);
}

TEST(Pairs, ThatAreAllowedAreNotReported) {
  EXPECT_EQ(namesOf(pairsWith({{"allowed_pairs", list({dict({{"first", "robot/b"}, {"second", "*/a"}})})}})),
            Names({"obstacle/near|robot/a"}));
  EXPECT_EQ(namesOf(pairsWith({{"allowed_pairs", list({dict({{"first", "robot/*"}, {"second", "obstacle/*"}})})}})),
            Names({"robot/a|robot/b"}));
}

TEST(Pairs, ExistByTheirKind) {
  EXPECT_EQ(namesOf(pairsWith({{"pair_kinds", list({Value("self")})}})), Names({"robot/a|robot/b"}));
  EXPECT_EQ(namesOf(pairsWith({{"pair_kinds", list({Value("robot_obstacle")})}})), Names({"obstacle/near|robot/a"}));
  EXPECT_EQ(namesOf(pairsWith({{"pair_kinds", list({Value("robot_robot")})}})), Names());
}

TEST(Pairs, HaveTheLargerMarginOfTheTwo) {
  EXPECT_EQ(namesOf(pairsWith({{"margin", 0.04}})), Names());
  const msg::Pairs pairs = pairsWith({{"margin", 0.04},
                                      {"margins", list({dict({{"pattern", "obstacle/*"}, {"margin", 0.01}}),
                                                        dict({{"pattern", "*/far"}, {"margin", 0.35}})})}});
  EXPECT_EQ(namesOf(pairs), Names({"obstacle/far|robot/a"})) << "a margin below ~margin has no effect";
  EXPECT_EQ(pairs.margin.at(0), 0.35);
  EXPECT_NEAR(pairs.gap.at(0), 0.3, 1e-6);
}

TEST(Pairs, CountPaddingAsPartOfTheShape) {
  const msg::Pairs pairs = pairsWith({{"padding", list({dict({{"pattern", "robot/a"}, {"padding", 0.02}}),
                                                        dict({{"pattern", "obstacle/near"}, {"padding", 0.01}})})}});
  EXPECT_EQ(namesOf(pairs), Names({"obstacle/near|robot/a", "robot/a|robot/b"}));
  EXPECT_NEAR(pairs.gap[0], 0.02, 1e-6);
  EXPECT_NEAR(pairs.gap[1], 0.03, 1e-6);
}

TEST(Pairs, OfStaleBodiesWidenByTheSpeedThatIsSet) {
  TransformSource transforms;
  NodeSetup setup = nearBodies({{"max_speed", list({dict({{"pattern", "robot/*"}, {"speed", 50.0}}),
                                                    dict({{"pattern", "robot/b"}, {"speed", 0.0}})})},
                                {"late_after", 0.05},
                                {"stale_after", 0.1},
                                {"growth_cap", 0.35}});
  NodeUnderTest node(setup);
  transforms.stream("base", "a", at(0));
  transforms.stream("base", "b", at(0.25));
  node.waitForComplete();
  transforms.stop("a");
  transforms.stop("b");
  const auto pairs = node.waitForPairs(
      "a is stale", [](const msg::Pairs& p) { return p.world.worst_state == msg::BodyState::STALE && p.total == 3; });
  EXPECT_EQ(namesOf(*pairs), Names({"obstacle/far|robot/a", "obstacle/near|robot/a", "robot/a|robot/b"}));
  EXPECT_DOUBLE_EQ(pairs->margin[0], 0.45);
  const auto bodies = node.waitForBodies("five bodies", [](const msg::Bodies& b) { return b.bodies.size() == 5; });
  const std::map<std::string, double> speeds = {
      {"robot/a", 50.0}, {"robot/b", 0.0}, {"robot/base", 50.0}, {"obstacle/near", 2.0}, {"obstacle/far", 2.0}};
  for (const msg::Body& body : bodies->bodies) EXPECT_EQ(body.max_speed, speeds.at(body.name)) << body.name;
}

TEST(Pairs, OfAStaleLinkWidenAlsoAgainstLinksOfItsRobotThatStandStill) {
  TransformSource transforms;
  NodeSetup setup = nearBodies({{"max_speed", list({dict({{"pattern", "robot/*"}, {"speed", 50.0}})})},
                                {"late_after", 0.05},
                                {"stale_after", 0.1},
                                {"growth_cap", 0.35}});
  NodeUnderTest node(setup);
  transforms.stream("base", "a", at(0));
  transforms.fix({stamped("base", "b", at(0.25))});
  node.waitForComplete();
  node.waitForTicks(3);
  transforms.stop("a");
  const auto pairs = node.waitForPairs(
      "a is stale", [](const msg::Pairs& p) { return p.world.worst_state == msg::BodyState::STALE && p.total == 3; });
  EXPECT_EQ(namesOf(*pairs), Names({"obstacle/far|robot/a", "obstacle/near|robot/a", "robot/a|robot/b"}));
  for (const double margin : pairs->margin) EXPECT_DOUBLE_EQ(margin, 0.45);
}

TEST(Obstacles, OfEveryKindStandWhereTheirPosesSay) {
  const auto shape = [](const char* type, double x) {
    return dict({{"type", type}, {"height", 0.4}, {"radius", 0.1}, {"pose", dict({{"xyz", xyz(x, 0, 0)}})}});
  };
  const Value quarter = dict({{"xyz", xyz(0, 0, 1)}, {"rpy", xyz(0, 0, 1.5707963267948966)}});
  NodeSetup setup;
  setup.params =
      dict({{"obstacles", list({dict({{"name", "all"},
                                      {"pose", quarter},
                                      {"shapes", list({shape("cylinder", 1), shape("cone", 2), shape("capsule", 3)})}}),
                                box("box", xyz(5, 0, 0), xyz(1, 2, 3))})}});
  setup.beside["robot_description"] = balls({});
  NodeUnderTest node(setup);
  node.waitForComplete();
  const auto hit = [&](double x, double y, double z) {
    const auto answer = node.sphere(x, y, z, 0.0).answer;
    return answer.hits.size() == 1 ? answer.hits[0].name + "#" + std::to_string(answer.hits[0].shape) : "nothing";
  };
  EXPECT_EQ(hit(0, 1, 1.19), "obstacle/all#0");
  EXPECT_EQ(hit(0, 2, 1.19), "obstacle/all#1");
  EXPECT_EQ(hit(0, 3, 1.19), "obstacle/all#2");
  EXPECT_EQ(hit(0, 3, 1.29), "obstacle/all#2") << "a capsule has round ends";
  EXPECT_EQ(hit(0, 2, 1.21), "nothing");
  EXPECT_EQ(hit(1, 0, 1), "nothing") << "the obstacle is rotated by 90 degrees";
  EXPECT_EQ(hit(5.49, 0.99, 1.49), "obstacle/box#0");
  EXPECT_EQ(hit(5.51, 0.99, 1.49), "nothing");
  EXPECT_EQ(node.heard().pairs.back()->total, 0u) << "fixed bodies make no pairs";
}

TEST(Obstacles, FollowTheirFrame) {
  TransformSource transforms;
  NodeSetup setup;
  setup.params = dict({{"late_after", 3600.0},
                       {"stale_after", 3600.0},
                       {"lost_after", 3600.0},
                       {"obstacles", list({ball("crate", 0, 0, 1, 0.1, "/cart"), ball("post", 5, 0, 1, 0.1)})}});
  setup.beside["robot_description"] = balls({});
  NodeUnderTest node(setup);
  const auto status = node.waitForStatus("the robot", [](const msg::Status& s) { return s.robots == 1; });
  EXPECT_EQ(status->missing_frames, Names({"cart"}));
  EXPECT_TRUE(oneSays(status->world.reasons, "UNPLACED obstacle/crate"));
  EXPECT_EQ(namesOf(node.sphere(5, 0, 1, 0.05).answer), Names({"obstacle/post"}));
  for (const double x : {1.0, 4.85, 2.0}) {
    SCOPED_TRACE(x);
    transforms.send({stamped("base", "cart", at(x), transforms.now())});
    node.waitForTransforms(transforms.sent());
    EXPECT_NEAR(xOf(node, "obstacle/crate", 0.1, 0.0, 1.0), x, 1e-5);
    const auto pairs =
        node.waitForPairs("its pairs", [&](const msg::Pairs& p) { return p.total == (x > 4 ? 1u : 0u); });
    EXPECT_EQ(namesOf(*pairs), x > 4 ? Names({"obstacle/crate|obstacle/post"}) : Names());
  }
  const auto bodies = node.waitForBodies("three bodies", [](const msg::Bodies& b) { return b.bodies.size() == 3; });
  const msg::Body& crate = bodies->bodies[0];
  EXPECT_EQ(crate.name, "obstacle/crate");
  EXPECT_EQ(crate.mobility, msg::Mobility::MOVING);
  EXPECT_EQ(crate.frame, "cart");
}

}  // namespace
}  // namespace test
}  // namespace hgrid
