// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include "test/broadphase/broad_phase_suite.h"

namespace hgrid {
namespace {

using test::BruteForce;
using test::Random;

constexpr int kIds = 300;

Aabb someBox(Random& random) {
  if (random.chance(0.2)) return test::latticeBox(random, 0.5f);
  const double size = random.chance(0.1) ? random.logUniform(1e-4, 1e4) : random.uniform(0.05, 1.0);
  return test::boxAround(test::randomVector(random, -4, 4), size * test::randomVector(random, 0.1, 1.0));
}

/// Moves a random selection of the boxes with one call.
void moveSome(BroadPhase& tested, BruteForce& model, Random& random) {
  std::vector<ProxyId> ids;
  std::vector<Aabb> boxes;
  const double share = random.uniform(0, 0.5);
  for (const auto& stored : model.boxes()) {
    if (!random.chance(share)) continue;
    ids.push_back(stored.first);
    boxes.push_back(someBox(random));
  }
  tested.move(ids, boxes);
  model.move(ids, boxes);
}

/// Updates all boxes with one call: most boxes stay or move, some are added or removed.
void replaceAll(BroadPhase& tested, BruteForce& model, Random& random) {
  std::vector<ProxyId> ids;
  std::vector<Aabb> boxes;
  for (ProxyId id = 0; id < kIds; ++id) {
    const auto known = model.boxes().find(id);
    const bool is_new = known == model.boxes().end();
    if (!random.chance(is_new ? 0.1 : 0.9)) continue;
    ids.push_back(id);
    boxes.push_back(is_new || random.chance(0.5) ? someBox(random) : known->second);
  }
  tested.update(ids, boxes);
  model.update(ids, boxes);
}

/// Returns the box after a change of its position or size. `kind` (0 .. 999) selects the kind of change.
Aabb changed(Aabb box, int kind, Random& random) {
  if (kind < 400) {  // a small move, often within the same cell
    const Eigen::Vector3f by = test::randomVector(random, -0.05, 0.05).cast<float>();
    for (int k = 0; k < 3; ++k) box.min[k] += by[k], box.max[k] = std::max(box.min[k], box.max[k] + by[k]);
  } else if (kind < 500) {  // a change of one coordinate by one unit in the last place
    box.max[random.below(3)] = test::stepped(box.max[random.below(3)], 1);
    box.max = box.max.cwiseMax(box.min);
  } else if (kind < 700) {  // another size, often on another level
    const auto factor = float(random.logUniform(0.01, 100));
    box.max = box.min + factor * (box.max - box.min);
  } else if (kind < 800) {  // no change: the caller updates the box with the values it has
    box.min = box.min.cwiseMin(box.max);
  } else {
    box = someBox(random);
  }
  return box;
}

/// Makes one random change of the tested broad phase and of the model.
void step(BroadPhase& tested, BruteForce& model, Random& random) {
  const auto id = ProxyId(random.below(kIds));
  const auto known = model.boxes().find(id);
  const int kind = random.below(1000);
  if (kind < 2) {
    tested.clear();
    model.clear();
  } else if (kind < 10) {
    random.chance(0.5) ? moveSome(tested, model, random) : replaceAll(tested, model, random);
  } else if (known == model.boxes().end()) {
    const Aabb box = someBox(random);
    tested.insert(id, box);
    model.insert(id, box);
  } else if (kind < 200) {
    tested.remove(id);
    model.remove(id);
  } else {
    const Aabb box = changed(known->second, kind, random);
    tested.update(id, box);
    model.update(id, box);
  }
}

template <class Tested>
class BroadPhaseOperations : public ::testing::Test {};
TYPED_TEST_SUITE(BroadPhaseOperations, test::AllBroadPhases, test::BroadPhaseNames);

TYPED_TEST(BroadPhaseOperations, AgreeWithBruteForceThrough100000Operations) {
  for (const double edge : test::Maker<TypeParam>::cells({0.0625, 0x1p-30, 1024.0})) {
    SCOPED_TRACE("finest edge " + std::to_string(edge));
    Random random(unsigned(1e3 / edge));
    const std::unique_ptr<BroadPhase> tested = test::Maker<TypeParam>::withCells(edge);
    BruteForce model;
    const int operations = test::operationsToTest(edge == 0.0625 ? 100000 : 20000);
    for (int i = 1; i <= operations; ++i) {
      SCOPED_TRACE("operation " + std::to_string(i));
      step(*tested, model, random);
      ASSERT_EQ(tested->size(), model.size());
      if (i % 20 == 0) {
        const Aabb query = someBox(random);
        ASSERT_EQ(test::foundBy(*tested, query), test::foundBy(model, query));
      }
      if (i % 100 == 0) {
        ASSERT_EQ(test::pairsOf(*tested), test::pairsOf(model));
      }
      if (i % 1000 != 0) continue;
      ASSERT_NO_THROW(tested->checkInvariants());
      const std::unique_ptr<BroadPhase> rebuilt = test::Maker<TypeParam>::withCells(edge);
      for (const auto& stored : model.boxes()) rebuilt->insert(stored.first, stored.second);
      ASSERT_EQ(test::pairsOf(*tested), test::pairsOf(*rebuilt));
      ASSERT_EQ(test::levelCounts(*tested), test::levelCounts(*rebuilt));
    }
  }
}

TYPED_TEST(BroadPhaseOperations, AMovedBoxIsFoundWhereItIsAndNotWhereItWas) {
  TypeParam tested;
  const Aabb here = {{0, 0, 0}, {1, 1, 1}}, there = {{50, 50, 50}, {51, 51, 51}};
  tested.insert(3, here);
  tested.update(3, there);
  EXPECT_TRUE(test::foundBy(tested, here).empty());
  EXPECT_EQ(test::foundBy(tested, there), std::vector<ProxyId>({3}));
  const Aabb nudged = {{50, 50, 50}, {51, 51, test::stepped(51.f, 1)}};
  const Aabb beyond = {{50, 50, nudged.max.z()}, {51, 51, 60}};
  EXPECT_TRUE(test::foundBy(tested, beyond).empty());
  tested.update(3, nudged);
  EXPECT_EQ(test::foundBy(tested, beyond), std::vector<ProxyId>({3})) << "even the smallest move must count";
}

TYPED_TEST(BroadPhaseOperations, ManyBoxesInOneCellComeAndGo) {
  TypeParam tested;
  Random random(5);
  std::vector<ProxyId> inside;
  for (ProxyId id = 0; id < 200; ++id) tested.insert(id, {{0.01f, 0.01f, 0.01f}, {0.02f, 0.02f, 0.02f}});
  for (ProxyId id = 0; id < 200; ++id) {
    if (random.chance(0.5)) {
      tested.remove(id);
    } else {
      inside.push_back(id);
    }
    tested.checkInvariants();
  }
  EXPECT_EQ(test::foundBy(tested, Aabb{{0, 0, 0}, {1, 1, 1}}), inside);
  EXPECT_EQ(test::pairsOf(tested).size(), inside.size() * (inside.size() - 1) / 2);
}

}  // namespace
}  // namespace hgrid
