// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/broadphase/hgrid/layer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hgrid_proximity/broadphase/isa.h"
#include "test/support/expectations.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace {

TEST(Layer, WithOneRowIsPlannedAgainSoonAfterItsBoxesHaveComeTogether) {
  for (const int threads : {1, 2}) {
    const std::size_t count = 20000;
    test::Random random(1);
    std::vector<Aabb> boxes = test::diagonalOfBoxes(count);
    Workers workers(threads);
    SortScratch scratch;
    const Machine machine{&kernels::of(bestIsa()), &workers, &scratch};
    Layer layer;
    layer.reserve(count, count, machine);
    layer.setIds(test::allIds(count));
    layer.sort(boxes, 1.0, machine);
    EXPECT_TRUE(layer.isOneRow());
    for (int i = 0; i < 20; ++i) layer.sort(boxes, 1.0, machine);
    EXPECT_TRUE(layer.isOneRow());
    // The first and the last box stay where they are, so the bounds do not change.
    for (std::size_t i = 1; i + 1 < count; ++i) {
      boxes[i] = test::boxAround(test::randomVector(random, 4000, 4030), {1, 1, 1});
    }
    for (int i = 0; i < 8; ++i) layer.sort(boxes, 1.0, machine);
    EXPECT_FALSE(layer.isOneRow());
    layer.checkInvariants(boxes);
  }
}

/// Claim: 16 boxes share one cell, whatever their sizes and places. More boxes get a plan, and fewer share a cell
/// again.
TEST(Layer, AFewBoxesShareOneCell) {
  for (const double longest : {0.0, 3.0}) {
    test::Random random(2);
    std::vector<Aabb> boxes;
    for (int i = 0; i < 40; ++i) {
      const Eigen::Vector3d sides = random.uniform(0.0, longest) * test::randomVector(random, 0.1, 1);
      boxes.push_back(test::boxAround(test::randomVector(random, -50, 50), sides));
    }
    Workers workers(1);
    SortScratch scratch;
    const Machine machine{&kernels::of(bestIsa()), &workers, &scratch};
    Layer layer;
    for (const std::size_t count : {1, 16, 17, 40, 16, 2, 0, 3, 17, 12, 18}) {
      SCOPED_TRACE(std::to_string(count) + " boxes, up to " + std::to_string(longest) + " m");
      layer.reserve(count, boxes.size(), machine);
      layer.setIds(test::allIds(count));
      layer.sort(boxes, 1.0, machine);
      layer.checkInvariants(boxes);
      std::int32_t cells = 0;
      for (const kernels::Level& level : layer.levels()) cells += level.grid.rows * level.grid.row;
      EXPECT_EQ(cells > 1, count > 16);
      EXPECT_TRUE(count == 0 || count > 16 || layer.isOneRow()) << "nearest() has no first radius";
      for (Aabb& box : boxes) {
        const Eigen::Vector3f way = test::randomVector(random, -1, 1).cast<float>();
        box = {box.min + way, box.max + way};
      }
    }
  }
}

/// Claim: a withdrawn box returns to its position exactly if it is in the same cell and within the computed bounds.
TEST(Layer, AWithdrawnBoxReturnsToItsCell) {
  constexpr std::uint32_t kCount = 1000;
  test::Random random(3);
  std::vector<Aabb> boxes;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    boxes.push_back(test::boxAround(test::randomVector(random, -20, 20), test::randomVector(random, 0.5, 1)));
  }
  Workers workers(1);
  SortScratch scratch;
  const Machine machine{&kernels::of(bestIsa()), &workers, &scratch};
  Layer layer;
  layer.reserve(kCount, kCount, machine);
  layer.setIds(test::allIds(kCount));
  layer.sort(boxes, 1.0, machine);
  std::size_t returned = 0, stayed_away = 0, rounded_down = 0;
  for (std::uint32_t position = 0; position < kCount; ++position) {
    Aabb& box = boxes[layer.idAt(position)];
    EXPECT_FALSE(layer.putBack(position, box)) << "the box is not withdrawn";
    layer.withdraw(position);
    EXPECT_FALSE(layer.putBack(position, {box.min, box.max + Eigen::Vector3f(2, 0, 0)})) << "the box is too long";
    const Eigen::Vector3f far(100, 100, 100);
    EXPECT_FALSE(layer.putBack(position, {box.min + far, box.max + far})) << "the box is outside the bounds";
    for (const kernels::Level& level : layer.levels()) {
      Aabb longer = box;
      longer.max.x() = std::nextafter(box.min.x() + level.reach[0], 100.0f);
      if (longer.max.x() - longer.min.x() > level.reach[0]) continue;
      if (double(longer.max.x()) - double(longer.min.x()) <= double(level.reach[0])) continue;
      ++rounded_down;
      if (position >= level.begin && position < level.end) {
        EXPECT_FALSE(layer.putBack(position, longer)) << "the box is longer than the reach, but not its rounded side";
      }
    }
    EXPECT_TRUE(layer.isWithdrawn(position));
    const Eigen::Vector3f way = test::randomVector(random, -0.5, 0.5).cast<float>();
    const Aabb next{box.min + way, box.max + way};
    if (layer.putBack(position, next)) {
      ++returned;
      box = next;
    } else {
      ++stayed_away;
      EXPECT_TRUE(layer.putBack(position, box)) << "the box did not move";
    }
  }
  EXPECT_GT(rounded_down, 10u);
  EXPECT_GT(returned, 100u);
  EXPECT_GT(stayed_away, 100u);
  layer.checkInvariants(boxes);
}

}  // namespace
}  // namespace hgrid
