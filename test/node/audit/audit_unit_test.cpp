// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <sstream>

#include "audited_world.h"
#include "hgrid_proximity/refusal.h"
#include "src/node/audit/audit.h"
#include "src/node/audit/case_file.h"
#include "test/node/support/settings.h"

namespace hgrid {
namespace {

using test::AuditedWorld;

std::string sentences(const AuditFindings& findings) {
  std::string result;
  for (const std::string& sentence : findings.differences) result += sentence + "\n";
  return result;
}

/// Audits every third tick, at most ten times. Returns the sentences of the first audit that finds a difference; empty
/// if no audit finds one.
/// @param plant  may put a fault into a case before its audit
std::string foundWithinTen(AuditedWorld& world, const std::function<void(AuditCase&)>& plant = {}) {
  for (int i = 0; i < 10; ++i) {
    for (int tick = 0; tick < 3; ++tick) world.step();
    AuditCase audited = world.audited();
    if (plant) plant(audited);
    const AuditFindings findings = audit(audited, 1);
    if (findings.total > 0) return sentences(findings);
  }
  return "";
}

/// Makes ticks until all frames are known.
void begin(AuditedWorld& world) {
  for (int i = 0; i < 3; ++i) world.step();
  ASSERT_EQ(sentences(audit(world.audited(), 1)), "");
}

void expectTells(const std::string& found, const std::string& part) {
  EXPECT_NE(found.find(part), std::string::npos) << "found: " << found.substr(0, 500);
}

TEST(Audit, ComparesAllPosesPairsAndQueriesOfASmallWorld) {
  AuditedWorld world(1);
  world.addRobot(0.0);
  begin(world);
  const AuditFindings findings = audit(world.audited(), 1);
  EXPECT_EQ(findings.poses + 1, world.world().snapshot().poses().size());
  EXPECT_EQ(findings.poses_skipped, 1u) << "only frame 'slow' has no transforms";
  EXPECT_EQ(findings.pairs, 17u * 16 / 2);
  EXPECT_EQ(findings.queries, 8u);
  EXPECT_GT(world.world().snapshot().pairs().size(), 5u) << "the world has too few pairs for this test";
}

/// Claim: an audit does not use a static pose of a frame that a planar or floating joint moves.
TEST(Audit, FindsABodyThatTheStaticPoseOfAFreeFramePlaces) {
  AuditedWorld world(2);
  for (int i = 0; i < 100; ++i) world.step();  // the record of transforms must begin before the pose
  world.send(world.randomTransform("base", "slow", 0.0), true);
  begin(world);
  expectTells(foundWithinTen(world, [](AuditCase& audited) { audited.free_frames = {"slow"}; }),
              "'obstacle/slow' has a pose");
}

/// Claim: an audit uses the parameters of the tick that it audits, also if they have changed since then.
TEST(Audit, FollowsParametersThatChange) {
  Params params = AuditedWorld::defaults();
  params.pair_margins.clear();  // the settings of this test do not have them
  AuditedWorld world(14, params);
  world.addRobot(0.0);
  begin(world);
  test::Random random(14);
  std::shared_ptr<const Settings> settings = test::settingsOf(world.world().params());
  for (int change = 0; change < 20; ++change) {
    const ParamChange values{{"margin", random.uniform(0.0, 1.0)},
                             {"growth_cap", random.uniform(0.0, 1.0)},
                             {"horizon", random.chance(0.5) ? 0.0 : random.uniform(0.0, 0.5)}};
    world.step();
    const AuditCase before = world.audited();
    settings = std::make_shared<const Settings>(changedSettings(*settings, values));
    world.world().world().setSettings(settings);
    EXPECT_EQ(sentences(audit(before, 1)), "");
    EXPECT_NE(before.margin, settings->params.margin);
    for (int i = 0; i < 3; ++i) {
      world.step();
      const AuditCase after = world.audited();
      EXPECT_EQ(after.margin, settings->params.margin);
      EXPECT_EQ(after.config_hash, std::to_string(settings->config_hash));
      EXPECT_EQ(sentences(audit(after, 1)), "");
    }
  }
}

/// Claim: an audit knows that obstacles of one group make no pairs with each other, and misses them otherwise.
TEST(Audit, KnowsTheGroupsOfObstacles) {
  Params params = AuditedWorld::defaults();
  for (int i = 0; i < 4; ++i) {
    ObstacleParams added = params.obstacles.front();  // all four follow the frame of this one
    added.body.name = "obstacle/more" + std::to_string(i);
    added.body.group = i < 2 ? "pile" : "";
    params.obstacles.push_back(added);
  }
  AuditedWorld world(15, params);
  for (int i = 0; i < 3; ++i) world.step();
  AuditCase audited = world.audited();
  EXPECT_EQ(sentences(audit(audited, 1)), "");
  for (Body& body : audited.bodies) body.group.clear();
  expectTells(sentences(audit(audited, 1)), "the pair 'obstacle/more0', 'obstacle/more1' is missing");
}

TEST(Audit, FindsAPoseThatDoesNotFitItsTransforms) {
  AuditedWorld world(2);
  begin(world);
  world.tamper = [](geometry_msgs::TransformStamped& transform) {
    if (transform.child_frame_id == "f3") transform.transform.translation.z += 1e-5;
    return true;
  };
  expectTells(foundWithinTen(world), "'obstacle/part3' is 1e-05 m away from where the transforms");
}

TEST(Audit, FindsTransformsThatTheNodeLost) {
  AuditedWorld world(3);
  begin(world);
  world.tamper = [](const geometry_msgs::TransformStamped& transform) { return transform.child_frame_id != "f4"; };
  expectTells(foundWithinTen(world), "'obstacle/part4' has a pose of");
}

TEST(Audit, FindsABodyThatStaysWithoutAPose) {
  AuditedWorld world(4);
  world.tamper = [](const geometry_msgs::TransformStamped& transform) { return transform.child_frame_id != "f5"; };
  expectTells(foundWithinTen(world), "'obstacle/part5' has no pose, but the transforms place it");
}

TEST(Audit, FindsALinkThatIsPlacedWrongInItsRobot) {
  AuditedWorld world(5);
  world.addRobot(0.001);
  expectTells(foundWithinTen(world), "'arm/arm_tool' is 0.001 m away");
}

TEST(Audit, AllowsALinkThatOnlyAFixedJointPlaces) {
  AuditedWorld world(9);
  world.addRobot(0.0, false);
  EXPECT_EQ(foundWithinTen(world), "");
  const AuditFindings findings = audit(world.audited(), 1);
  EXPECT_EQ(findings.poses_skipped, 2u) << "frame 'slow' and frame 'arm_tool' have no transforms";
  const Snapshot& snapshot = world.world().snapshot();
  EXPECT_NE(snapshot.poses()[snapshot.structure().find("arm/arm_tool")].state, Freshness::unplaced);
}

TEST(Audit, FindsNothingWrongWhileARobotLeavesAndReturns) {
  AuditedWorld world(12);
  world.addRobot(0.0);
  begin(world);
  for (int round = 0; round < 20; ++round) {
    world.declareRobot(round % 2 == 1);
    for (int tick = 0; tick < 3; ++tick) {
      world.step();
      ASSERT_EQ(sentences(audit(world.audited(), 1)), "") << "round " << round << ", tick " << tick;
    }
    const bool is_there = world.world().snapshot().structure().find("arm/arm_tool") != Structure::kNone;
    ASSERT_EQ(is_there, round % 2 == 1);
  }
}

TEST(Audit, FindsAPairThatTheGridMissed) {
  AuditedWorld world(6);
  begin(world);
  const std::string found = foundWithinTen(world, [](AuditCase& audited) {
    if (!audited.pairs.empty()) audited.pairs.erase(audited.pairs.begin() + audited.pairs.size() / 2);
  });
  expectTells(found, "is missing: the gap of its boxes is");
}

/// Returns a world with a tilted plane among its bodies.
AuditedWorld worldWithPlane(unsigned seed) {
  Params params = AuditedWorld::defaults();
  ObstacleParams floor;
  floor.body.name = "obstacle/floor";
  floor.body.frame = "base";
  floor.body.shapes.push_back({Shape::plane(), Pose::Identity(), 0.01, {}, Eigen::Vector3d::Ones()});
  floor.body.shapes[0].body_from_shape.linear() =
      Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 0).normalized()).toRotationMatrix();
  params.obstacles.push_back(floor);
  return AuditedWorld(seed, params);
}

