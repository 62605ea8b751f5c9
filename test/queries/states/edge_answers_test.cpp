// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Edges of the turning arm, see turning_arm.h. Its sphere moves on a circle of radius 0.5 m.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "geometry/rotation.h"
#include "test/queries/states/turning_arm.h"

namespace hgrid {
namespace {

using namespace test;

/// Returns the angle at which the sphere of the arm begins to touch a ball of the same size, at `angle` on its circle.
double touchingAngle(double angle) { return angle - 2.0 * std::asin(0.1 / 0.5); }

TEST(EdgeAnswers, AHitHasTheFirstContactAndThePair) {
  ArmWorld world;
  put(world.scene, ArmWorld::ballBody("ball"), at(0, 0.5));
  const EdgeAnswer& answer = world.checkEdge(0, kQuarter + 1.0);
  ASSERT_EQ(answer.verdict, Verdict::hit);
  const double first = touchingAngle(kQuarter) / (kQuarter + 1.0), tolerance = 1e-3 / 0.6;
  EXPECT_NEAR(answer.at, first, tolerance);
  EXPECT_GE(answer.at, first);
  EXPECT_LE(answer.free_until, first);
  EXPECT_GT(answer.free_until, first - 2 * tolerance);
  ASSERT_EQ(answer.pairs, 1u);
  const StatePair& pair = world.edge_answers.pairs[0];
  const BodyList& bodies = world.snapshot->structure().bodies;
  EXPECT_EQ(bodies[pair.first].name, "robot/arm");
  EXPECT_EQ(bodies[pair.second].name, "obstacle/ball");
  EXPECT_TRUE(isContact(pair.proximity.status));
  EXPECT_EQ(world.edge_sentence, "");
}

TEST(EdgeAnswers, ASmallerToleranceLocatesTheContactBetter) {
  ArmWorld world;
  put(world.scene, ArmWorld::ballBody("ball"), at(0, 0.5));
  EdgeRequest request;
  request.tolerance = 1e-5;
  const EdgeAnswer& answer = world.checkEdge(0, kQuarter, request);
  EXPECT_NEAR(answer.at * kQuarter, touchingAngle(kQuarter), 1e-5 / 0.5);
}

TEST(EdgeAnswers, AnEdgeThatEndsBeforeTheBallIsClear) {
  ArmWorld world;
  put(world.scene, ArmWorld::ballBody("ball"), at(0, 0.5));
  const EdgeAnswer& answer = world.checkEdge(0, touchingAngle(kQuarter) - 0.01);
  EXPECT_EQ(answer.verdict, Verdict::clear);
  EXPECT_EQ(answer.free_until, 1.0);
  EXPECT_EQ(answer.pairs, 0u);
  EXPECT_TRUE(std::isnan(answer.at));
}

/// Claim: the place of a long arm after millions of turns is rounded by more than a micrometer. An edge to a contact is
/// not clear there either.
TEST(EdgeAnswers, AnEdgeToAContactIsNotClearAfterMillionsOfTurns) {
  const double reach = 1e4;  // [m]
  RobotModel model = turningArm();
  model.links[1].continuous = true;
  model.links[1].shapes = {solidShape(Shape::sphere(0.1), at(reach))};
  Random random(1);
  for (int i = 0; i < 60; ++i) {
    const double to = random.uniform(8e7, 1e8), before = to - random.uniform(0.5, 1.5);
    const double from = i % 2 == 0 ? before : std::remainder(before, 2.0 * M_PI);  // nearly the same place
    const Eigen::Vector3d side(cosine(to), sine(to), 0.0), ahead(-side.y(), side.x(), 0.0);
    const Eigen::Vector3d ball = reach * side + (0.2 - std::pow(10.0, random.uniform(-7.0, -5.0))) * ahead;
    ArmWorld world({}, model);
    put(world.scene, ArmWorld::ballBody("ball"), Pose(Eigen::Translation3d(ball)));
    EXPECT_EQ(world.verdictAt(to), Verdict::hit);
    EXPECT_NE(world.checkEdge(from, to).verdict, Verdict::clear) << "edge " << i;
  }
}

TEST(EdgeAnswers, AnEdgeWithoutMotionIsTheStateItself) {
  ArmWorld world;
  put(world.scene, ArmWorld::ballBody("ball"), at(0, 0.5));
  EXPECT_EQ(world.checkEdge(0, 0).verdict, Verdict::clear);
  EXPECT_EQ(world.checkEdge(kQuarter, kQuarter).verdict, Verdict::hit);
}

// Claim: of many shapes in a row, those that are far from the axis are searched as far as they move. The base and the
// outer arm are not adjacent links, because the arm is between them.
TEST(EdgeAnswers, TheFarEndOfALongLinkIsNotMissed) {
  const double angle = 2.09;  // of the balls on the base; the first configurations that are tested do not touch them
  RobotModel model = turningArm();
  RobotLink outer = model.links[1];
  outer.name = "outer arm";
  outer.parent = 1;
  outer.joint = "outer joint";
  outer.lower = 0.0;
  outer.upper = 3.0;
  outer.shapes.clear();
  for (int i = 0; i <= 10; ++i) outer.shapes.push_back(solidShape(Shape::sphere(0.02), at(0.1 + 0.04 * i)));
  model.links.push_back(outer);
  model.links[1].shapes = {solidShape(Shape::sphere(0.005))};
  model.links[0].shapes.clear();
  for (const double radius : {0.48, 0.5, 0.52}) {
    model.links[0].shapes.push_back(
        solidShape(Shape::sphere(0.01), at(radius * std::cos(angle), radius * std::sin(angle))));
  }
  findRigidGroups(model);
  ArmWorld world({}, model);
  world.batch.joints = {"outer joint"};
  world.batch.others = {0.0, 0.0};
  const EdgeAnswer& answer = world.checkEdge(0, 2.9);
  ASSERT_EQ(answer.verdict, Verdict::hit);
  EXPECT_NEAR(answer.at * 2.9, angle - 2.0 * std::asin(0.015 / 0.5), 2e-3);
  EXPECT_EQ(world.checkEdge(0, 1.9).verdict, Verdict::clear);
}

TEST(EdgeAnswers, AnEndThatTouchesIsAHit) {
  ArmWorld world;
  put(world.scene, ArmWorld::ballBody("ball"), at(0, 0.5));
  const double touching = touchingAngle(kQuarter) + 1e-6;
  const EdgeAnswer last = world.checkEdge(0, touching);
  EXPECT_EQ(last.verdict, Verdict::hit);
  EXPECT_EQ(last.at, 1.0);
  const EdgeAnswer first = world.checkEdge(touching, 0);
  EXPECT_EQ(first.verdict, Verdict::hit);
  EXPECT_EQ(first.at, 0.0);
  EXPECT_EQ(world.checkEdge(kQuarter, kQuarter).at, 0.0);
}

/// Claim: what stays at the same distance does not make an edge unknown, however near it is.
TEST(EdgeAnswers, ShapesThatDoNotMoveAgainstEachOtherMayBeNear) {
  ArmWorld world;
  put(world.scene, ArmWorld::ballBody("ball"), at(0.5, 0.2 + 1e-7));
  EXPECT_EQ(world.checkEdge(0, 0).verdict, Verdict::clear);
}

/// Claim: the rest of a quaternion of which a part is in the batch is the same for all edges.
TEST(EdgeAnswers, APartOfAQuaternionInTheBatchDoesNotLeakIntoOtherEdges) {
  RobotModel model = turningArm();
  model.links[1].joint_kind = JointKind::floating;
  ArmWorld world({}, model);
  put(world.scene, ArmWorld::ballBody("ball"), at(0, 0.5));
  world.snapshot = world.scene.commit(Time{2}, {});
  const StateChecker checker(world.snapshot, Kinematics(model), "robot", narrowPhase());
  StateBatch batch;
  batch.joints = {"arm_joint/rot_z", "arm_joint/rot_w"};
  batch.others = {0, 0, 0, 0.1, 0, 0, 1};  // rot_x is 0.1
  const double rest = std::sqrt(1.0 - 0.01);
  Random random(1);
  std::vector<StateEdge> edges;
  for (std::uint32_t i = 0; i < 40; ++i) {
    const double angle = random.uniform(-3, 3);
    batch.positions.insert(batch.positions.end(), {rest * std::sin(angle), rest * std::cos(angle)});
    if (i > 0) edges.push_back({i - 1, i});
  }
  EdgeAnswers together, alone;
  checker.checkEdges(batch, edges, {}, world.scratch, together);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    StateScratch fresh;
    checker.checkEdges(batch, {edges[i]}, {}, fresh, alone);
    EXPECT_EQ(together.edges[i].verdict, alone.edges[0].verdict) << i;
    EXPECT_EQ(together.edges[i].free_until, alone.edges[0].free_until) << i;
  }
}

TEST(EdgeAnswers, ShapesThatPassEachOtherWithinTheToleranceAreUnknownUntilItIsSmaller) {
  ArmWorld world;
  put(world.scene, ArmWorld::ballBody("ball"), at(0, 0.5 + 0.2 + 1e-4));  // the arm passes it at 0.1 mm
  const EdgeAnswer& near = world.checkEdge(0, 2 * kQuarter);
  EXPECT_EQ(near.verdict, Verdict::unknown);
  EXPECT_EQ(near.because, Unknown::tolerance);
  EXPECT_NEAR(near.free_until, 0.5, 0.02);
  EXPECT_TRUE(says(world.edge_sentence, "robot/arm and obstacle/ball come within"));
  EdgeRequest request;
  request.tolerance = 2e-5;
  EXPECT_EQ(world.checkEdge(0, 2 * kQuarter, request).verdict, Verdict::clear);
}

TEST(EdgeAnswers, AContactAfterANearPassIsStillFound) {
  ArmWorld world;
  put(world.scene, ArmWorld::ballBody("ball"), at(0, 0.5 + 0.2 + 1e-4));
  put(world.scene, ArmWorld::ballBody("wall"), at(-0.5));
  const EdgeAnswer& answer = world.checkEdge(0, 2 * kQuarter);
  EXPECT_EQ(answer.verdict, Verdict::hit);
  EXPECT_NEAR(answer.free_until, 0.5, 0.02);
  EXPECT_NEAR(answer.at * 2 * kQuarter, touchingAngle(2 * kQuarter), 3e-3);
}

/// Claim: the parts into which an edge is divided leave nothing out. A wire meets the fastest point of a cube on the
/// arm.
TEST(EdgeAnswers, NoConfigurationBeforeFreeUntilIsInContact) {
  Random random(1);
  RobotModel model = turningArm();
  model.links[1].shapes = {solidShape(Shape::box({0.2, 0.2, 0.2}), at(0.5))};
  for (int i = 0; i < 300; ++i) {
    ArmWorld world({}, model);
    Body wire = obstacle("wire", Mobility::fixed);
    wire.shapes = {solidShape(Shape::box({1e-4, 1e-4, 0.3}))};
    put(world.scene, wire, at(0.6));
    const double from = random.uniform(-1.4, -0.3), to = random.uniform(-0.1, 0.1);
    const EdgeAnswer answer = world.checkEdge(from, to);
    ASSERT_EQ(answer.verdict, Verdict::hit);
    EXPECT_EQ(world.verdictAt(from + answer.at * (to - from)), Verdict::hit);
    EXPECT_EQ(world.verdictAt(from + answer.free_until * (to - from)), Verdict::clear);
    double low = -0.3, high = -0.1;  // the first contact is between them
    while (high - low > 1e-9) {
      const double middle = 0.5 * (low + high);
      (world.verdictAt(middle) == Verdict::clear ? low : high) = middle;
    }
    EXPECT_LE(from + answer.free_until * (to - from), high);
    EXPECT_LE(from + answer.at * (to - from), high + 1e-3 / 0.6);
  }
}

TEST(EdgeAnswers, AJointWithoutLimitsTakesTheShorterWay) {
  RobotModel model = turningArm();
  model.links[1].continuous = true;
  ArmWorld free({}, model), limited;
  for (ArmWorld* world : {&free, &limited}) put(world->scene, ArmWorld::ballBody("ball"), at(0.5));
  const double from = kQuarter, to = -2 * kQuarter;  // through 0, or through half a turn
  EXPECT_EQ(free.checkEdge(from, to).verdict, Verdict::clear);
  EXPECT_EQ(limited.checkEdge(from, to).verdict, Verdict::hit);
  EXPECT_TRUE(limited.edge_answers.edges[0].beyond_limits);
}

/// Claim: if both ways around are equally short, an edge is unknown, because a controller may take either.
TEST(EdgeAnswers, AnEdgeOfHalfATurnIsUnknown) {
  RobotModel model = turningArm();
  model.links[1].continuous = true;
  ArmWorld world({}, model);
  for (const double turn : {2 * kQuarter, -2 * kQuarter, 2 * kQuarter + 5e-7, 2 * kQuarter - 5e-7, 6 * kQuarter}) {
    SCOPED_TRACE(turn);
    const EdgeAnswer& answer = world.checkEdge(0.3, 0.3 + turn);
    EXPECT_EQ(answer.verdict, Verdict::unknown);
    EXPECT_EQ(answer.because, Unknown::half_turn);
    EXPECT_EQ(answer.free_until, 0.0);
    EXPECT_TRUE(says(world.edge_sentence, "edge 0: joint 'arm_joint' turns by half a turn"));
  }
  EXPECT_EQ(world.checkEdge(0.3, 0.3 + 2 * kQuarter - 2e-6).verdict, Verdict::clear);
  model.links[1].continuous = false;
  model.links[1].lower = model.links[1].upper = 0.0;
  EXPECT_EQ(ArmWorld({}, model).checkEdge(0.0, 2 * kQuarter).verdict, Verdict::clear) << "this joint counts turns";
}

/// Claim: only a continuous joint takes the shorter way. The controller of a revolute joint without limits counts
/// turns.
TEST(EdgeAnswers, ARevoluteJointWithoutLimitsDoesNotTakeTheShorterWay) {
  RobotModel model = turningArm();
  model.links[1].lower = model.links[1].upper = 0.0;
  ArmWorld world({}, model);
  put(world.scene, ArmWorld::ballBody("ball"), at(0.5));
  EXPECT_EQ(world.checkEdge(kQuarter, -2 * kQuarter).verdict, Verdict::hit);
}

TEST(EdgeAnswers, AnInvalidEdgeIsRefusedByNameAndTheOthersAreAnswered) {
  ArmWorld world;
  world.check({0, std::nan(""), 1});
  const StateChecker checker(world.snapshot, Kinematics(world.model), "robot", narrowPhase());
  EdgeAnswers answers;
  checker.checkEdges(world.batch, {{0, 2}, {0, 1}, {1, 2}, {3, 0}, {2, 0}}, {}, world.scratch, answers);
  const std::vector<Code> codes{Code::ok, Code::nonfinite, Code::nonfinite, Code::out_of_range, Code::ok};
  for (std::size_t i = 0; i < codes.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(answers.edges[i].refused, codes[i]);
    EXPECT_EQ(answers.edges[i].verdict, codes[i] == Code::ok ? Verdict::clear : Verdict::unknown);
  }
  EXPECT_TRUE(says(checker.sentenceOf(world.batch, answers, 2), "edge 2, state 1: joint 'arm_joint'"));
  EXPECT_TRUE(says(checker.sentenceOf(world.batch, answers, 3), "edge 3 has the state 3"));
  EXPECT_TRUE(says(checker.sentenceOf(world.batch, answers, 3), "number of states, 3"));
}

TEST(EdgeAnswers, TheToleranceMustBeReasonable) {
  ArmWorld world;
  for (const double tolerance : {0.0, 1e-7, 2.0, std::nan("")}) {
    std::string sentence;
    EdgeRequest request;
    request.tolerance = tolerance;
    EXPECT_EQ(refusalOf([&] { world.checkEdge(0, 1, request); }, &sentence), Code::out_of_range);
    EXPECT_TRUE(says(sentence, text(tolerance)) && says(sentence, "between 1e-6 and 1"));
  }
}

TEST(EdgeAnswers, AfterTheDeadlineEdgesAreUnknown) {
  ArmWorld world;
  EdgeRequest request;
  request.deadline = std::chrono::steady_clock::now();
  const EdgeAnswer& answer = world.checkEdge(0, 1, request);
  EXPECT_EQ(answer.verdict, Verdict::unknown);
  EXPECT_EQ(answer.because, Unknown::budget);
  EXPECT_EQ(answer.free_until, 0.0);
  EXPECT_TRUE(says(world.edge_sentence, "deadline"));
}

TEST(EdgeAnswers, AnUnseenBodyMakesOnlyTheEdgesUnknownThatPassIt) {
  ArmWorld world;
  SourceGap gap;
  gap.source = "sensor";
  gap.sentence = "it lost a cloud";
  gap.within = Sphere{Eigen::Vector3d(0, 0.5, 0), 0.05};
  world.gaps.push_back(gap);
  EXPECT_EQ(world.checkEdge(0, -1).verdict, Verdict::clear);
  const EdgeAnswer& answer = world.checkEdge(0, kQuarter);
  EXPECT_EQ(answer.verdict, Verdict::unknown);
  EXPECT_EQ(answer.because, Unknown::incomplete);
  EXPECT_GT(answer.free_until, 0.5);
  EXPECT_LT(answer.free_until, 1.0);
  EXPECT_TRUE(says(world.edge_sentence, "it lost a cloud"));
  world.gaps[0].within.reset();  // now it can be anywhere
  EXPECT_EQ(world.checkEdge(0, -1).verdict, Verdict::unknown);
  EXPECT_EQ(world.edge_answers.edges[0].free_until, 0.0);
}

}  // namespace
}  // namespace hgrid
