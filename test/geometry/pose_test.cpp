// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/geometry/pose.h"

#include <gtest/gtest.h>

#include <limits>

#include "test/support/random.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace {

using test::refusalOf;
using test::says;

const Eigen::Vector3d kHere(1, 2, 3);
const Eigen::Vector4d kUpright(0, 0, 0, 1);

TEST(CheckedPose, RefusesEachFieldThatIsNotFiniteByName) {
  const char* fields[] = {"position.x",    "position.y",    "position.z",   "orientation.x",
                          "orientation.y", "orientation.z", "orientation.w"};
  const double infinity = std::numeric_limits<double>::infinity();
  for (int field = 0; field < 7; ++field) {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity}) {
      Eigen::Vector3d position = kHere;
      Eigen::Vector4d xyzw = kUpright;
      (field < 3 ? position[field] : xyzw[field - 3]) = bad;
      std::string sentence;
      bool renormalized = false;
      EXPECT_EQ(refusalOf([&] { checkedPose(position, xyzw, "transform of 'tool0'", &renormalized); }, &sentence),
                Code::nonfinite);
      EXPECT_TRUE(says(sentence, "transform of 'tool0'"));
      EXPECT_TRUE(says(sentence, fields[field]));
      EXPECT_FALSE(renormalized);
    }
  }
}

TEST(CheckedPose, RefusesAQuaternionThatIsNoRotation) {
  const double lengths[] = {
      0.0, 1e-200, 1e200, 1e308, std::sqrt(0.9), std::sqrt(1.1), std::sqrt(0.9699), std::sqrt(1.0301), 5e-324, 2.0};
  for (const double length : lengths) {
    for (const Eigen::Vector4d& direction : {Eigen::Vector4d(0, 0, 0, 1), Eigen::Vector4d(0.5, -0.5, 0.5, -0.5)}) {
      std::string sentence;
      EXPECT_EQ(refusalOf([&] { checkedPose(kHere, length * direction, "pose", nullptr); }, &sentence),
                Code::bad_rotation)
          << length;
      EXPECT_TRUE(says(sentence, "0.97 .. 1.03"));
    }
  }
  const Eigen::Vector4d overflowing = Eigen::Vector4d::Constant(1e200);
  EXPECT_EQ(refusalOf([&] { checkedPose(kHere, overflowing, "pose"); }), Code::bad_rotation);
}

TEST(CheckedPose, NormalizesAQuaternionThatIsALittleOffAndSaysSo) {
  test::Random random(1);
  for (int i = 0; i < 1000; ++i) {
    Eigen::Vector4d unit;
    for (int k = 0; k < 4; ++k) unit[k] = random.uniform(-1, 1);
    unit.normalize();
    const double squared = random.uniform(0.9702, 1.0298);
    bool renormalized = false;
    const Pose pose = checkedPose(kHere, std::sqrt(squared) * unit, "pose", &renormalized);
    EXPECT_EQ(renormalized, std::abs(squared - 1.0) > 1e-6) << squared;
    EXPECT_TRUE((pose.linear() * pose.linear().transpose()).isIdentity(1e-14));
    const Pose straight = checkedPose(kHere, unit, "pose");
    EXPECT_TRUE(pose.linear().isApprox(straight.linear(), 1e-14));
    EXPECT_EQ(pose.translation(), kHere);
  }
}

TEST(CheckedPose, FlagsNothingThatIsWithinRoundingOfAUnit) {
  bool renormalized = false;
  checkedPose(kHere, kUpright, "pose", &renormalized);
  checkedPose(kHere, kUpright * (1 + 1e-8), "pose", &renormalized);
  EXPECT_FALSE(renormalized);
  checkedPose(kHere, kUpright * std::sqrt(1.01), "pose", &renormalized);
  EXPECT_TRUE(renormalized);
  checkedPose(kHere, kUpright, "pose", &renormalized);
  EXPECT_TRUE(renormalized) << "checkedPose() must never clear the flag";
}

TEST(CheckedPose, TurnsAsTheQuaternionSays) {
  const double half = std::sqrt(0.5);
  const Pose pose = checkedPose({1, 0, 0}, {0, 0, half, half}, "pose");  // 90 degrees about z
  EXPECT_TRUE((pose * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 1, 0), 1e-15));
}

TEST(CheckedPose, TakesNegativeZerosAndDenormals) {
  const double tiny = std::numeric_limits<double>::denorm_min();
  const Pose zero = checkedPose({0, 0, 0}, kUpright, "pose");
  const Pose negative = checkedPose({-0.0, -0.0, -0.0}, {-0.0, -0.0, -0.0, 1}, "pose");
  EXPECT_EQ(zero.translation(), negative.translation());
  EXPECT_EQ(zero.linear(), negative.linear());
  const Pose hardly = checkedPose({tiny, -tiny, tiny}, {tiny, 0, 0, 1}, "pose");
  EXPECT_TRUE(hardly.matrix().isApprox(zero.matrix(), 1e-300));
}

TEST(CheckWithin, TakesTheLimitItselfAndNothingBeyond) {
  const double limit = 1e6;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Eigen::Vector3d position = Eigen::Vector3d::Zero();
      position[axis] = sign * limit;
      EXPECT_EQ(refusalOf([&] { checkWithin(position, limit, "body"); }), Code::ok);
      position[axis] = sign * std::nextafter(limit, 0.0);
      EXPECT_EQ(refusalOf([&] { checkWithin(position, limit, "body"); }), Code::ok);
      for (const double beyond : {std::nextafter(limit, 2e6), 1e7, 1e16, 1e300}) {
        position[axis] = sign * beyond;
        std::string sentence;
        EXPECT_EQ(refusalOf([&] { checkWithin(position, limit, "body 'a'"); }, &sentence), Code::out_of_range);
        EXPECT_TRUE(says(sentence, "body 'a'"));
        EXPECT_TRUE(says(sentence, text(limit)));
        EXPECT_TRUE(says(sentence, std::string(1, "xyz"[axis])));
      }
    }
  }
}

}  // namespace
}  // namespace hgrid
