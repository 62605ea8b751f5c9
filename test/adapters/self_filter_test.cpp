// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests withoutSelf(), which removes the cells of the robot itself from a map. The reference checks all finest cells.
#include "hgrid_proximity/maps/self_filter.h"

#include <gtest/gtest.h>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "test/support/maps.h"
#include "test/support/solids.h"

namespace hgrid {
namespace test {
namespace {

constexpr double kCellEdge = 0.05;

/// Splits voxels into cells of the finest level, in Morton order.
std::vector<Voxel> finestOf(const std::vector<Voxel>& voxels) {
  std::vector<Voxel> all;
  for (const Voxel& voxel : voxels) {
    const std::uint64_t begin = mortonOf(voxel), count = std::uint64_t{1} << 3 * voxel.level;
    for (std::uint64_t i = 0; i < count; ++i) all.push_back(finestVoxelOf(begin + i));
  }
  return all;
}

SelfShape selfShape(NarrowPhase& narrow_phase, const Shape& shape, const Pose& world_from_shape, double padding) {
  return {shape, narrow_phase.solidOf(shape), world_from_shape, padding};
}

TEST(SelfFilter, LeavesOutExactlyTheFinestCellsWhoseMiddlesLieInAPaddedShape) {
  const auto narrow_phase = makeCoreNarrowPhase();
  std::size_t left_out = 0, kept = 0, split = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<Voxel> voxels = randomVoxels(random, 300, 12);
    if (random.chance(0.5)) voxels = {{32768, 32768, 32768, 4}};  // one voxel; its side is as long as 16 finest cells
    const Pose world_from_map = randomPose(random, 3.0);
    std::vector<SelfShape> shapes;
    for (int i = random.between(0, 3); i > 0; --i) {
      const Shape shape = shapeOf(randomSolid(random, ShapeKind(random.between(1, 7)), {0.15, 0.6, 3.0})).shape;
      const double padding = random.chance(0.3) ? 0.0 : random.uniform(0.0, 0.1);
      shapes.push_back(selfShape(*narrow_phase, shape, world_from_map * randomPose(random, 0.5), padding));
    }
    const OthersCells others = withoutSelf(voxels, kCellEdge, world_from_map, shapes, *narrow_phase);
    StaticGrid(kCellEdge, others.voxels);  // throws if the voxels are not disjoint or not in Morton order
    EXPECT_EQ(others.undecided, 0u);
    const std::vector<Voxel> left = finestOf(others.voxels), all = finestOf(voxels);
    EXPECT_EQ(left.size() + others.left_out, all.size());
    auto next = left.begin();
    for (const Voxel& cell : all) {
      const bool stays = next != left.end() && *next == cell;
      next += stays;
      const Pose middle =
          world_from_map * Eigen::Translation3d(0.5 * (minCorner(cell, kCellEdge) + maxCorner(cell, kCellEdge)));
      double room = 1.0;  // [m] distance of the cell's center from the nearest padded shape
      for (const SelfShape& shape : shapes) {
        const Proximity found = narrow_phase->measure({*narrow_phase->point(), middle, 0.0},
                                                      {*shape.solid, shape.world_from_shape, 0.0}, 1.0);
        if (found.status == Measure::containment_unknown) continue;
        room = std::min(room, found.distance - shape.padding);
      }
      if (std::abs(room) < 1e-9) continue;
      ASSERT_EQ(stays, room > 0.0) << room;
    }
    EXPECT_EQ(next, left.end());
    left_out += others.left_out;
    kept += left.size();
    split += others.voxels.size() > voxels.size();
  }
  EXPECT_GT(left_out, 1000u);
  EXPECT_GT(kept, 1000u);
  EXPECT_GT(split, 3u);
}

TEST(SelfFilter, ACellThatStaysWholeIsNotSplit) {
  const auto narrow_phase = makeCoreNarrowPhase();
  const std::vector<Voxel> voxels{{32768, 32768, 32768, 3}};  // covers 0 .. 0.4 m on each axis
  Pose beside = Pose::Identity();
  beside.translation() = Eigen::Vector3d(-0.2, 0.2, 0.2);
  // The sphere overlaps the voxel, but contains no center of a finest cell.
  const SelfShape ball = selfShape(*narrow_phase, Shape::sphere(0.21), beside, 0.0);
  EXPECT_EQ(withoutSelf(voxels, kCellEdge, Pose::Identity(), {ball}, *narrow_phase).voxels, voxels);
}

TEST(SelfFilter, WithoutShapesOrCellsNothingChanges) {
  const auto narrow_phase = makeCoreNarrowPhase();
  const std::vector<Voxel> voxels{{1, 2, 3, 0}};
  EXPECT_EQ(withoutSelf(voxels, kCellEdge, Pose::Identity(), {}, *narrow_phase).voxels, voxels);
  const SelfShape ball = selfShape(*narrow_phase, Shape::sphere(1.0), Pose::Identity(), 0.0);
  EXPECT_TRUE(withoutSelf({}, kCellEdge, Pose::Identity(), {ball}, *narrow_phase).voxels.empty());
}

}  // namespace
}  // namespace test
}  // namespace hgrid
