// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Claim: if memory runs out during a change of the grid, the grid does not change. The tests let each memory allocation
// of each change fail once. Before and after the failure, the grid must contain the same boxes and find the same pairs
// as a simple model, which is a map of boxes by id.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <string>

#include "src/broadphase/hgrid/cell_plan.h"
#include "test/support/failing_allocations.h"
#include "test/support/grids.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace {

using Boxes = std::map<ProxyId, Aabb>;

/// One change. It is stored as a function that changes the grid and a function that changes the model.
struct Change {
  std::string name;
  std::function<void(HGrid&)> of_grid;
  std::function<void(Boxes&)> of_model;
};

std::vector<ProxyId> idsOf(const Boxes& boxes) {
  std::vector<ProxyId> ids;
  for (const auto& box : boxes) ids.push_back(box.first);
  return ids;
}

std::vector<Aabb> boxesOf(const Boxes& boxes) {
  std::vector<Aabb> values;
  for (const auto& box : boxes) values.push_back(box.second);
  return values;
}

Aabb randomBox(test::Random& random) {
  return test::boxAround(test::randomVector(random, -3, 3),
                         random.logUniform(0.05, 4) * test::randomVector(random, 0, 1));
}

Change bulkUpdate(Boxes boxes) {
  const std::vector<ProxyId> ids = idsOf(boxes);
  const std::vector<Aabb> values = boxesOf(boxes);
  return {"bulk update", [=](HGrid& grid) { grid.update(ids, values); }, [=](Boxes& model) { model = boxes; }};
}

/// Returns a random change that is possible if the world has the boxes `now`. Most changes affect only a few boxes.
Change randomChange(const Boxes& now, test::Random& random) {
  const auto some = [&] { return std::next(now.begin(), random.below(int(now.size())))->first; };
  const double which = random.uniform(0, 1);
  const Aabb box = randomBox(random);
  if (now.empty() || which < 0.3) {
    ProxyId id = ProxyId(random.below(200));
    while (now.count(id) != 0) ++id;
    return {"insert", [=](HGrid& grid) { grid.insert(id, box); }, [=](Boxes& model) { model[id] = box; }};
  }
  if (which < 0.5) {
    const ProxyId id = some();
    return {"update", [=](HGrid& grid) { grid.update(id, box); }, [=](Boxes& model) { model[id] = box; }};
  }
  if (which < 0.65) {
    const ProxyId id = some();
    return {"remove", [=](HGrid& grid) { grid.remove(id); }, [=](Boxes& model) { model.erase(id); }};
  }
  Boxes boxes = now;
  if (which < 0.75) {  // a bulk move of a few boxes
    Boxes moved;
    for (int i = random.below(6); i >= 0; --i) moved[some()] = randomBox(random);
    const std::vector<ProxyId> ids = idsOf(moved);
    const std::vector<Aabb> values = boxesOf(moved);
    return {"move", [=](HGrid& grid) { grid.move(ids, values); },
            [=](Boxes& model) {
              for (const auto& one : moved) model[one.first] = one.second;
            }};
  }
  if (which < 0.95) {
    const double share = random.chance(0.5) ? 0.05 : 0.8;
    for (auto& one : boxes) {
      if (random.chance(share)) one.second = randomBox(random);
    }
    if (random.chance(0.4)) boxes[ProxyId(random.below(300))] = box;
    if (random.chance(0.4)) boxes.erase(some());
    return bulkUpdate(boxes);
  }
  if (which < 0.96) {
    return {"clear", [](HGrid& grid) { grid.clear(); }, [](Boxes& model) { model.clear(); }};
  }
  return {"setThreads", [threads = random.between(1, 3)](HGrid& grid) { grid.setThreads(threads); }, [](Boxes&) {}};
}

