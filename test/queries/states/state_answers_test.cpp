// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "hgrid_proximity/queries/distance_field.h"
#include "hgrid_proximity/queries/query.h"
#include "test/queries/states/turning_arm.h"
#include "test/support/solids.h"

namespace hgrid {
namespace {

using namespace test;

/// Expects that two answers are equal, bit by bit, for two states.
void expectSame(const StateAnswers& a, std::size_t i, const StateAnswers& b, std::size_t k) {
  const StateAnswer &one = a.states[i], &other = b.states[k];
  EXPECT_EQ(one.verdict, other.verdict);
  EXPECT_EQ(one.because, other.because);
  EXPECT_EQ(one.beyond_limits, other.beyond_limits);
  EXPECT_TRUE(one.clearance == other.clearance || (std::isnan(one.clearance) && std::isnan(other.clearance)));
  ASSERT_EQ(one.pairs, other.pairs);
  for (std::uint32_t n = 0; n < one.pairs; ++n) {
    const StatePair &p = a.pairs[one.first_pair + n], &q = b.pairs[other.first_pair + n];
    EXPECT_EQ(std::tie(p.first, p.second, p.first_shape, p.second_shape),
              std::tie(q.first, q.second, q.first_shape, q.second_shape));
    EXPECT_EQ(p.proximity.status, q.proximity.status);
    EXPECT_EQ(p.proximity.distance, q.proximity.distance);
    if (p.proximity.on_first.allFinite()) {
      EXPECT_EQ(p.proximity.on_first, q.proximity.on_first);
    }
  }
}

struct Case {
  explicit Case(unsigned seed) {
    Random random(seed);
    WorldPlan plan;
    plan.obstacles = 40;
    world = randomStateWorld(random, plan);
    for (int i = 0; i < 41; ++i) states.push_back(randomState(random, world.kinematics()));
  }
  StateAnswers check(const std::vector<std::vector<double>>& some, double clearance) const {
    StateBatch batch;
    for (const auto& state : some) append(batch, state);
    StateRequest request;
    request.clearance = clearance;
    StateScratch scratch;
    StateAnswers answers;
    world.checker().checkStates(batch, request, scratch, answers);
    return answers;
  }
  StateWorld world;
  std::vector<std::vector<double>> states;
};

TEST(StateAnswers, DependNeitherOnTheOtherStatesNorOnTheirOrder) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Case one(seed);
    const double clearance = seed % 2 == 0 ? 0.0 : 0.1;
    const StateAnswers together = one.check(one.states, clearance);
    std::vector<std::vector<double>> reversed(one.states.rbegin(), one.states.rend());
    const StateAnswers backward = one.check(reversed, clearance);
    for (std::size_t i = 0; i < one.states.size(); ++i) {
      SCOPED_TRACE("state " + std::to_string(i));
      expectSame(together, i, one.check({one.states[i]}, clearance), 0);
      expectSame(together, i, backward, one.states.size() - 1 - i);
    }
  }
}

TEST(StateAnswers, SeveralThreadsGetTheSameAnswersFromOneChecker) {
  const Case one(3);
  const StateChecker checker = one.world.checker();
  StateBatch batch;
  for (const auto& state : one.states) append(batch, state);
  std::vector<StateAnswers> answers(4);
  std::vector<std::thread> threads;
  for (StateAnswers& mine : answers) {
    threads.emplace_back([&] {
      StateScratch scratch;
      for (int i = 0; i < 20; ++i) checker.checkStates(batch, {}, scratch, mine);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const StateAnswers& mine : answers) {
    for (std::size_t i = 0; i < one.states.size(); ++i) expectSame(answers[0], i, mine, i);
  }
}

TEST(StateAnswers, JointsMayBeNamedInAnyOrderAndOthersKeepTheirValues) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Case one(seed);
    const StateAnswers expected = one.check(one.states, 0.05);
    const std::vector<JointVariable> variables = one.world.kinematics().variables();
    for (std::size_t i = 0; i < 5; ++i) {
      StateBatch batch;
      batch.others = one.states[i];
      for (std::size_t k = variables.size(); k-- > variables.size() / 2;) {
        batch.joints.push_back(variables[k].name);
        batch.positions.push_back(one.states[i][k]);
        batch.others[k] = 0.0;
      }
      for (std::size_t k = 0; k < variables.size(); ++k) {
        // A quaternion of the others must stay valid.
        if (variables[k].quaternion >= 0) batch.others[k] = one.states[i][k];
      }
      StateRequest request;
      request.clearance = 0.05;
      StateScratch scratch;
      StateAnswers answers;
      one.world.checker().checkStates(batch, request, scratch, answers);
      ASSERT_EQ(answers.states.size(), 1u);
      expectSame(answers, 0, expected, i);
    }
  }
}

