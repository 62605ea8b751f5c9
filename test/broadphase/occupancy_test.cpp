// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/broadphase/hgrid/occupancy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "hgrid_proximity/geometry/segment.h"
#include "hgrid_proximity/geometry/sphere.h"
#include "src/broadphase/hgrid/found_boxes.h"
#include "test/support/random.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace {

using test::Random;
using test::randomVector;

struct Place {
  double distance, size, level;  // [m] distance from the origin, size of the world, largest side of a level
};

/// Levels that fill a small part of a world, and their bounds as boxes.
struct Levels {
  Levels(Random& random, const Place& place) : levels(50) {
    offset = Eigen::Vector3d::Constant(place.distance);
    for (kernels::Level& level : levels) {
      bounds.push_back(
          test::boxAround(offset + randomVector(random, 0, place.size), randomVector(random, 0, place.level)));
      level.around = boxOf(bounds.back());
      level.end = 1;
    }
    occupancy.reserve();
    occupancy.set(levels);
  }
  template <class Test>
  bool any(const Test& test) const {
    return std::any_of(bounds.begin(), bounds.end(), test);
  }

  Eigen::Vector3d offset;
  std::vector<kernels::Level> levels;
  std::vector<Aabb> bounds;
  Occupancy occupancy;
};

/// Returns a random point in a world or beside it. If `aimed`, the point is in or near a level, and some coordinates
/// are exactly those of a corner of the level.
Eigen::Vector3d pointIn(const Levels& world, const Place& place, bool aimed, Random& random) {
  if (!aimed) return world.offset + randomVector(random, -0.1 * place.size, 1.1 * place.size);
  const Aabb& box = world.bounds[static_cast<std::size_t>(random.below(50))];
  const double beside = place.level + 0.02 * place.size;
  Eigen::Vector3d point = (0.5f * (box.min + box.max)).cast<double>() + randomVector(random, -beside, beside);
  for (int axis = 0; axis < 3; ++axis) {
    if (random.chance(0.2)) point[axis] = static_cast<double>(random.chance(0.5) ? box.min[axis] : box.max[axis]);
  }
  return point;
}

class OccupancyOf : public testing::TestWithParam<Place> {};

TEST_P(OccupancyOf, LevelsRejectsMostOfEmptySpaceAndNothingElse) {
  const Place place = GetParam();
  int rejected[3] = {}, empty[3] = {};
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Levels world(random, place);
    for (int i = 0; i < 500; ++i) {
      const bool aimed = i % 2 == 0;
      const auto judge = [&](int kind, bool touches, bool may) {
        ASSERT_TRUE(may || !touches) << "query of kind " << kind;
        empty[kind] += touches || aimed ? 0 : 1;
        rejected[kind] += may || aimed ? 0 : 1;
      };
      const Eigen::Vector3d point = pointIn(world, place, aimed, random);
      const kernels::Box box = boxOf(test::boxAround(point, randomVector(random, 0, 0.1 * place.size)));
      judge(0, world.any([&](const Aabb& bounds) { return overlap(boxOf(bounds), box); }),
            world.occupancy.mayOverlap(box));
      const Sphere sphere{point, random.uniform(0, 0.05 * place.size)};
      judge(1, world.any([&](const Aabb& bounds) { return touches(sphere, bounds); }),
            world.occupancy.mayBeNear(sphere.center.data(), touchingDistance(sphere)));
      const double length = random.logUniform(1e-4, 0.3) * place.size;
      Segment segment{point, point + randomVector(random, -length, length), 0.0};
      if (random.chance(0.3)) segment.radius = random.uniform(0, 0.01 * place.size);
      if (random.chance(0.1)) segment.to[random.below(3)] = segment.from[random.below(3)];
      const FirstTouch first_touch(segment);
      judge(2, world.any([&](const Aabb& bounds) { return first_touch(bounds).has_value(); }),
            world.occupancy.mayTouch(lineOf(segment)));
    }
  }
  for (int kind = 0; kind < 3; ++kind) EXPECT_GT(rejected[kind], empty[kind] / 2) << "queries of kind " << kind;
}

INSTANTIATE_TEST_SUITE_P(Worlds, OccupancyOf,
                         testing::Values(Place{0.0, 100.0, 1.0}, Place{0.0, 100.0, 8.0}, Place{-1e5, 1e4, 10.0},
                                         Place{1e6, 100.0, 2.0}, Place{0.0, 1e-3, 1e-5}, Place{-5e11, 1e12, 1e9}));

/// Returns three levels. The bounds of the first two make the coarse cells cubes with edges of 1 m; the caller sets the
/// bounds of the third.
std::vector<kernels::Level> levelsWithCellsOfOneMeter() {
  std::vector<kernels::Level> levels(3);
  levels[0].around = {{0.0f, 0.0f, 0.0f}, {0.01f, 0.01f, 0.01f}};
  levels[1].around = {{31.99f, 31.99f, 31.99f}, {32.0f, 32.0f, 32.0f}};
  for (kernels::Level& level : levels) level.end = 1;
  return levels;
}

