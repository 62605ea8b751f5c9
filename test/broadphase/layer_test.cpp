// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/broadphase/hgrid/layer.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace hgrid
