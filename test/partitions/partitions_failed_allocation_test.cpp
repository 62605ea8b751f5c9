// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Claim: if memory runs out during a change of a partition of the book, or during a search that builds it again, it
// holds either the boxes before the change, if the call threw, or the boxes after it. No pair is lost.
#include <gtest/gtest.h>

#include <functional>

#include "hgrid_proximity/partitions/partitions.h"
#include "test/support/brute_force.h"
#include "test/support/failing_allocations.h"
#include "test/support/grids.h"

namespace hgrid {
namespace {

using test::BruteForce;
using test::Random;
using Change = std::function<void(BroadPhase&)>;

Aabb randomBox(Random& random) {
  return test::boxAround(test::randomVector(random, -3, 3),
                         random.logUniform(0.05, 4) * test::randomVector(random, 0, 1));
}

Change randomChange(const BruteForce& now, Random& random) {
  const Aabb box = randomBox(random);
  const auto id = ProxyId(random.below(80));
  const bool known = now.boxes().count(id) != 0;
  const double which = random.uniform(0, 1);
  if (which < 0.2) {
    std::vector<ProxyId> ids;
    std::vector<Aabb> boxes;
    for (const auto& stored : now.boxes()) {
      if (random.chance(0.1)) continue;
      ids.push_back(stored.first);
      boxes.push_back(random.chance(0.3) ? randomBox(random) : stored.second);
    }
    return [=](BroadPhase& tested) { tested.update(ids, boxes); };
  }
  if (which < 0.25) {
    std::vector<ProxyId> fixed;
    for (ProxyId one = 0; one < 80; ++one) {
      if (random.chance(0.3)) fixed.push_back(one);
    }
    return [=](BroadPhase& tested) { tested.setFixed(fixed); };
  }
  if (!known) return [=](BroadPhase& tested) { tested.insert(id, box); };
  if (which < 0.4) return [=](BroadPhase& tested) { tested.remove(id); };
  return [=](BroadPhase& tested) { tested.update(id, box); };
}

void expectHolds(const BroadPhase& tested, const BruteForce& model) {
  ASSERT_NO_THROW(tested.checkInvariants());
  ASSERT_EQ(tested.size(), model.size());
  ASSERT_EQ(test::pairsOf(tested), test::pairsOf(model));
}

TEST(PartitionsFailedAllocation, LosesNothing) {
  for (const BroadPhaseType type : broadPhaseTypes()) {
    if (type == BroadPhaseType::hgrid) continue;  // hgrid_failed_allocation_test.cpp tests it
    SCOPED_TRACE(name(type));
    std::size_t failed_searches = 0;
    Random random(4);
    const std::unique_ptr<BroadPhase> tested = makeBroadPhase({type});
    BruteForce model;
    for (ProxyId id = 0; id < 50; ++id) {
      const Aabb box = randomBox(random);
      tested->insert(id, box);
      model.insert(id, box);
    }
    for (std::size_t step = 0; step < 150; ++step) {
      SCOPED_TRACE("step " + std::to_string(step));
      if (step % 3 != 0) expectHolds(*tested, model);  // else several changes follow each other without a search
      const Change change = randomChange(model, random);
      const auto which = step % 2 == 0 ? test::Failing::one : test::Failing::from_then_on;
      // A change can fail only where the table of boxes grows, see OfAnInsertionChangesNothing.
      if (test::failsAt(1 + step % 7, which, [&] { change(*tested); })) {
        if (step % 2 == 0) {
          ASSERT_NO_FATAL_FAILURE(expectHolds(*tested, model));
        }
        change(*tested);
      }
      change(model);
      failed_searches += test::failsAt(1 + step % 11, which, [&] {
        std::vector<ProxyPair> pairs;
        tested->overlappingPairs(pairs);
      });
      ASSERT_NO_FATAL_FAILURE(expectHolds(*tested, model));
    }
    EXPECT_GT(failed_searches, 20u);
  }
}

/// Claim: an insertion for which the table of boxes finds no memory throws and changes nothing.
TEST(PartitionsFailedAllocation, OfAnInsertionChangesNothing) {
  for (const BroadPhaseType type : broadPhaseTypes()) {
    SCOPED_TRACE(name(type));
    const std::unique_ptr<BroadPhase> tested = makeBroadPhase({type});
    const Aabb box = {{0, 0, 0}, {1, 1, 1}};
    tested->insert(1, box);
    bool failed = true;
    std::size_t failures = 0;
    for (std::size_t k = 1; failed; ++k) {
      failed = test::failsAt(k, test::Failing::one, [&] { tested->insert(1000, box); });
      failures += failed;
      ASSERT_EQ(tested->size(), failed ? 1u : 2u);
      ASSERT_EQ(test::pairsOf(*tested).size(), failed ? 0u : 1u);
    }
    EXPECT_GE(failures, 1u);
  }
}

}  // namespace
}  // namespace hgrid
