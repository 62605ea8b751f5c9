// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/broadphase/hgrid/bounds_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "hgrid_proximity/broadphase/isa.h"
#include "src/broadphase/hgrid/found_boxes.h"
#include "test/support/random.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace {

using test::Random;
using test::randomVector;

constexpr Isa kIsas[] = {Isa::portable, Isa::sse2, Isa::avx2, Isa::avx512, Isa::neon};

/// Returns levels that follow each other in space, like the levels of neighboring regions. One in five is empty.
std::vector<kernels::Level> levelsAlongAWalk(Random& random, std::size_t count) {
  std::vector<kernels::Level> levels(count);
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    place += randomVector(random, -5, 5);
    levels[i].around = boxOf(test::boxAround(place, randomVector(random, 0, 8)));
    if (i % 5 == 4) {
      constexpr float kInfinity = std::numeric_limits<float>::infinity();
      levels[i].around = {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    }
  }
  return levels;
}

class BoundsTreeSizes : public testing::TestWithParam<std::size_t> {};

TEST_P(BoundsTreeSizes, FindsTheLevelsThatOverlapABox) {
  Random random(static_cast<unsigned>(GetParam()) + 1);
  const std::vector<kernels::Level> levels = levelsAlongAWalk(random, GetParam());
  BoundsTree bounds;
  bounds.reserveLevels(levels.size());
  bounds.setLevels(levels);
  const kernels::LevelSet set = bounds.over(levels);
  std::size_t found = 0;
  for (int i = 0; i < 200; ++i) {
    const kernels::Box query = boxOf(test::boxAround(randomVector(random, -60, 60), randomVector(random, 0, 30)));
    const auto test = [&query](const kernels::Box& box) { return overlap(box, query); };
    std::vector<std::uint32_t> expected, visited;
    for (std::uint32_t number = 0; number < levels.size(); ++number) {
      if (test(levels[number].around)) expected.push_back(number);
    }
    found += expected.size();
    bounds.visit(test, [&visited](std::uint32_t number, const kernels::Box&) { visited.push_back(number); });
    ASSERT_EQ(visited, expected);
    for (const Isa isa : kIsas) {
      if (!isSupported(isa)) continue;
      std::vector<std::uint32_t> buffer;
      PositionWriter writer(buffer);
      kernels::of(isa).reaching(&set, &query, writer.sink());
      ASSERT_EQ(std::vector<std::uint32_t>(writer.begin(), writer.end()), expected) << name(isa);
    }
  }
  if (levels.size() >= 15) {
    EXPECT_GT(found, 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, BoundsTreeSizes, testing::Values(0, 1, 2, 15, 16, 17, 31, 255, 256, 257, 5000));

TEST(BoundsTree, EachLeafIsTheBoundsOfItsBoxes) {
  for (const std::uint32_t count : {1u, 31u, 32u, 33u, 511u, 512u, 513u, 20000u}) {
    SCOPED_TRACE(count);
    Random random(count);
    std::vector<float> bounds(6 * std::size_t{count});
    for (float& bound : bounds) bound = static_cast<float>(random.uniform(-9, 9));
    kernels::Level level{};
    level.bounds = bounds.data();
    level.stride = count;
    level.end = count;
    BoundsTree tree;
    tree.reserveBoxes(count);
    tree.setBoxes(level);
    std::uint32_t leaves = 0;
    tree.visit([](const kernels::Box&) { return true; },
               [&](std::uint32_t number, const kernels::Box& box) {
                 ASSERT_EQ(number, leaves++);
                 const auto begin = static_cast<std::ptrdiff_t>(number * BoundsTree::kPerLeaf);
                 const auto end = std::min<std::ptrdiff_t>(begin + BoundsTree::kPerLeaf, count);
                 for (std::ptrdiff_t axis = 0; axis < 3; ++axis) {
                   const auto min = bounds.begin() + axis * std::ptrdiff_t{count},
                              max = min + 3 * std::ptrdiff_t{count};
                   EXPECT_EQ(box.min[axis], *std::min_element(min + begin, min + end));
                   EXPECT_EQ(box.max[axis], *std::max_element(max + begin, max + end));
                 }
               });
    EXPECT_EQ(leaves, (count + BoundsTree::kPerLeaf - 1) / BoundsTree::kPerLeaf);
  }
}

TEST(BoundsTree, KeepsItsBoxesWhileMemoryIsReserved) {
  Random random(7);
  const std::vector<kernels::Level> levels = levelsAlongAWalk(random, 300);
  BoundsTree tree;
  tree.setLevels(levels);
  tree.reserveLevels(100000);
  std::size_t visited = 0;
  tree.visit([](const kernels::Box&) { return true; },
             [&](std::uint32_t number, const kernels::Box& box) {
               ++visited;
               for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(box.min[axis], levels[number].around.min[axis]);
             });
  EXPECT_EQ(visited, levels.size());
}

TEST(LevelSet, WithoutTiersEveryLevelIsVisited) {
  const std::vector<kernels::Level> levels(3);
  const kernels::LevelSet set = {levels.data(), 3, nullptr, 0, 0};
  const kernels::Box query{};
  for (const Isa isa : kIsas) {
    if (!isSupported(isa)) continue;
    std::vector<std::uint32_t> buffer;
    PositionWriter writer(buffer);
    kernels::of(isa).reaching(&set, &query, writer.sink());
    EXPECT_EQ(std::vector<std::uint32_t>(writer.begin(), writer.end()), (std::vector<std::uint32_t>{0, 1, 2}));
  }
}

}  // namespace
}  // namespace hgrid
