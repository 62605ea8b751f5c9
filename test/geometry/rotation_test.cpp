// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "geometry/rotation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/arc_tangent.h"
#include "test/support/shapes.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace test {
namespace {

constexpr double kFewUnits = 1e-15;

TEST(Rotation, AlongAnyDirectionIsARotationAlsoNearThePoles) {
  Random random(3);
  for (int i = 0; i < 20000; ++i) {
    Eigen::Vector3d direction = Eigen::Vector3d::Unit(random.below(3)) * (random.chance(0.5) ? 1.0 : -1.0);
    direction += random.logUniform(1e-17, 1.0) * randomVector(random, -1.0, 1.0);
    direction *= random.logUniform(1e-9, 1e9);
    const Eigen::Matrix3d rotation = rotationAlong(direction);
    ASSERT_LE((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), kFewUnits);
    ASSERT_GT(rotation.determinant(), 0.0);
    ASSERT_LE((rotation.col(2) - direction.normalized()).norm(), kFewUnits);
  }
}

TEST(Rotation, ByRollPitchAndYawTurnsAboutFixedAxes) {
  Random random(4);
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d angles = randomVector(random, -7.0, 7.0);
    const Eigen::Matrix3d expected = (Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitX()))
                                         .toRotationMatrix();
    ASSERT_LE((rotationOf(angles).toRotationMatrix() - expected).norm(), 8 * kFewUnits);
  }
}

TEST(Rotation, BetweenTwoQuaternionsTurnsAtConstantSpeedOnTheShorterWay) {
  Random random(5);
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Quaterniond from(randomPose(random, 1.0).linear());
    const double angle = random.logUniform(1e-12, 3.1), fraction = random.uniform(0.0, 1.0);
    const Eigen::Vector3d axis = randomVector(random, -1.0, 1.0).normalized();
    Eigen::Quaterniond to = from * Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
    if (random.chance(0.5)) to.coeffs() = -to.coeffs();
    const Eigen::Quaterniond expected = from * Eigen::Quaterniond(Eigen::AngleAxisd(fraction * angle, axis));
    ASSERT_LE(between(from, to, fraction).angularDistance(expected), 1e-14) << angle;
  }
}

TEST(ArcTangent, IsRightToAFewUnits) {
  Random random(6);
  for (int i = 0; i < 100000; ++i) {
    const double y = random.logUniform(1e-20, 1e20) * (random.chance(0.5) ? 1 : -1),
                 x = random.chance(0.05) ? 0.0 : random.logUniform(1e-20, 1e20) * (random.chance(0.5) ? 1 : -1);
    const double expected = std::atan2(y, x);
    ASSERT_NEAR(arcTangent(y, x), expected, kFewUnits * std::abs(expected)) << y << " " << x;
  }
  EXPECT_EQ(arcTangent(0.0, 1.0), 0.0);
  EXPECT_EQ(arcTangent(0.0, -1.0), M_PI);
  EXPECT_EQ(arcTangent(0.0, 0.0), 0.0);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