std::uint32_t numberOf(const AuditCase& audited, const std::string& name) {
  std::uint32_t body = 0;
  while (std::string(audited.bodies[body].name) != name) ++body;
  return body;
}

TEST(Audit, KnowsPlanes) {
  AuditedWorld world = worldWithPlane(20);
  begin(world);
  EXPECT_EQ(foundWithinTen(world), "");
  const AuditCase audited = world.audited();
  const std::uint32_t floor = numberOf(audited, "obstacle/floor");
  const auto has_floor = [&](const NearPair& pair) { return pair.first == floor || pair.second == floor; };
  EXPECT_TRUE(std::any_of(audited.pairs.begin(), audited.pairs.end(), has_floor)) << "the world is too easy";
  EXPECT_FALSE(std::all_of(audited.pairs.begin(), audited.pairs.end(), has_floor)) << "the world is too easy";
}

TEST(Audit, FindsAPairWithAPlaneThatIsMissingOrHasAWrongGap) {
  AuditedWorld world = worldWithPlane(21);
  begin(world);
  const auto each_with_floor = [](AuditCase& audited, const auto& act) {
    const std::uint32_t floor = numberOf(audited, "obstacle/floor");
    for (std::size_t i = audited.pairs.size(); i-- > 0;) {
      if (audited.pairs[i].first == floor || audited.pairs[i].second == floor) act(i);
    }
  };
  expectTells(foundWithinTen(world,
                             [&](AuditCase& audited) {
                               each_with_floor(audited, [&](std::size_t i) {
                                 audited.pairs.erase(audited.pairs.begin() + std::ptrdiff_t(i));
                               });
                             }),
              "'obstacle/floor'");
  expectTells(foundWithinTen(world,
                             [&](AuditCase& audited) {
                               each_with_floor(audited, [&](std::size_t i) { audited.pairs[i].gap += 1e-4; });
                             }),
              "it should be");
}