// The positions of the other joints are the same in all states, but their links move with the joints above them.
TEST(StateAnswers, OfABatchWithSomeJointsAreThoseOfTheWholeStates) {
  int batches = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Case one(seed % 8 + 1);
    const std::vector<JointVariable> variables = one.world.kinematics().variables();
    StateBatch batch;
    batch.others = one.states[0];
    std::vector<std::vector<double>> states(one.states.size(), one.states[0]);
    for (std::size_t k = 0; k < variables.size(); ++k) {
      if (variables[k].quaternion >= 0 || random.chance(0.5)) continue;
      batch.joints.push_back(variables[k].name);
      for (std::size_t i = 0; i < states.size(); ++i) states[i][k] = one.states[i][k];
    }
    if (batch.joints.empty()) continue;
    for (const std::vector<double>& state : states) {
      for (std::size_t k = 0; k < variables.size(); ++k) {
        const auto found = std::find(batch.joints.begin(), batch.joints.end(), variables[k].name);
        if (found != batch.joints.end()) batch.positions.push_back(state[k]);
      }
    }
    StateRequest request;
    request.clearance = 0.05;
    StateScratch scratch;
    StateAnswers answers;
    one.world.checker().checkStates(batch, request, scratch, answers);
    ASSERT_EQ(answers.states.size(), states.size());
    const StateAnswers expected = one.check(states, 0.05);
    for (std::size_t i = 0; i < states.size(); ++i) expectSame(answers, i, expected, i);
    ++batches;
  }
  EXPECT_GT(batches, 20);
}

TEST(StateAnswers, AnIgnoredBodyIsLeftOut) {
  ArmWorld world;
  put(world.scene, ArmWorld::ballBody("ball"), at(0, 0.5));
  EXPECT_EQ(world.verdictAt(kQuarter), Verdict::hit);
  EXPECT_EQ(world.verdictAt(kQuarter, {}, {{"*/ball"}}), Verdict::clear);
}

TEST(StateAnswers, AShapeWithoutASolidIsAHitWhereItsBoxIs) {
  ArmWorld world;
  Body ball = ArmWorld::ballBody("ball");
  ball.shapes[0].solid = nullptr;
  put(world.scene, ball, at(0, 0.5));
  EXPECT_EQ(world.verdictAt(0), Verdict::clear);
  EXPECT_EQ(world.verdictAt(kQuarter), Verdict::hit);
  EXPECT_EQ(world.answers.pairs.at(0).proximity.status, Measure::not_measured);
}

TEST(StateAnswers, OnlyBodiesThatTheGroupMovesCount) {
  RobotModel model = turningArm();
  addLink(model, "other_arm", 0, JointKind::revolute, false);
  model.links.back().has_collision = true;
  model.links.back().axis = Eigen::Vector3d::UnitZ();
  model.links.back().shapes = {solidShape(Shape::sphere(0.1), at(0.5))};
  findRigidGroups(model);
  ArmWorld world({}, model);
  put(world.scene, ArmWorld::ballBody("ball"), at(0, 0.5));
  StateCheckerOptions options;
  options.group = {"arm_joint"};
  world.batch.others = {0, kQuarter};
  world.batch.joints = {"arm_joint"};
  EXPECT_EQ(world.verdictAt(0), Verdict::hit) << "the other arm touches the ball";
  EXPECT_EQ(world.verdictAt(0, {}, options), Verdict::clear);
  EXPECT_EQ(world.verdictAt(1.3, {}, options), Verdict::hit) << "the two arms touch each other";
  options.group = {"elbow"};
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { world.verdictAt(0, {}, options); }, &sentence), Code::unknown_id);
  EXPECT_TRUE(says(sentence, "'elbow'"));
}

