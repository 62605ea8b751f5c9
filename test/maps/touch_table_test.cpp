// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares TouchTable with a scan of all voxels in extended precision, for many kinds of maps.
#include "hgrid_proximity/maps/touch_table.h"

#include <gtest/gtest.h>

#include <limits>

#include "test/maps/random_maps.h"

namespace hgrid {
namespace test {
namespace {

class TouchTableOracle : public ::testing::TestWithParam<std::size_t> {
 protected:
  const Map map_ = maps()[GetParam()];
  const TouchTable table_{StaticGrid(map_.edge, map_.voxels)};
  Random random_{GetParam() + 7};
};

INSTANTIATE_TEST_SUITE_P(Maps, TouchTableOracle, ::testing::Range<std::size_t>(0, maps().size()),
                         [](const auto& info) { return testName(maps()[info.param]); });

TEST_P(TouchTableOracle, SaysWhichSpheresTouch) {
  const int count = std::max(1000, countFromEnvironment("HGRID_TEST_WORLDS", 10000) / 2);
  std::vector<Sphere> spheres;
  for (int i = 0; i < count; ++i) {
    const double radius = random_.chance(0.7) ? map_.edge * random_.uniform(0.0, 12.0) : length(map_, random_);
    spheres.push_back({somewhere(map_, random_), radius});
  }
  std::vector<std::uint8_t> touched(3, 7);
  table_.touches(spheres, touched);
  ASSERT_EQ(touched.size(), spheres.size());
  int touching = 0, free = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Eigen::AlignedBox3d at(spheres[i].center);
    const double rounding = slack(at, spheres[i].radius);
    Real nearest = std::numeric_limits<Real>::infinity();
    for (const Voxel& voxel : map_.voxels) nearest = std::min(nearest, distanceOf(map_, voxel, at));
    if (nearest <= spheres[i].radius) {
      ASSERT_EQ(touched[i], 1) << "sphere " << i << " surely touches a voxel";
    }
    if (nearest > spheres[i].radius + rounding) {
      ASSERT_EQ(touched[i], 0) << "sphere " << i << " surely touches none";
    }
    ASSERT_EQ(table_.touches(spheres[i]), touched[i] == 1) << "sphere " << i;
    ASSERT_EQ(table_.grid().touches(spheres[i]), touched[i] == 1) << "sphere " << i;
    (touched[i] == 1 ? touching : free) += 1;
  }
  // No sphere touches an empty map, and nearly all touch a full one.
  if (map_.voxels.empty() || map_.voxels.front().level == Voxel::kLevels) return;
  EXPECT_GT(touching, count / 50);
  EXPECT_GT(free, count / 50);
}

TEST(TouchTable, HasATableUnlessTheBoxAroundTheVoxelsIsTooLarge) {
  std::size_t without = 0;
  for (const Map& map : maps()) {
    const TouchTable table(StaticGrid(map.edge, map.voxels));
    Eigen::AlignedBox3d box;
    for (const Voxel& voxel : map.voxels) {
      box.extend(minCorner(voxel, map.edge));
      box.extend(maxCorner(voxel, map.edge));
    }
    const double bricks = map.voxels.empty() ? 0.0 : (box.sizes() / (4.0 * map.edge)).prod();
    EXPECT_TRUE(table.hasTable() || bricks == 0.0 || bricks > 1e7) << map.name;
    EXPECT_FALSE(table.hasTable() && bricks > 3e7) << map.name;
    without += table.hasTable() ? 0 : 1;
  }
  EXPECT_GE(without, 3u);
}

// Far from the origin of the map, an array has a corner that is less exact than the questions.
TEST(TouchTable, RoundsAsTheMapDoes) {
  const TouchTable near(StaticGrid(0.1, {{32767, 32768, 32768, 0}}));
  EXPECT_TRUE(near.touches({{0, 0, 0}, 0}));
  const TouchTable far(StaticGrid(1.0, {{0, 32768, 32768, 0}, {32768, 32768, 32768, 0}}));
  ASSERT_TRUE(near.hasTable() && far.hasTable());
  Random random(3);
  for (int i = 0; i < 10000; ++i) {
    const double radius = i == 0 ? 0.2 : random.uniform(0, 0.5);
    const Sphere sphere{{-radius, 0.1, 0.1}, radius};
    ASSERT_EQ(far.touches(sphere), far.grid().touches(sphere)) << radius;
  }
}

TEST(TouchTable, AnswersSpheresThatAreNotFiniteAsTheMapDoes) {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::nan("");
  const TouchTable table(StaticGrid(0.1, {{32768, 32768, 32768, 0}, {32770, 32768, 32768, 0}}));
  ASSERT_TRUE(table.hasTable());
  for (const Sphere& sphere : {Sphere{{nan, 0, 0}, 1}, Sphere{{0, infinity, 0}, 1}, Sphere{{0, 0, 0}, infinity},
                               Sphere{{0, 0, 0}, nan}, Sphere{{1e300, 0, 0}, 1}}) {
    EXPECT_EQ(table.touches(sphere), table.grid().touches(sphere));
  }
  EXPECT_TRUE(table.touches({{0, 0, 0}, infinity}));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