TEST(Audit, FindsAQueryThatMissesAPlane) {
  AuditedWorld world = worldWithPlane(22);
  begin(world);
  const std::string found = foundWithinTen(world, [](AuditCase& audited) {
    const std::uint32_t floor = numberOf(audited, "obstacle/floor");
    for (RecordedQuery& query : audited.queries) {
      const auto is_floor = [&](const RecordedQuery::Hit& hit) { return hit.body == floor; };
      query.hits.erase(std::remove_if(query.hits.begin(), query.hits.end(), is_floor), query.hits.end());
      query.verdict = query.hits.empty() ? Verdict::clear : Verdict::hit;
    }
  });
  expectTells(found, "'obstacle/floor' is no hit, but the query touches its box");
}

TEST(Audit, FindsAMarginThatIsTooSmall) {
  AuditedWorld world(7);
  begin(world);
  const std::string found = foundWithinTen(world, [](AuditCase& audited) {
    auto& pairs = audited.pairs;
    for (NearPair& pair : pairs) pair.margin *= 0.5;
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(), [](const NearPair& p) { return p.gap > p.margin; }),
                pairs.end());
  });
  expectTells(found, "has the margin");
  expectTells(found, "is missing");
}

TEST(Audit, FindsAPairThatTheFilterShouldHaveSwitchedOff) {
  AuditedWorld world(8);
  begin(world);
  const std::string found = foundWithinTen(world, [](AuditCase& audited) {
    PairRule rule;
    rule.first = "obstacle/part*";
    rule.second = "obstacle/part*";
    audited.rules.push_back(rule);
  });
  expectTells(found, "is listed, but it is switched off");
}

TEST(Audit, FindsAPairThatTheFilterSwitchedOffWithoutARule) {
  AuditedWorld world(9);
  begin(world);
  expectTells(foundWithinTen(world, [](AuditCase& audited) { audited.rules.clear(); }), "is missing");
}

TEST(Audit, FindsAGapThatIsWrong) {
  AuditedWorld world(10);
  begin(world);
  const std::string found = foundWithinTen(world, [](AuditCase& audited) {
    for (NearPair& pair : audited.pairs) pair.gap += 1e-4;
  });
  expectTells(found, "has the gap");
}

TEST(Audit, FindsAQueryThatMissedABody) {
  AuditedWorld world(11);
  begin(world);
  const std::string found = foundWithinTen(world, [](AuditCase& audited) {
    for (RecordedQuery& query : audited.queries) {
      query.hits.clear();
      query.verdict = Verdict::clear;
    }
  });
  expectTells(found, "is no hit, but the query touches its box");
  expectTells(found, "a nearest query");
}