TEST(StateAnswers, AnAttachedObstacleMovesWithItsLink) {
  ArmWorld world;
  put(world.scene, ArmWorld::ballBody("ball"), at(0, 0.9));
  Body held = ArmWorld::ballBody("held");
  held.frame = "arm";
  held.frame_from_body = at(0.8);
  put(world.scene, held, at(9));
  EXPECT_EQ(world.verdictAt(0), Verdict::clear);
  EXPECT_EQ(world.verdictAt(kQuarter), Verdict::hit);
  const std::uint32_t index = indexOf(*world.snapshot, "obstacle/held");
  EXPECT_EQ(world.answers.pairs.at(0).first, index);
}

TEST(StateAnswers, AnObstacleInTheFrameOfAFixedLinkRestsInTheWorld) {
  ArmWorld world;
  Body base = world.scene.body(world.links[0]);
  base.mobility = Mobility::fixed;
  const BodyId id = world.scene.exchange({world.links[0]}, {base}).at(0);
  world.scene.place(id, Pose::Identity(), Time{1});
  Body ball = ArmWorld::ballBody("ball");
  ball.frame = "base";
  put(world.scene, ball, at(0, 0.5));
  EXPECT_EQ(world.verdictAt(kQuarter), Verdict::hit);
  EXPECT_EQ(world.verdictAt(0), Verdict::clear) << "if it moved with the base, it would be at the origin";
}

TEST(StateAnswers, AnObstacleInTheWorldFrameRestsEvenIfALinkHasTheNameOfTheFrame) {
  ArmWorld world;
  Body cart = ArmWorld::ballBody("cart");
  cart.frame = "arm";
  cart.frame_from_body = at(0, 0.5);
  put(world.scene, cart, at(0, 0.5));
  StateCheckerOptions options;
  options.world_frame = "arm";
  EXPECT_EQ(world.verdictAt(kQuarter, {}, options), Verdict::hit);
  EXPECT_EQ(world.verdictAt(kQuarter), Verdict::clear) << "it moves with the arm if the frame is that of the link";
}

