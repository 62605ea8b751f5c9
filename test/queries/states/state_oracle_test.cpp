// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares StateChecker with an oracle that measures all shapes. HGRID_TEST_CHECKED_STATES sets the number of states.
#include <gtest/gtest.h>

#include "test/queries/states/state_worlds.h"

namespace hgrid {
namespace {

using namespace test;

constexpr double kReach = 0.08;  // [m] clearance that is asked for

/// Numbers of states of each kind, so that the test can show that it has looked at all of them.
struct Seen {
  int states = 0, hits = 0, clear = 0, self = 0, map = 0, plane = 0, held = 0, near = 0, far = 0, beyond = 0;

  void add(const Snapshot& snapshot, const Truth& truth, bool beyond_limits) {
    ++states;
    beyond += beyond_limits ? 1 : 0;
    ++(truth.contacts.empty() ? clear : hits);
    ++(truth.distance <= kReach ? near : far);
    for (const auto& [a, b] : truth.contacts) {
      const Body &first = snapshot.structure().bodies[a], &second = snapshot.structure().bodies[b];
      self += first.kind == BodyKind::link && second.kind == BodyKind::link ? 1 : 0;
      for (const Body* body : {&first, &second}) {
        map += body->kind == BodyKind::map ? 1 : 0;
        plane += body->name == "obstacle/floor" ? 1 : 0;
        held += body->name == "obstacle/held" ? 1 : 0;
      }
    }
  }
};

/// Compares the answers for one state with the oracle.
/// @param nearest  the answers to a request for the clearance
void compare(const Truth& truth, const StateAnswers& first, const StateAnswers& all, const StateAnswers& nearest,
             std::size_t i) {
  const Verdict verdict = truth.contacts.empty() ? Verdict::clear : Verdict::hit;
  for (const StateAnswers* answers : {&first, &all, &nearest}) {
    ASSERT_EQ(answers->states[i].verdict, verdict) << "distance " << truth.distance;
  }
  EXPECT_EQ(pairsOf(all, i), truth.contacts);
  EXPECT_EQ(first.states[i].pairs, truth.contacts.empty() ? 0u : 1u);
  for (const auto& pair : pairsOf(first, i)) EXPECT_EQ(truth.contacts.count(pair), 1u);
  if (truth.distance > kReach) {
    EXPECT_TRUE(std::isinf(nearest.states[i].clearance)) << truth.distance;
    EXPECT_EQ(nearest.states[i].pairs, 0u);
    return;
  }
  EXPECT_NEAR(nearest.states[i].clearance, truth.distance, 1e-9);
  ASSERT_EQ(nearest.states[i].pairs, 1u);
  const Proximity& proximity = nearest.pairs[nearest.states[i].first_pair].proximity;
  EXPECT_EQ(proximity.distance, nearest.states[i].clearance);
  if (proximity.distance > 1e-6) {
    EXPECT_NEAR((proximity.on_second - proximity.on_first).norm(), proximity.distance, 1e-6);
    EXPECT_NEAR((proximity.on_second - proximity.on_first).dot(proximity.normal), proximity.distance, 1e-6);
  }
}

/// Checks random states of one world with three requests.
void play(Random& random, const StateWorld& world, const Pose& world_from_root, bool give_root, int count, Seen& seen) {
  const StateChecker checker = world.checker();
  const StateOracle oracle(world);
  StateBatch batch;
  std::vector<std::vector<double>> states;
  for (int i = 0; i < count; ++i) {
    states.push_back(randomState(random, checker.kinematics()));
    append(batch, states.back());
  }
  if (give_root) batch.world_from_root = world_from_root;
  StateScratch scratch;
  StateAnswers first, all, nearest;
  StateRequest request;
  request.contacts = true;
  checker.checkStates(batch, request, scratch, first);
  request.all_pairs = true;
  checker.checkStates(batch, request, scratch, all);
  request.all_pairs = false;
  request.clearance = kReach;
  checker.checkStates(batch, request, scratch, nearest);
  ASSERT_EQ(first.states.size(), states.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    SCOPED_TRACE("state " + std::to_string(i));
    const Truth truth = oracle.of(states[i], world_from_root);
    const bool beyond = JointOracle(world.model, checker.kinematics(), states[i]).isBeyondLimits();
    EXPECT_EQ(first.states[i].beyond_limits, beyond);
    compare(truth, first, all, nearest, i);
    for (const StateAnswers* answers : {&first, &all, &nearest}) {
      const StateAnswer& answer = answers->states[i];
      for (std::uint32_t k = answer.first_pair; k < answer.first_pair + answer.pairs; ++k) {
        const StatePair& pair = answers->pairs[k];
        if (answer.verdict == Verdict::hit) {
          oracle.expectContact(pair, states[i], world_from_root);
        } else {
          EXPECT_TRUE(pair.contact.point.hasNaN());
        }
      }
    }
    seen.add(*world.snapshot, truth, beyond);
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(StateOracle, VerdictsPairsAndClearancesEqualThoseOfAllShapes) {
  const int count = countFromEnvironment("HGRID_TEST_CHECKED_STATES", 10000);
  constexpr int kPerWorld = 50;
  Seen seen;
  for (unsigned seed = 1; seen.states < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    WorldPlan plan;
    plan.links = random.between(2, 8);
    plan.obstacles = random.chance(0.5) ? random.between(0, 6) : random.between(20, 40);
    plan.far = plan.obstacles > 10 ? 1.5 : 0.8;
    plan.world_from_root = randomPose(random, seed % 4 == 0 ? 1000.0 : 1.0);
    const StateWorld world = randomStateWorld(random, plan);
    const bool give_root = random.chance(0.5);
    const Pose root = give_root ? plan.world_from_root * randomPose(random, 0.3) : plan.world_from_root;
    if (world.kinematics().variables().empty()) continue;
    play(random, world, root, give_root, kPerWorld, seen);
    if (HasFailure()) return;
  }
  EXPECT_GT(seen.hits, seen.states / 10);
  EXPECT_GT(seen.clear, seen.states / 10);
  EXPECT_GT(seen.near, seen.hits + seen.states / 50);
  EXPECT_GT(seen.far, seen.states / 100);
  for (const int kind : {seen.self, seen.map, seen.plane, seen.held, seen.beyond}) EXPECT_GT(kind, seen.states / 100);
}

/// Claim: lattices of the robot's meshes change no answer. Most links are in the box around the first link, which is a
/// tray, so the lattices decide many of the pairs.
TEST(StateOracle, RobotsOfMeshesWithLatticesEqualTheOracle) {
  Seen seen;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    WorldPlan plan;
    plan.links = random.between(3, 7);
    plan.obstacles = 1;
    plan.map = plan.plane = false;  // the tray would touch them in all states
    plan.closed_meshes = true;
    plan.world_from_root = randomPose(random, seed % 4 == 0 ? 1000.0 : 1.0);
    const StateWorld world = randomStateWorld(random, plan);
    if (world.kinematics().variables().empty()) continue;
    play(random, world, plan.world_from_root, false, 40, seen);
    if (HasFailure()) return;
  }
  EXPECT_GT(seen.self, seen.states / 20);
  EXPECT_GT(seen.clear, seen.states / 20);
}

/// Claim: links with more shapes than one search of the grid covers are compared with everything, too.
TEST(StateOracle, LinksOfManyShapesEqualTheOracle) {
  Seen seen;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    WorldPlan plan;
    plan.links = 2;       // they may touch each other
    plan.obstacles = 30;  // so many that they are in a grid
    plan.shapes = 60;
    plan.size = 0.04;
    const StateWorld world = randomStateWorld(random, plan);
    if (world.kinematics().variables().empty()) continue;
    play(random, world, plan.world_from_root, false, 20, seen);
    if (HasFailure()) return;
  }
  EXPECT_GT(seen.hits, seen.states / 10);
  EXPECT_GT(seen.clear, seen.states / 10);
}

}  // namespace
}  // namespace hgrid
