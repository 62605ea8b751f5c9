// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares DistanceBlocks with a scan of all voxels, for many kinds of maps.
#include "maps/distance_blocks.h"

#include <gtest/gtest.h>

#include <limits>
#include <thread>

#include "test/maps/random_maps.h"

namespace hgrid {
namespace test {
namespace {

constexpr double kHalfDiagonal = 0.8661;  // of a cell, in finest edges

/// Four points, relative to the corner of the blocks and in finest edges.
struct FourPoints {
  FourPoints(const DistanceBlocks& blocks, const std::array<Eigen::Vector3d, 4>& points) {
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const Eigen::Vector3d at = (points[lane] - blocks.corner()) / blocks.edge();
      for (Eigen::Index axis = 0; axis < 3; ++axis) values[axis][lane] = static_cast<float>(at[axis]);
    }
  }
  Four values[3];
};

/// Returns the distance of a point of FourPoints from the nearest voxel, in finest edges.
double nearestTo(const Map& map, const DistanceBlocks& blocks, const FourPoints& points, std::size_t lane) {
  Eigen::Vector3d at;
  for (Eigen::Index axis = 0; axis < 3; ++axis) at[axis] = points.values[axis][lane];
  const Eigen::AlignedBox3d point(Eigen::Vector3d(blocks.corner() + at * blocks.edge()));
  Real nearest = std::numeric_limits<Real>::infinity();
  for (const Voxel& voxel : map.voxels) nearest = std::min(nearest, distanceOf(map, voxel, point));
  return static_cast<double>(nearest) / map.edge;
}

class DistanceBlocksOracle : public ::testing::TestWithParam<std::size_t> {
 protected:
  const Map map_ = maps()[GetParam()];
  const DistanceBlocks blocks_{StaticGrid(map_.edge, map_.voxels)};
  Random random_{GetParam() + 11};
};

INSTANTIATE_TEST_SUITE_P(Maps, DistanceBlocksOracle, ::testing::Range<std::size_t>(0, maps().size()),
                         [](const auto& info) { return testName(maps()[info.param]); });

TEST_P(DistanceBlocksOracle, BoundsAreNeverTooLargeAndAtMostADiagonalTooSmall) {
  const int count = std::max(250, countFromEnvironment("HGRID_TEST_WORLDS", 10000) / 8);
  int known = 0;
  for (int i = 0; i < count; ++i) {
    std::array<Eigen::Vector3d, 4> at;
    for (Eigen::Vector3d& point : at) point = somewhere(map_, random_);
    const FourPoints points(blocks_, at);
    const Four bounds = blocks_.lowerBounds(points.values);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const double nearest = nearestTo(map_, blocks_, points, lane);
      ASSERT_LE(bounds[lane], nearest) << "point " << at[lane].transpose();
      if (!blocks_.isKnown()) continue;
      ++known;
      // A point that is more than 6 edges from all voxels may be outside of the blocks. Bounds are less tight there.
      const double least = std::min(nearest, 6.0) - 2.0 * kHalfDiagonal;
      ASSERT_GE(bounds[lane], least - 1e-4) << "point " << at[lane].transpose();
    }
  }
  EXPECT_EQ(known > 0, blocks_.isKnown());
}

// The first voxel fixes the borders of the blocks. The second voxel moves along a diagonal over three blocks.
TEST(DistanceBlocks, BoundsNearAVoxelAreNeverTooLarge) {
  Random random(9);
  int near = 0;
  for (std::uint16_t step = 0; step < 24; ++step) {
    const auto key = static_cast<std::uint16_t>(32768 + 40 + step);
    const Map map{"two", 0.05, {{32768, 32768, 32768, 0}, {key, key, key, 0}}};
    const DistanceBlocks blocks{StaticGrid(map.edge, map.voxels)};
    const Eigen::Vector3d center = Eigen::Vector3d::Constant((40.5 + step) * map.edge);
    for (int i = 0; i < 300; ++i) {
      std::array<Eigen::Vector3d, 4> at;
      for (Eigen::Vector3d& point : at) {
        point =
            center + map.edge * Eigen::Vector3d(random.uniform(-8, 8), random.uniform(-1, 1), random.uniform(-1, 1));
        std::swap(point[0], point[random.below(3)]);
      }
      const FourPoints points(blocks, at);
      const Four bounds = blocks.lowerBounds(points.values);
      for (std::size_t lane = 0; lane < 4; ++lane) {
        const double nearest = nearestTo(map, blocks, points, lane);
        ASSERT_LE(bounds[lane], nearest) << "step " << step << ", point " << at[lane].transpose();
        near += nearest > 4.5 && nearest < 6.0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(near, 1000);
}

TEST(DistanceBlocks, MapsWithTooManyBlocksAreNotKnown) {
  int known = 0, unknown = 0;
  for (const Map& map : maps()) {
    const DistanceBlocks blocks{StaticGrid(map.edge, map.voxels)};
    Eigen::AlignedBox3d box;
    for (const Voxel& voxel : map.voxels) {
      box.extend(minCorner(voxel, map.edge));
      box.extend(maxCorner(voxel, map.edge));
    }
    const double count = map.voxels.empty() ? 0.0 : (box.sizes() / (8.0 * map.edge)).prod();
    (blocks.isKnown() ? known : unknown) += 1;
    EXPECT_EQ(blocks.isKnown(), count < 1e6) << map.name;
  }
  EXPECT_GT(known, 5);
  EXPECT_GT(unknown, 2);
}

TEST(DistanceBlocks, MapsWithoutVoxelsAreFarFromEverything) {
  const DistanceBlocks blocks{StaticGrid(0.05, {})};
  const Four zero = allFour(0.0f), bounds = blocks.lowerBounds({zero, zero, zero});
  for (std::size_t lane = 0; lane < 4; ++lane) EXPECT_EQ(bounds[lane], DistanceBlocks::kFarthest);
}

TEST(DistanceBlocks, PointsWithNanHaveNoPositiveBound) {
  const DistanceBlocks blocks{StaticGrid(0.05, {{32768, 32768, 32768, 0}})};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Four four = allFour(nan), bounds = blocks.lowerBounds({four, four, four});
  for (std::size_t lane = 0; lane < 4; ++lane) EXPECT_FALSE(bounds[lane] > 0.0f);
}

// The map has more blocks than DistanceBlocks keeps.
TEST(DistanceBlocks, AfterTheLastBlockBoundsAreZero) {
  Map map{"line", 0.05, {}};
  for (std::uint32_t x = 0; x < 65536; x += 4) map.voxels.push_back({static_cast<std::uint16_t>(x), 32768, 32768, 0});
  const DistanceBlocks blocks{StaticGrid(map.edge, map.voxels)};
  ASSERT_TRUE(blocks.isKnown());
  std::size_t zero = 0, positive = 0;
  for (float x = 2.0f; x < 65546.0f; x += 8.0f) {
    for (float y = 2.0f; y < 20.0f; y += 4.0f) {
      const Four bounds = blocks.lowerBounds({allFour(x), Four{y, y, y, y}, Four{2.0f, 10.0f, 2.0f, 10.0f}});
      for (std::size_t lane = 0; lane < 2; ++lane) {
        const double gap = std::hypot(std::max({6.0 - y, y - 7.0, 0.0}), lane == 0 ? 4.0 : 3.0);
        ASSERT_LE(bounds[lane], std::hypot(gap, 3.0)) << "at " << x << ", " << y;
        (bounds[lane] > 0.0f ? positive : zero) += 1;
      }
    }
  }
  EXPECT_GT(positive, 0u);
  EXPECT_GT(zero, 0u);
}

TEST(DistanceBlocks, AllThreadsGetTheSameBounds) {
  Random random(5);
  const Map map{"divided", 0.05, [&] {
                  std::vector<Voxel> voxels;
                  divide({32768, 32768, 32768, 7}, random, 0.1, 0.4, 0, voxels);
                  return voxels;
                }()};
  const StaticGrid grid(map.edge, map.voxels);
  const DistanceBlocks shared(grid), alone(grid);
  std::vector<FourPoints> points;
  for (int i = 0; i < 2000; ++i) {
    std::array<Eigen::Vector3d, 4> at;
    for (Eigen::Vector3d& point : at) point = somewhere(map, random);
    points.emplace_back(shared, at);
  }
  std::vector<Four> expected;
  for (const FourPoints& point : points) expected.push_back(alone.lowerBounds(point.values));
  std::vector<int> different(4);
  std::vector<std::thread> threads;
  for (std::size_t number = 0; number < different.size(); ++number) {
    threads.emplace_back([&, number] {
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Four bounds = shared.lowerBounds(points[i].values);
        for (std::size_t lane = 0; lane < 4; ++lane) different[number] += bounds[lane] != expected[i][lane] ? 1 : 0;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(different, std::vector<int>(4));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
