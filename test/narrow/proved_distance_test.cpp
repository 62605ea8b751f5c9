// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Distances of shapes of 1 mm to 100 km whose features are brought as near to each other as doubles can express: rims,
// tips, edges that are almost parallel, thin hulls, plates and needles. The environment variable HGRID_TEST_AIMED sets
// the number of pairs of each size.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "test/narrow/narrow_phase_judge.h"
#include "test/support/distance_oracle.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace test {
namespace {

const ShapeLimits kAnySize{1e-9, 1e7};

class Aimed {
 public:
  Aimed(unsigned seed, double size) : random_(seed), size_(size) {}

  Case next() {
    Case placed{shape(), shape(), Pose::Identity(), Pose::Identity(), padding(), padding()};
    placed.world_from_first.linear() = rotation();
    placed.world_from_second.linear() = rotation();
    const Eigen::Vector3d direction = aim(placed);
    const Convex first(placed.first_shape, placed.world_from_first, placed.first_padding),
        second(placed.second_shape, placed.world_from_second, placed.second_padding);
    const double gap =
        random_.chance(0.1) ? 0.0 : random_.logUniform(1e-16, 1.0) * size_ * (random_.chance(0.3) ? -1 : 1);
    const Real apart = gap + first.radius() + second.radius();
    const Vector3r along = direction.cast<Real>(), to = first.support(along) - second.support(-along) + apart * along;
    placed.world_from_second.translation() = to.cast<double>();
    if (random_.chance(0.5)) {
      const Eigen::Vector3d aside = randomVector(random_, -1.0, 1.0).cross(direction);
      placed.world_from_second.translation() += random_.logUniform(1e-12, 1.0) * size_ * aside;
    }
    return placed;
  }

 private:
  double length() { return size_ * (random_.chance(0.3) ? random_.uniform(0.3, 1.0) : random_.logUniform(1e-4, 1.0)); }
  double padding() { return random_.chance(0.6) ? 0.0 : size_ * random_.logUniform(1e-6, 0.1); }

  Shape shape() {
    switch (random_.below(6)) {
      case 0:
        return Shape::sphere(length(), kAnySize);
      case 1:
        return Shape::box({length(), length(), length()}, kAnySize);
      case 2:
        return Shape::cylinder(length(), length(), kAnySize);
      case 3:
        return Shape::cone(length(), length(), kAnySize);
      case 4:
        return Shape::capsule(length(), length(), kAnySize);
      default: {
        auto mesh = std::make_shared<TriangleMesh>();
        const double flat = random_.chance(0.5) ? 1.0 : random_.logUniform(1e-6, 1.0);
        for (int i = 4 + random_.below(12); i > 0; --i) {
          Eigen::Vector3d point = 0.5 * size_ * randomVector(random_, -1.0, 1.0);
          point.z() *= flat;
          mesh->vertices.push_back(point);
        }
        return Shape::hull(mesh, kAnySize);
      }
    }
  }

  /// Returns a rotation: none, by a multiple of 45 degrees and a tiny angle, or any.
  Eigen::Matrix3d rotation() {
    if (random_.chance(0.25)) return Eigen::Matrix3d::Identity();
    if (random_.chance(0.4)) return randomPose(random_, 1.0).linear();
    const Eigen::AngleAxisd turn(0.25 * M_PI * random_.below(8), Eigen::Vector3d::Unit(random_.below(3)));
    const Eigen::AngleAxisd tiny(random_.logUniform(1e-16, 1e-3), randomVector(random_, -1.0, 1.0).normalized());
    return (turn * tiny).toRotationMatrix();
  }

  /// Returns a direction from the first shape to the second, often along an axis or almost along it.
  Eigen::Vector3d aim(const Case& placed) {
    const Eigen::Vector3d axis =
        placed.world_from_first.linear().col(random_.below(3)) * (random_.chance(0.5) ? 1 : -1);
    if (random_.chance(0.4)) return axis;
    const double off = random_.chance(0.5) ? random_.logUniform(1e-16, 1e-2) : 10.0;
    return (axis + off * randomVector(random_, -1.0, 1.0)).normalized();
  }

  Random random_;
  const double size_;
};

class ProvedDistance : public testing::TestWithParam<double> {};

INSTANTIATE_TEST_SUITE_P(Sizes, ProvedDistance, testing::Values(1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5));

TEST_P(ProvedDistance, OfAimedShapesIsNarrowAndContainsTheTruth) {
  const double size = GetParam(), rounding = 1e-12 * size, width = 1e-9 + 1e-12 * size, digits = 1e-17 * size;
  Aimed aimed(7, size);
  Claim sound("a pair is measured", 0.0), narrow("the bounds are near each other", width);
  Claim not_smaller("the distance is not less than that of the shapes", rounding);
  Claim proved("the lower bound is not greater than the distance of the shapes", digits);
  Claim found("shapes that touch are in contact", 0.0);
  Claim real("shapes that are reported to touch do", rounding);
  Claim straight("the normal is right", 2e-6);
  const int count = countFromEnvironment("HGRID_TEST_AIMED", 20000);
  int judged = 0;
  for (int i = 0; i < count; ++i) {
    const Case placed = aimed.next();
    const Proximity answer = Trial(placed).measure();
    sound.hold(answer.status == Measure::apart || answer.status == Measure::contact ? 0.0 : 1.0, placed);
    const Convex first(placed.first_shape, placed.world_from_first, placed.first_padding),
        second(placed.second_shape, placed.world_from_second, placed.second_padding);
    const CoreDistance core = coreDistance(first, second, 1e-18L * size);
    if (!(core.upper - core.lower <= 1e-15L * size)) continue;  // the oracle has not enough digits either
    ++judged;
    const Real around = first.radius() + second.radius(), truth = core.upper - around;
    if (truth < -digits) found.hold(isContact(Trial(placed).measure(0.0).status) ? 0.0 : 1.0, placed);
    if (answer.status == Measure::contact) {
      real.hold(static_cast<double>(truth), placed);
      continue;
    }
    narrow.hold(answer.distance - answer.lower_bound, placed);
    not_smaller.hold(static_cast<double>(std::max<Real>(truth, 0.0L) - answer.distance), placed);
    proved.hold(static_cast<double>(answer.lower_bound - truth), placed);
    if (core.upper - core.lower > 1e-13L * core.upper || answer.normal.hasNaN()) continue;
    const Vector3r normal = (core.on_second - core.on_first) / core.upper;
    const Real turned = 1e-14L * size / core.upper;  // by the rounding of the relative pose, seen over the distance
    straight.hold(static_cast<double>((normal - answer.normal.cast<Real>()).norm() - turned), placed);
  }
  for (const Claim* claim : {&sound, &narrow, &not_smaller, &proved, &found, &real, &straight}) claim->expectHeld();
  std::printf("shapes of %g m: widest interval %.1e m, %d of %d pairs judged\n", size, narrow.worst(), judged, count);
  const bool has_128_bits = std::numeric_limits<Real>::digits10 > 30;
  EXPECT_GE(judged, has_128_bits ? count - count / 1000 : count * 8 / 10);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