std::vector<ProxyPair> pairsOf(const HGrid& grid) {
  std::vector<ProxyPair> pairs;
  grid.overlappingPairs(pairs);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

void expectHolds(const HGrid& grid, const Boxes& model) {
  grid.checkInvariants();
  ASSERT_EQ(grid.size(), model.size());
  std::vector<ProxyPair> expected;
  for (auto a = model.begin(); a != model.end(); ++a) {
    for (auto b = std::next(a); b != model.end(); ++b) {
      if (test::oracleOverlap(a->second, b->second)) expected.push_back({a->first, b->first});
    }
  }
  ASSERT_EQ(pairsOf(grid), expected);
}

/// Returns a grid after the first `count` changes. Sometimes searches for pairs; the grid then keeps the pairs of
/// resting boxes.
HGrid gridAfter(const std::vector<Change>& changes, std::size_t count) {
  HGrid grid;
  for (std::size_t i = 0; i < count; ++i) {
    changes[i].of_grid(grid);
    if (i % 3 == 0) pairsOf(grid);
  }
  return grid;
}

TEST(HGridFailedAllocation, ChangesNothing) {
  std::size_t failures = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    test::Random random(seed);
    std::vector<Change> changes;
    Boxes model;
    for (std::size_t step = 0; step < 240; ++step) {
      changes.push_back(randomChange(model, random));
      const Change& change = changes.back();
      Boxes then = model;
      change.of_model(then);
      HGrid counting = gridAfter(changes, step);
      const std::size_t allocations = test::allocationsOf([&] { change.of_grid(counting); });
      for (std::size_t k = 1; k <= allocations; ++k) {
        for (const test::Failing which : {test::Failing::one, test::Failing::from_then_on}) {
          SCOPED_TRACE("seed " + std::to_string(seed) + ", step " + std::to_string(step) + " (" + change.name +
                       "), allocation " + std::to_string(k));
          HGrid grid = gridAfter(changes, step);
          if (test::failsAt(k, which, [&] { change.of_grid(grid); })) {
            ++failures;
            expectHolds(grid, model);
            change.of_grid(grid);
          }
          expectHolds(grid, then);
          if (HasFatalFailure()) return;
        }
      }
      model = then;
    }
  }
  EXPECT_GT(failures, 500u) << "too few allocations failed for a meaningful test";
}

/// Claim: a search that fails does not change the grid or the pairs that the grid keeps.
TEST(HGridFailedAllocation, OfASearchLosesNoPair) {
  test::Random random(3);
  Boxes model;
  for (ProxyId id = 0; id < 400; ++id) model[id] = randomBox(random);
  HGrid grid;
  for (int tick = 0; tick < 20; ++tick) {
    for (int i = 0; i < 5; ++i) model[ProxyId(random.below(400))] = randomBox(random);
    bulkUpdate(model).of_grid(grid);
    for (std::size_t k = 1; test::failsAt(k, test::Failing::one, [&] { pairsOf(grid); }); ++k) {
      expectHolds(grid, model);
      if (HasFatalFailure()) return;
    }
  }
}

/// Uses so many boxes that the grid also allocates arrays for several threads.
TEST(HGridFailedAllocation, ChangesNothingOfALargeGridWithTwoThreads) {
  test::Random random(4);
  Boxes first, second;
  for (ProxyId id = 0; id < 33000; ++id) {
    const Eigen::Vector3d center = test::randomVector(random, -30, 30);
    first[id] = test::boxAround(center, test::randomVector(random, 0.1, 1));
    if (id % 10 != 0) second[id] = test::boxAround(2.0 * center, test::randomVector(random, 0.1, 2));
  }
  const Change to_first = bulkUpdate(first), to_second = bulkUpdate(second);
  const auto gridOfFirst = [&] {
    HGrid grid;
    grid.setThreads(2);
    to_first.of_grid(grid);
    return grid;
  };
  HGrid reference = gridOfFirst();
  const std::vector<ProxyPair> before = pairsOf(reference);
  to_second.of_grid(reference);
  const std::vector<ProxyPair> after = pairsOf(reference);
  bool failed = true;
  for (std::size_t k = 1; failed; ++k) {
    SCOPED_TRACE("allocation " + std::to_string(k));
    HGrid grid = gridOfFirst();
    failed = test::failsAt(k, test::Failing::one, [&] { to_second.of_grid(grid); });
    if (failed) {
      grid.checkInvariants();
      ASSERT_TRUE(pairsOf(grid) == before);
      to_second.of_grid(grid);
    }
    grid.checkInvariants();
    ASSERT_TRUE(pairsOf(grid) == after);
  }
}

TEST(HGridFailedAllocation, OfSetFixedKeepsTheFixedOnes) {
  test::Random random(5);
  Boxes model;
  for (ProxyId id = 0; id < 100; ++id) model[id] = randomBox(random);
  const auto gridOfAll = [&] {
    HGrid grid;
    bulkUpdate(model).of_grid(grid);
    return grid;
  };
  std::vector<ProxyId> fixed;
  for (ProxyId id = 0; id < 100; id += 2) fixed.push_back(id);
  HGrid reference = gridOfAll();
  const std::vector<ProxyPair> before = pairsOf(reference);
  reference.setFixed(fixed);
  const std::vector<ProxyPair> after = pairsOf(reference);
  ASSERT_NE(before, after);
  for (std::size_t k = 1;; ++k) {
    SCOPED_TRACE("allocation " + std::to_string(k));
    HGrid grid = gridOfAll();
    const bool failed = test::failsAt(k, test::Failing::one, [&] { grid.setFixed(fixed); });
    grid.checkInvariants();
    ASSERT_EQ(pairsOf(grid), failed ? before : after);
    if (!failed) break;
  }
}

