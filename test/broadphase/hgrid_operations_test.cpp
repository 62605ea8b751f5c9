// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <map>

#include "test/support/grids.h"

namespace hgrid {
namespace {

using test::Random;

/// The simplest thing that could be right.
using Model = std::map<ProxyId, Aabb>;

Aabb someBox(Random& random) {
  if (random.chance(0.2)) return test::latticeBox(random, 0.5f);
  const double size = random.chance(0.1) ? random.logUniform(1e-4, 1e4) : random.uniform(0.05, 1.0);
  return test::boxAround(test::randomVector(random, -4, 4), size * test::randomVector(random, 0.1, 1.0));
}

test::Pairs pairsOf(const Model& model) {
  test::Pairs pairs;
  for (auto a = model.begin(); a != model.end(); ++a) {
    for (auto b = std::next(a); b != model.end(); ++b) {
      if (test::oracleOverlap(a->second, b->second)) pairs.emplace_back(a->first, b->first);
    }
  }
  return pairs;
}

std::vector<ProxyId> overlapsIn(const Model& model, const Aabb& box) {
  std::vector<ProxyId> found;
  for (const auto& entry : model) {
    if (test::oracleOverlap(entry.second, box)) found.push_back(entry.first);
  }
  return found;
}

/// One random operation on both.
void step(HGrid& grid, Model& model, Random& random) {
  const auto id = ProxyId(random.below(300));
  const bool stored = model.count(id) != 0;
  const int deed = random.below(1000);
  if (deed < 2) {
    grid.clear();
    model.clear();
  } else if (deed < 10 && random.chance(0.5)) {  // bulk move of a few, or of many
    std::vector<ProxyId> ids;
    std::vector<Aabb> boxes;
    const double share = random.uniform(0, 0.5);
    for (auto& entry : model) {
      if (!random.chance(share)) continue;
      entry.second = someBox(random);
      ids.push_back(entry.first);
      boxes.push_back(entry.second);
    }
    grid.move(ids, boxes);
  } else if (deed < 10) {  // bulk update: most stay or move, some come and go
    std::vector<ProxyId> ids;
    std::vector<Aabb> boxes;
    Model next;
    for (ProxyId other = 0; other < 300; ++other) {
      const auto known = model.find(other);
      if (!random.chance(known == model.end() ? 0.1 : 0.9)) continue;
      next[other] = known == model.end() || random.chance(0.5) ? someBox(random) : known->second;
      ids.push_back(other);
      boxes.push_back(next[other]);
    }
    grid.update(ids, boxes);
    model.swap(next);
  } else if (!stored) {
    model[id] = someBox(random);
    grid.insert(id, model[id]);
  } else if (deed < 200) {
    grid.remove(id);
    model.erase(id);
  } else {
    Aabb& box = model[id];
    if (deed < 400) {  // a small move, perhaps within the cell
      const Eigen::Vector3f way = test::randomVector(random, -0.05, 0.05).cast<float>();
      for (int k = 0; k < 3; ++k) box.min[k] += way[k], box.max[k] = std::max(box.min[k], box.max[k] + way[k]);
    } else if (deed < 500) {  // by one unit in the last place
      box.max[random.below(3)] = test::stepped(box.max[random.below(3)], 1);
      box.max = box.max.cwiseMax(box.min);
    } else if (deed < 700) {  // another size, perhaps another level
      const auto factor = float(random.logUniform(0.01, 100));
      box.max = box.min + factor * (box.max - box.min);
    } else if (deed < 800) {  // to nearly the same place: nothing may be skipped
      box.min = box.min.cwiseMin(box.max);
    } else {
      box = someBox(random);
    }
    grid.update(id, box);
  }
}

TEST(HGridOperations, AgreesWithASimpleModelThrough100000Operations) {
  for (const double finest_edge : {0.0625, 0x1p-30, 1024.0}) {
    SCOPED_TRACE("finest edge " + std::to_string(finest_edge));
    Random random(unsigned(1e3 / finest_edge));
    GridScale scale;
    scale.finest_edge = finest_edge;
    HGrid grid(scale);
    Model model;
    const int operations = finest_edge == 0.0625 ? 100000 : 20000;
    for (int i = 1; i <= operations; ++i) {
      SCOPED_TRACE("operation " + std::to_string(i));
      step(grid, model, random);
      ASSERT_EQ(grid.size(), model.size());
      if (i % 20 == 0) {
        const Aabb query = someBox(random);
        ASSERT_EQ(test::foundBy(grid, query), overlapsIn(model, query));
      }
      if (i % 100 == 0) {
        ASSERT_EQ(test::pairsOf(grid), pairsOf(model));
      }
      if (i % 1000 != 0) continue;
      ASSERT_NO_THROW(grid.checkInvariants());
      HGrid rebuilt(scale);
      for (const auto& entry : model) rebuilt.insert(entry.first, entry.second);
      ASSERT_EQ(test::pairsOf(grid), test::pairsOf(rebuilt));
      ASSERT_EQ(test::levelCounts(grid), test::levelCounts(rebuilt));
    }
  }
}

TEST(HGridOperations, AMovedBoxIsFoundWhereItIsAndNotWhereItWas) {
  HGrid grid;
  const Aabb here = {{0, 0, 0}, {1, 1, 1}}, there = {{50, 50, 50}, {51, 51, 51}};
  grid.insert(3, here);
  grid.update(3, there);
  EXPECT_TRUE(test::foundBy(grid, here).empty());
  EXPECT_EQ(test::foundBy(grid, there), std::vector<ProxyId>({3}));
  const Aabb nudged = {{50, 50, 50}, {51, 51, test::stepped(51.f, 1)}};
  const Aabb beyond = {{50, 50, nudged.max.z()}, {51, 51, 60}};
  EXPECT_TRUE(test::foundBy(grid, beyond).empty());
  grid.update(3, nudged);
  EXPECT_EQ(test::foundBy(grid, beyond), std::vector<ProxyId>({3})) << "the smallest move counts";
}

TEST(HGridOperations, ManyBoxesInOneCellComeAndGo) {
  HGrid grid;
  Random random(5);
  std::vector<ProxyId> inside;
  for (ProxyId id = 0; id < 200; ++id) grid.insert(id, {{0.01f, 0.01f, 0.01f}, {0.02f, 0.02f, 0.02f}});
  for (ProxyId id = 0; id < 200; ++id) {
    if (random.chance(0.5)) {
      grid.remove(id);
    } else {
      inside.push_back(id);
    }
    grid.checkInvariants();
  }
  EXPECT_EQ(test::foundBy(grid, Aabb{{0, 0, 0}, {1, 1, 1}}), inside);
  EXPECT_EQ(test::pairsOf(grid).size(), inside.size() * (inside.size() - 1) / 2);
}

}  // namespace
}  // namespace hgrid
