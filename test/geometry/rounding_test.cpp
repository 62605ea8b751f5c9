// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares each rounding to float with a twin whose numbers are volatile, so that no compiler can leave out a
// conversion. This file is compiled with -O3, as the package.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "hgrid_proximity/geometry/aabb.h"
#include "hgrid_proximity/geometry/shape.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {
namespace {

/// Returns the largest float that is not larger than a number.
float twinOfRoundedDown(double number) {
  volatile double value = number;
  volatile float nearest = static_cast<float>(value);
  volatile double back = static_cast<double>(nearest);
  return back > value ? std::nextafter(nearest, -std::numeric_limits<float>::infinity()) : nearest;
}

template <std::size_t kCount>
void expectRounded(Random& random) {
  std::array<double, kCount> given, through, down;
  for (int i = 0; i < 2000; ++i) {
    for (double& number : given) number = random.uniform(-10.0, 10.0);
    for (std::size_t k = 0; k < kCount; ++k) through[k] = throughFloat(given[k]);
    for (std::size_t k = 0; k < kCount; ++k) down[k] = static_cast<double>(roundedDown(given[k]));
    for (std::size_t k = 0; k < kCount; ++k) {
      volatile float twin = static_cast<float>(given[k]);
      ASSERT_EQ(through[k], static_cast<double>(twin)) << k << " of " << kCount;
      ASSERT_EQ(down[k], static_cast<double>(twinOfRoundedDown(given[k]))) << k << " of " << kCount;
    }
  }
}

TEST(Rounding, OfRunsOfNumbersIsNotLeftOut) {
  Random random(5);
  expectRounded<1>(random);
  expectRounded<2>(random);
  expectRounded<3>(random);
  expectRounded<6>(random);
  expectRounded<7>(random);
  expectRounded<9>(random);
  expectRounded<10>(random);
  expectRounded<11>(random);
  expectRounded<14>(random);
  expectRounded<18>(random);
}

TEST(Rounding, OfGrownBoxesIsThatOfTheTwin) {
  Random random(6);
  for (int i = 0; i < 20000; ++i) {
    Aabb box;
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] = static_cast<float>(random.uniform(-10.0, 10.0));
      box.max[axis] = box.min[axis] + static_cast<float>(random.uniform(0.0, 1.0));
    }
    const double by = random.uniform(0.0, 0.1);
    const Aabb result = grown(box, by);
    for (int axis = 0; axis < 3; ++axis) {
      const double low = static_cast<double>(box.min[axis]), high = static_cast<double>(box.max[axis]);
      ASSERT_EQ(result.min[axis], twinOfRoundedDown(low - by - 1e-15 * (std::abs(low) + by)));
      ASSERT_EQ(result.max[axis], -twinOfRoundedDown(-(high + by + 1e-15 * (std::abs(high) + by))));
    }
  }
}

TEST(Rounding, OfBoxesAroundShapesIsOutward) {
  Random random(7);
  for (int i = 0; i < 20000; ++i) {
    const double radius = random.uniform(0.001, 1.0);
    Pose pose = Pose::Identity();
    for (int axis = 0; axis < 3; ++axis) pose.translation()[axis] = random.uniform(-10.0, 10.0);
    const Aabb box = boxOf(Shape::sphere(radius), pose, 0.0, Eigen::Vector3d::Zero());
    for (int axis = 0; axis < 3; ++axis) {
      volatile double least = static_cast<double>(box.min[axis]), most = static_cast<double>(box.max[axis]);
      ASSERT_LE(least, pose.translation()[axis] - radius);
      ASSERT_GE(most, pose.translation()[axis] + radius);
    }
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
