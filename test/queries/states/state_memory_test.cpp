// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// This test is a separate program, because it replaces operator new.
#include <gtest/gtest.h>

#include "test/queries/states/state_worlds.h"
#include "test/support/counted_allocations.h"

namespace hgrid {
namespace {

using namespace test;

TEST(StateMemory, LaterBatchesAllocateNothing) {
  int hits = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    WorldPlan plan;
    plan.obstacles = seed % 2 == 0 ? 10 : 40;
    const StateWorld world = randomStateWorld(random, plan);
    const StateChecker checker = world.checker();
    StateBatch batch;
    for (int i = 0; i < 50; ++i) append(batch, randomState(random, checker.kinematics()));
    for (const JointVariable& variable : checker.kinematics().variables()) batch.joints.push_back(variable.name);
    StateScratch scratch;
    StateAnswers answers;
    std::vector<StateRequest> requests(3);
    requests[1].all_pairs = requests[1].contacts = true;
    requests[2].clearance = 0.1;
    for (const StateRequest& request : requests) checker.checkStates(batch, request, scratch, answers);
    const std::size_t before = allocatedBytes();
    for (const StateRequest& request : requests) checker.checkStates(batch, request, scratch, answers);
    EXPECT_EQ(allocatedBytes() - before, 0u);
    std::vector<StateEdge> edges;
    for (std::uint32_t i = 0; i + 1 < 50; ++i) edges.push_back({i, i + 1});
    EdgeAnswers edge_answers;
    EdgeRequest edge_request;
    edge_request.contacts = true;
    checker.checkEdges(batch, edges, edge_request, scratch, edge_answers);
    const std::size_t before_edges = allocatedBytes();
    checker.checkEdges(batch, edges, edge_request, scratch, edge_answers);
    EXPECT_EQ(allocatedBytes() - before_edges, 0u) << "edges";
    for (const StateAnswer& answer : answers.states) hits += answer.verdict == Verdict::hit ? 1 : 0;
  }
  EXPECT_GT(hits, 100);
}

}  // namespace
}  // namespace hgrid
