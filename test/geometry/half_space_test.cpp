// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/geometry/half_space.h"

#include <gtest/gtest.h>

#include "hgrid_proximity/geometry/shape.h"
#include "test/support/plane_oracle.h"
#include "test/support/shapes.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace {

using test::Exact;
using test::Random;

TEST(HalfSpace, DistanceOfABoxIsNeverTooLargeAndHardlyTooSmall) {
  for (unsigned seed = 1; seed <= 5000; ++seed) {
    Random random(seed);
    const double far = random.chance(0.3) ? 1e6 : random.logUniform(0.1, 100.0);
    const Pose plane = test::randomPose(random, far);
    const Eigen::Vector3d origin = random.chance(0.5) ? Eigen::Vector3d::Zero() : test::randomVector(random, -far, far);
    const double padding = random.chance(0.5) ? 0.0 : random.uniform(0.0, 2.0);
    const Eigen::Vector3d center = plane.translation() - origin + test::randomVector(random, -3.0, 3.0);
    const Aabb box = test::boxAround(center, test::randomVector(random, 0.0, 2.0));
    const double gap = distance(halfSpaceOf(plane, padding, origin), box);
    Exact height = test::exactHeight(box, plane, padding, origin);
    if (height.sign() < 0) height = Exact(0.0);
    ASSERT_GE(gap, 0.0);
    ASSERT_TRUE(Exact(gap) <= height) << "seed " << seed << ": the gap is " << gap;
    const double rounding = test::planeRounding(box, plane, padding, origin);
    ASSERT_TRUE(height <= Exact(gap) + Exact(rounding)) << "seed " << seed << ": the gap is " << gap;
  }
}

TEST(HalfSpace, ContainsWhatIsBelowItsSurfaceAndNotWhatIsAbove) {
  Pose plane = Pose::Identity();
  plane.translation() << 5.0, -7.0, 2.0;
  const HalfSpace floor = halfSpaceOf(plane, 0.5, Eigen::Vector3d(0, 0, 1));
  EXPECT_DOUBLE_EQ(signedDistance(floor, {0, 0, 1.5}), 0.0);
  EXPECT_DOUBLE_EQ(signedDistance(floor, {100, 0, 3.5}), 2.0);
  EXPECT_DOUBLE_EQ(signedDistance(floor, {0, -100, 0.5}), -1.0);
  plane.linear() = Eigen::AngleAxisd(std::acos(-1.0), Eigen::Vector3d::UnitX()).toRotationMatrix();  // a ceiling
  const HalfSpace ceiling = halfSpaceOf(plane, 0.5, Eigen::Vector3d(0, 0, 1));
  EXPECT_NEAR(signedDistance(ceiling, {0, 0, 0.0}), 0.5, 1e-14);
  EXPECT_NEAR(signedDistance(ceiling, {0, 0, 1.0}), -0.5, 1e-14);
}

TEST(HalfSpace, TouchingBoxHasTheDistanceZero) {
  const HalfSpace floor = halfSpaceOf(Pose::Identity(), 0.0, Eigen::Vector3d::Zero());
  EXPECT_EQ(distance(floor, {{-1, -1, 0}, {1, 1, 1}}), 0.0);
  EXPECT_EQ(distance(floor, {{-1, -1, -2}, {1, 1, -1}}), 0.0);
  EXPECT_GT(distance(floor, {{-1, -1, 1e-6f}, {1, 1, 1}}), 0.0);
}

TEST(HalfSpace, DeepestCornerIsTheNearestOfAllCorners) {
  for (unsigned seed = 1; seed <= 1000; ++seed) {
    Random random(seed);
    const HalfSpace half_space = halfSpaceOf(test::randomPose(random, 3.0), 0.1, Eigen::Vector3d::Zero());
    const Eigen::AlignedBox3d box =
        inDouble(test::boxAround(test::randomVector(random, -3, 3), test::randomVector(random, 0, 2)));
    const double deepest = signedDistance(half_space, deepestCorner(half_space, box));
    for (int corner = 0; corner < 8; ++corner) {
      const auto type = static_cast<Eigen::AlignedBox3d::CornerType>(corner);
      ASSERT_LE(deepest, signedDistance(half_space, box.corner(type))) << "seed " << seed;
    }
  }
}

TEST(HalfSpace, PlaneHasTheLargestBoxAndAnInfiniteReach) {
  const Shape plane = Shape::plane();
  EXPECT_EQ(plane.kind(), ShapeKind::plane);
  EXPECT_STREQ(name(plane.kind()), "plane");
  EXPECT_TRUE(plane.dimensions().empty());
  EXPECT_EQ(plane.reach(), std::numeric_limits<double>::infinity());
  const Aabb box = boxOf(plane, Pose::Identity(), 0.1, Eigen::Vector3d::Zero());
  EXPECT_TRUE(isValid(box));
  EXPECT_EQ(box.min, Eigen::Vector3f::Constant(-std::numeric_limits<float>::max()));
  EXPECT_EQ(box.max, Eigen::Vector3f::Constant(std::numeric_limits<float>::max()));
}

}  // namespace
}  // namespace hgrid
