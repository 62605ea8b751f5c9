// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/geometry/sphere.h"

#include <gtest/gtest.h>

#include "test/support/oracle.h"
#include "test/support/random.h"

namespace hgrid {
namespace {

using test::Random;

TEST(Sphere, TouchesWhateverItExactlyTouchesAndHardlyMore) {
  int exact_hits = 0, misses = 0;
  for (unsigned seed = 1; seed <= 30000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const double size = random.logUniform(1e-3, 1e3), far = random.chance(0.5) ? 0.0 : random.logUniform(1.0, 1e8);
    Aabb box;
    Eigen::Vector3d center;
    for (int k = 0; k < 3; ++k) {
      const double base = random.uniform(-far, far);
      box.min[k] = float(base);
      box.max[k] = std::max(box.min[k], float(base + size * random.uniform(0, 1)));
      center[k] = base + size * random.uniform(-2, 2);
    }
    const double gap = std::sqrt(double(test::distanceAt(box, center, center, 0)));
    // Radii that are equal to the distance, slightly different from it, and clearly different from it.
    const double near = double(test::distanceAt(box, center, center, 0));
    const double slack = test::promisedSlack(center, center, near);
    for (const double radius :
         {near, test::stepped(near, 2), near + 2 * slack, near - 3 * slack, near * 0.5, gap, 0.0}) {
      if (radius < 0) continue;
      const bool exact = test::exactlyTouches(box, center, radius);
      const bool found = touches({center, radius}, box);
      exact_hits += exact, misses += !found;
      if (exact) {
        ASSERT_TRUE(found) << "radius " << radius;
      }
      if (found && !exact) {
        ASSERT_LE(near, radius + test::promisedSlack(center, center, radius));
      }
    }
  }
  EXPECT_GT(exact_hits, 10000);
  EXPECT_GT(misses, 10000);
}

TEST(Sphere, APointOnAFaceAnEdgeOrACornerTouches) {
  const Aabb box = {{-1, -2, -3}, {1, 2, 3}};
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        const Eigen::Vector3d point(x, 2 * y, 3 * z);
        EXPECT_TRUE(touches({point, 0.0}, box)) << point.transpose();
        EXPECT_EQ(distance(box, point), 0.0);
        EXPECT_EQ(nearestPoint(box, point), point);
        const Eigen::Vector3d outside = 1.5 * point;
        if (point.norm() > 0) {
          EXPECT_FALSE(touches({outside, 0.0}, box));
        }
        if (point.norm() > 0) {
          EXPECT_TRUE(touches({outside, 0.5 * point.norm()}, box));
        }
      }
    }
  }
}

TEST(Sphere, TheNearestPointLiesInTheBoxAndNoOtherIsNearer) {
  for (unsigned seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Aabb box;
    Eigen::Vector3d point;
    for (int k = 0; k < 3; ++k) {
      box.min[k] = float(random.uniform(-2, 1)), box.max[k] = box.min[k] + float(random.uniform(0, 2));
      point[k] = random.uniform(-4, 4);
    }
    const Eigen::Vector3d nearest = nearestPoint(box, point);
    ASSERT_NEAR((nearest - point).norm(), distance(box, point), 1e-15);
    for (int i = 0; i < 50; ++i) {
      Eigen::Vector3d other;
      for (int k = 0; k < 3; ++k) {
        ASSERT_TRUE(nearest[k] >= box.min[k] && nearest[k] <= box.max[k]);
        other[k] = random.uniform(box.min[k], box.max[k]);
      }
      ASSERT_LE(distance(box, point), (other - point).norm() + 1e-15);
    }
  }
}

}  // namespace
}  // namespace hgrid