/// Claim: rounding never hides a contact, also of a mesh that is far from the origin of its link.
TEST(StateAnswers, AMeshFarFromTheOriginOfItsLinkTouchesWhatItTouches) {
  Random random(1);
  TriangleMesh cube;
  for (int i = 0; i < 8; ++i)
    cube.vertices.emplace_back(10.0 + 0.005 * (i & 1), 0.005 * (i >> 1 & 1), 0.005 * (i >> 2));
  cube.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  RobotModel model = turningArm();
  model.links[1].shapes = {solidShape(Shape::mesh(std::make_shared<TriangleMesh>(cube)))};
  for (int i = 0; i < 100; ++i) {
    const double angle = random.uniform(-3, 3);
    ArmWorld world({}, model);
    const Pose turned(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
    Body plate = obstacle("plate");
    plate.shapes.push_back(solidShape(Shape::box({0.01, 0.01, 0.01})));
    put(world.scene, plate, turned * at(10.005 + 0.005 - 5e-8, 0.0025, 0.0025));  // 50 nm inside the mesh
    EXPECT_EQ(world.verdictAt(angle), Verdict::hit) << angle;
  }
}

/// Claim: checks and exact queries agree that something is in a mesh whose faces are two-sided, or turned around, or
/// for both sides but divided in different ways. They find it clear where it is.
TEST(StateAnswers, AMeshIsAroundWhatItsFacesEncloseWhateverTheirDirections) {
  const TriangleMesh box = boxMesh({0.6, 0.6, 0.6});
  TriangleMesh three_sides = box, inner = box;
  for (std::size_t i = 0; i < 6; ++i) std::swap(three_sides.triangles[i][1], three_sides.triangles[i][2]);
  for (auto& [a, b, c] : inner.triangles) std::swap(b, c);
  inner.vertices.push_back({0.3, 0.1, 0.2});  // in a side, which is divided at this corner
  inner.triangles.pop_back();
  inner.triangles.insert(inner.triangles.end(), {{3, 5, 8}, {5, 7, 8}, {7, 3, 8}});
  for (const TriangleMesh& mesh : {box, twoSided(box), unwelded(twoSided(box)), three_sides, joined(box, inner)}) {
    ArmWorld world;
    Body crate = obstacle("crate");
    crate.shapes.push_back(solidShape(meshOf(mesh)));
    put(world.scene, crate, at(0.5));
    EXPECT_EQ(world.verdictAt(0.0), Verdict::hit) << "the ball of the arm is in the middle of the crate";
    EXPECT_EQ(world.verdictAt(2.0), Verdict::clear);
    EXPECT_EQ(world.checkEdge(2.0, 0.0).verdict, Verdict::hit);
    QueryScope scope;
    scope.exact = narrowPhase().get();
    scope.exclude = {"robot/*"};
    const auto expectHit = [&scope](const QueryAnswer& answer) {
      EXPECT_EQ(answer.verdict, Verdict::hit);
      ASSERT_EQ(answer.hits.size(), 1u);
      EXPECT_EQ(answer.hits[0].distance, 0.0);
      EXPECT_FALSE(answer.hits[0].signed_distance > 0.0);
    };
    const Snapshot& snapshot = *world.snapshot;
    expectHit(query(snapshot, Sphere{{0.5, 0, 0}, 0.05}, scope));
    expectHit(query(snapshot, Segment{{0.4, 0, 0}, {0.6, 0.01, 0}, 0.01}, scope));
    expectHit(query(snapshot, QueryBox{at(0.5), {0.1, 0.1, 0.1}}, *narrowPhase(), scope));
    expectHit(query(snapshot, QueryShape{Shape::cone(0.1, 0.1), at(0.5)}, *narrowPhase(), scope));
    expectHit(nearest(snapshot, {0.5, 0, 0}, 0.0, scope));
    EXPECT_EQ(query(snapshot, Sphere{{0.5, 0, 0.4}, 0.05}, scope).verdict, Verdict::clear);
    Lattice point;
    point.world_from_lattice = at(0.5);
    point.resolution = 0.1;
    point.count = {1, 1, 1};
    EXPECT_LE(distanceField(snapshot, point, {5.0, true}, *narrowPhase(), scope).distance.at(0), 0.0);
  }
}

TEST(StateAnswers, TheLinksOfAnotherRobotStayWhereTheyAre) {
  ArmWorld world;
  Body other = ArmWorld::ballBody("x");
  other.name = "second/tool";
  other.kind = BodyKind::link;
  other.robot = "second";
  put(world.scene, other, at(0, 0.5));
  EXPECT_EQ(world.verdictAt(kQuarter), Verdict::hit);
  EXPECT_EQ(world.verdictAt(0), Verdict::clear);
}

TEST(StateAnswers, TheContactHasTheNamesAndShapesOfBothBodies) {
  ArmWorld world;
  Body two = ArmWorld::ballBody("two");
  two.shapes.push_back(solidShape(Shape::sphere(0.1), at(0, 5)));
  put(world.scene, two, at(0, -4.5));
  EXPECT_EQ(world.verdictAt(kQuarter), Verdict::hit);
  const StatePair& pair = world.answers.pairs.at(0);
  EXPECT_EQ(world.snapshot->structure().bodies[pair.first].name, "robot/arm");
  EXPECT_EQ(world.snapshot->structure().bodies[pair.second].name, "obstacle/two");
  EXPECT_EQ(pair.second_shape, 1u);
}

}  // namespace
}  // namespace hgrid