/// Claim: a short line that passes the corner of a coarse cell is found in each of the eight cells around the corner.
TEST(Occupancy, FindsALevelAtTheCornerOfACoarseCell) {
  Random random(1);
  int touching = 0;
  for (int round = 0; round < 200; ++round) {
    const Eigen::Vector3d corner(random.below(32), random.below(32), random.below(32));
    std::vector<kernels::Level> levels = levelsWithCellsOfOneMeter();
    const Aabb bounds = test::boxAround(corner, {1e-4, 1e-4, 1e-4});
    levels[2].around = boxOf(bounds);
    for (int axis = 0; axis < 3; ++axis) {  // the level is in one of the eight cells
      if (random.chance(0.5))
        levels[2].around.min[axis] = static_cast<float>(corner[axis]);
      else
        levels[2].around.max[axis] = std::nextafter(static_cast<float>(corner[axis]), 0.0f);
    }
    Occupancy occupancy;
    occupancy.reserve();
    occupancy.set(levels);
    for (int i = 0; i < 100; ++i) {
      const Segment segment{corner + randomVector(random, -0.001, 0.001), corner + randomVector(random, -0.001, 0.001),
                            0.0};
      const Aabb level{Eigen::Map<const Eigen::Vector3f>(levels[2].around.min),
                       Eigen::Map<const Eigen::Vector3f>(levels[2].around.max)};
      if (!FirstTouch(segment)(level)) continue;
      ++touching;
      EXPECT_TRUE(occupancy.mayTouch(lineOf(segment)));
    }
  }
  EXPECT_GT(touching, 30);
}

/// Claim: the pieces of a long line leave no gaps.
TEST(Occupancy, FindsASmallLevelOnALongLine) {
  Random random(2);
  for (int round = 0; round < 300; ++round) {
    const Eigen::Vector3d place = randomVector(random, 1, 31);
    std::vector<kernels::Level> levels = levelsWithCellsOfOneMeter();
    levels[2].around = boxOf(test::boxAround(place, {1e-3, 1e-3, 1e-3}));
    Occupancy occupancy;
    occupancy.reserve();
    occupancy.set(levels);
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d direction = randomVector(random, -1, 1).normalized();
      const double before = random.uniform(0, 20), after = random.uniform(0, 20);
      EXPECT_TRUE(occupancy.mayTouch(lineOf({place - before * direction, place + after * direction, 0.0})));
    }
  }
}

TEST(Occupancy, OfLevelsThatFillSpaceRejectsNothing) {
  std::vector<kernels::Level> levels(2);
  levels[0].around = {{0.0f, 0.0f, 0.0f}, {10.0f, 10.0f, 10.0f}};
  levels[1].around = {{20.0f, 0.0f, 0.0f}, {21.0f, 10.0f, 10.0f}};
  for (kernels::Level& level : levels) level.end = 1;
  Occupancy occupancy;
  occupancy.reserve();
  occupancy.set({levels.front()});
  EXPECT_TRUE(occupancy.mayOverlap({{50.0f, 50.0f, 50.0f}, {51.0f, 51.0f, 51.0f}}));
  levels[0].around.max[0] = 1.0f;
  occupancy.set(levels);
  EXPECT_FALSE(occupancy.mayOverlap({{5.0f, 5.0f, 5.0f}, {6.0f, 6.0f, 6.0f}}));
  occupancy.clear();
  EXPECT_TRUE(occupancy.mayOverlap({{5.0f, 5.0f, 5.0f}, {6.0f, 6.0f, 6.0f}}));
}

TEST(Occupancy, AcceptsLinesThatAreLongerThanItCanFollow) {
  std::vector<kernels::Level> levels(2);
  levels[0].around = {{0.0f, 0.0f, 0.0f}, {1.0f, 1.0f, 1.0f}};
  levels[1].around = {{99.0f, 99.0f, 99.0f}, {100.0f, 100.0f, 100.0f}};
  for (kernels::Level& level : levels) level.end = 1;
  Occupancy occupancy;
  occupancy.reserve();
  occupancy.set(levels);
  for (const double far : {1e3, 1e9, 1e300}) {
    EXPECT_TRUE(occupancy.mayTouch(lineOf({{-far, 0.5, 0.5}, {far, 0.5, 0.5}, 0.0}))) << far;
  }
  EXPECT_TRUE(occupancy.mayTouch(lineOf({{50.0, 0.0, 0.0}, {50.0, 1.0, 0.0}, 60.0})));
}

}  // namespace
}  // namespace hgrid