TEST(Audit, FindsAPairWithAMapThatTheNodeMissed) {
  AuditedWorld world(12);
  begin(world);
  const std::string found = foundWithinTen(world, [](AuditCase& audited) {
    Body body;
    body.name = "map/z";
    body.frame = "base";
    body.kind = BodyKind::map;
    body.mobility = Mobility::fixed;
    BodyPose pose;
    pose.state = Freshness::fresh;
    RecordedCells cells;
    cells.body = static_cast<std::uint32_t>(audited.bodies.size());
    cells.finest_edge = 0.5;
    cells.voxels = {{32767, 32767, 32767, 1}};  // a cube of 1 m around the origin
    audited.bodies.push_back(body);
    audited.poses.push_back(pose);
    audited.cells.push_back(cells);
  });
  expectTells(found, "'map/z' is missing: a cell is");
}

/// Does at random one of the things that happen to transforms in a real system.
void disturb(AuditedWorld& world) {
  test::Random& random = world.random();
  const std::string frame = "f" + std::to_string(random.below(10));
  switch (random.below(10)) {
    case 0:  // one frame is no longer published; all others are
      world.is_silent = [frame](const std::string& other) { return other == frame; };
      break;
    case 1:  // all frames are published again
      world.is_silent = nullptr;
      break;
    case 2: {  // a coordinate is not a number
      auto transform = world.randomTransform("hub", frame, 0.0);
      transform.transform.translation.x = std::numeric_limits<double>::quiet_NaN();
      world.send(transform);
      break;
    }
    case 3:  // a stamp is older than that of an earlier transform
      world.send(world.randomTransform("hub", frame, random.uniform(0.0, 0.3)));
      break;
    case 4:  // a second publisher sends the frame
      world.send(world.randomTransform("hub", frame, 0.0), false, "/rival");
      break;
    case 5:  // a transform has another parent
      world.send(world.randomTransform("base", frame, 0.0));
      break;
    case 6:  // a stamp is in the future
      world.send(world.randomTransform("hub", frame, random.uniform(-0.6, 0.0)));
      break;
    case 7:  // the wall clock is set
      if (random.chance(0.2)) world.world().setRosClock(world.world().now() + random.uniform(-30.0, 30.0));
      break;
    case 8:  // a static transform gives the root frame a parent
      world.send(world.randomTransform("map", "base", 0.0), true);
      break;
    default:  // nothing is received for a while
      world.world().wait(random.uniform(0.0, 0.5));
      break;
  }
}

TEST(Audit, FindsNoDifferenceWhateverTheTransformsDo) {
  std::uint64_t poses = 0, skipped = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    AuditedWorld world(100 + seed);
    world.addRobot(0.0);
    for (int i = 0; i < 200; ++i) {
      if (world.random().chance(0.1)) disturb(world);
      if (i % 70 == 0) world.send(world.randomTransform("f1", "slow", 0.0));  // about one per second
      if (!world.step().snapshot) continue;
      const AuditFindings findings = audit(world.audited(), 1);
      ASSERT_EQ(sentences(findings), "") << "seed " << seed << ", tick " << i;
      poses += findings.poses;
      skipped += findings.poses_skipped;
    }
  }
  EXPECT_GT(poses, skipped) << "the audits skipped most poses";
}

TEST(CaseFile, HasEverythingThatAnAuditNeeds) {
  AuditedWorld world(20);
  world.addRobot(0.001);
  for (int i = 0; i < 5; ++i) world.step();
  AuditCase audited = world.audited();
  ASSERT_FALSE(audited.pairs.empty());
  audited.pairs.pop_back();
  std::stringstream file;
  writeCase(audited, file);
  const AuditFindings before = audit(audited, 1), after = audit(readCase(file), 1);
  EXPECT_GE(before.total, 2u);
  EXPECT_EQ(sentences(before), sentences(after));
  EXPECT_EQ(before.poses, after.poses);
  EXPECT_EQ(before.pairs, after.pairs);
}

TEST(CaseFile, ThatIsCutIsRefusedByLine) {
  AuditedWorld world(21);
  world.step();
  std::stringstream file;
  writeCase(world.audited(), file);
  const std::string whole = file.str();
  for (std::size_t size = 0; size + 2 < whole.size(); size += 1 + whole.size() / 500) {
    std::istringstream cut(whole.substr(0, size));
    try {
      readCase(cut);
      ADD_FAILURE() << "the first " << size << " bytes were accepted";
    } catch (const Refusal& refusal) {
      EXPECT_EQ(refusal.code(), Code::parse);
    }
  }
}

}  // namespace
}  // namespace hgrid