/// Returns boxes in heaps that are far apart. The grid then divides space into regions.
Boxes heaps(test::Random& random, int heaps, int boxes_each, const Eigen::Vector3d& moved) {
  Boxes boxes;
  for (int i = 0; i < heaps * boxes_each; ++i) {
    const Eigen::Vector3d place = 5e3 * Eigen::Vector3d(i % heaps % 3, i % heaps % 5, -(i % heaps));
    boxes[ProxyId(i)] = test::boxAround(place + moved + test::randomVector(random, -3, 3), {1, 1, 1});
  }
  return boxes;
}

TEST(HGridFailedAllocation, InAWorldOfRegionsChangesNothingOrMakesOneRegion) {
  test::Random random(3);
  const Boxes first = heaps(random, 4, 80, {0, 0, 0}), all_moved = heaps(random, 4, 80, {50, 0, 0});
  const Boxes more = heaps(random, 7, 80, {0, 100, 0});
  Boxes few_moved = first;
  for (ProxyId id = 0; id < 40; ++id) few_moved[id] = all_moved.at(id + 40);
  std::size_t failures = 0, allocations = 0;
  for (const Boxes* next : std::initializer_list<const Boxes*>{&first, &all_moved, &more, &few_moved}) {
    const std::vector<ProxyId> ids = idsOf(*next);
    const std::vector<Aabb> values = boxesOf(*next);
    const auto gridBefore = [&] {
      HGrid grid;
      if (next == &first) return grid;
      grid.update(idsOf(first), boxesOf(first));
      pairsOf(grid);
      return grid;
    };
    for (const test::Failing which : {test::Failing::one, test::Failing::from_then_on}) {
      HGrid undisturbed = gridBefore();
      const std::size_t count = test::allocationsOf([&] { undisturbed.update(ids, values); });
      allocations += count;
      for (std::size_t k = 1; k <= count; ++k) {
        SCOPED_TRACE("allocation " + std::to_string(k) + " of " + std::to_string(count));
        HGrid grid = gridBefore();
        const bool failed = test::failsAt(k, which, [&] { grid.update(ids, values); });
        failures += failed;
        ASSERT_NO_FATAL_FAILURE(expectHolds(grid, !failed ? *next : next == &first ? Boxes() : first));
        grid.update(ids, values);
        ASSERT_NO_FATAL_FAILURE(expectHolds(grid, *next));
      }
    }
  }
  EXPECT_GT(failures, 20u);
  EXPECT_GT(allocations, 2 * failures)
      << "most allocations are for regions, and the grid must also work without regions";
}

/// Claim: if there is no memory for many levels, the layer works with one cell. Rods along three axes have four levels.
TEST(HGridFailedAllocation, OfManyLevelsMakesOneCell) {
  test::Random random(6);
  std::vector<Aabb> rods;
  std::vector<ProxyId> ids;
  for (ProxyId id = 0; id < 20000; ++id) {
    Eigen::Vector3d size(0.1, 0.1, 0.1);
    size[random.below(3)] = 10.0;
    rods.push_back(test::boxAround(test::randomVector(random, 0, 50), size));
    ids.push_back(id);
  }
  ASSERT_GT(CellPlanner(rods, ids.data(), ids.size(), 1.0, Layout::one_region).plan(Rows::any).levels, 3u);
  HGrid undisturbed;
  const std::size_t count = test::allocationsOf([&] { undisturbed.update(ids, rods); });
  const std::vector<ProxyPair> expected = pairsOf(undisturbed);
  std::size_t survived = 0;
  for (std::size_t k = 1; k <= count; ++k) {
    SCOPED_TRACE("allocation " + std::to_string(k) + " of " + std::to_string(count));
    HGrid grid;
    if (test::failsAt(k, test::Failing::one, [&] { grid.update(ids, rods); })) {
      EXPECT_EQ(grid.size(), 0u);
      continue;
    }
    ++survived;
    ASSERT_NO_THROW(grid.checkInvariants());
    ASSERT_TRUE(pairsOf(grid) == expected);
  }
  EXPECT_GT(survived, 3u);
}

/// Claim: a cell plan has at most as many cells as the bound for which the grid reserves memory.
TEST(HGridFailedAllocation, APlanHasNoMoreCellsThanItsBoundSays) {
  for (int family = 0; family < test::kFamilies; ++family) {
    for (unsigned seed = 1; seed <= 300; ++seed) {
      const std::vector<Aabb> boxes = test::worldOf(test::Family(family), seed);
      std::vector<ProxyId> ids;
      for (ProxyId id = 0; id < boxes.size(); ++id) ids.push_back(id);
      const CellPlan plan = CellPlanner(boxes, ids.data(), ids.size(), 0.0625, Layout::one_region).plan(Rows::any);
      ASSERT_LE(plan.cells, CellPlan::mostCells(ids.size(), plan.levels))
          << test::name(test::Family(family)) << ", seed " << seed << ", " << ids.size() << " boxes";
    }
  }
}

}  // namespace
}  // namespace hgrid
