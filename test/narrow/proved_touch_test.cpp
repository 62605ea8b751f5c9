// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Touches of triangles and planes that doubles can hardly tell from gaps: needles that cross at small angles, corners
// at a plane. The environment variable HGRID_TEST_AIMED sets the number of pairs of each size.
#include <gtest/gtest.h>

#include <cmath>

#include "test/narrow/narrow_phase_judge.h"
#include "test/support/distance_oracle.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace test {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

const ShapeLimits kWide{1e-9, 1e7};

Shape triangle(const Corners& corners) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices.assign(corners.begin(), corners.end());
  mesh->triangles = {{0, 1, 2}};
  return Shape::mesh(mesh, kWide);
}

/// Two triangles, often needles, whose sides cross or pass each other at angles and gaps down to the last digits.
class TrianglePair {
 public:
  TrianglePair(Random& random, double size) : random_(random), size_(size) {
    for (Eigen::Vector3d& corner : first) corner = 0.5 * size * randomVector(random, -1.0, 1.0);
    flatten(first);
    // A point of the first triangle, or of its border, and a line through this point almost in the triangle's plane.
    const double u = share(), v = (1.0 - u) * share();
    const Eigen::Vector3d at = first[0] + u * (first[1] - first[0]) + v * (first[2] - first[0]);
    const Eigen::Vector3d normal = (first[1] - first[0]).cross(first[2] - first[0]).stableNormalized();
    const Eigen::Vector3d along = random.chance(0.5) ? Eigen::Vector3d(first[1] - first[0]) : first[2] - first[1];
    const Eigen::Vector3d line = along.stableNormalized() + random.logUniform(1e-16, 1.0) * side() * normal +
                                 random.logUniform(1e-16, 1.0) * randomVector(random, -1.0, 1.0);
    second[0] = at - size * random.logUniform(1e-6, 1.0) * line;
    second[1] = at + size * random.logUniform(1e-6, 1.0) * line;
    second[2] = at + 0.5 * size * random.logUniform(1e-6, 1.0) * randomVector(random, -1.0, 1.0);
    if (random.chance(0.3)) return;
    const double off = random.logUniform(1e-17, 1e-3) * size * side();
    for (Eigen::Vector3d& corner : second) corner += off * normal;
  }

  Corners first, second;

 private:
  double side() { return random_.chance(0.5) ? 1.0 : -1.0; }
  double share() { return random_.chance(0.3) ? 0.0 : random_.uniform(0.0, 1.0); }
  void flatten(Corners& corners) {
    if (random_.chance(0.4)) return;
    const double thin = random_.logUniform(1e-9, 1e-2);
    corners[2] = corners[0] + random_.uniform(0.0, 1.0) * (corners[1] - corners[0]) + thin * (corners[2] - corners[0]);
  }

  Random& random_;
  const double size_;
};

class ProvedTouch : public testing::TestWithParam<double> {};

INSTANTIATE_TEST_SUITE_P(Sizes, ProvedTouch, testing::Values(1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5));

TEST_P(ProvedTouch, OfTrianglesIsNeverLost) {
  const double size = GetParam();
  const Real rounding = 100 * std::numeric_limits<Real>::epsilon() * size;
  Random random(11);
  Claim found("triangles that cross are in contact", 0.0), real("triangles that are in contact meet", 1e-12 * size);
  Claim proved("the lower bound is not greater than the distance", 1e-20 * size);
  Claim near("the distance is that of the triangles", 1e-9 + 1e-12 * size);
  int crossing = 0;
  const int count = countFromEnvironment("HGRID_TEST_AIMED", 20000);
  for (int i = 0; i < count; ++i) {
    const TrianglePair pair(random, size);
    const Case placed{triangle(pair.first), triangle(pair.second), Pose::Identity(), Pose::Identity(), 0.0, 0.0};
    const CoreDistance core =
        coreDistance(Convex(pair.first, Pose::Identity(), 0.0), Convex(pair.second, Pose::Identity(), 0.0), rounding);
    const Proximity answer = Trial(placed).measure();
    if (core.upper <= rounding) {
      ++crossing;
      found.hold(isContact(answer.status) ? 0.0 : 1.0, placed);
    }
    if (answer.status == Measure::contact) real.hold(static_cast<double>(core.lower), placed);
    if (answer.status != Measure::apart) continue;  // the side of an open mesh may count as its inside
    proved.hold(static_cast<double>(answer.lower_bound - core.upper), placed);
    near.hold(static_cast<double>(std::max<Real>(core.lower - answer.distance, answer.distance - core.upper)), placed);
  }
  for (const Claim* claim : {&found, &real, &proved, &near}) claim->expectHeld();
  EXPECT_GT(crossing, count / 10);
}

TEST_P(ProvedTouch, OfPlanesIsNeverLost) {
  const double size = GetParam();
  Random random(13);
  Claim proved("the lower bound is not greater than the distance", 1e-20 * size);
  Claim real("shapes that are in contact with a plane meet it", 1e-12 * size);
  Claim deep("the depth is not less than that of the shapes", 1e-20 * size);
  Claim near("the distance is that of the shapes", 1e-12 * size);
  const int count = countFromEnvironment("HGRID_TEST_AIMED", 20000);
  for (int i = 0; i < count; ++i) {
    const double height = size * random.logUniform(1e-4, 1.0), radius = size * random.logUniform(1e-4, 1.0);
    const Shape shape = random.chance(0.3)   ? Shape::box({height, radius, size}, kWide)
                        : random.chance(0.5) ? Shape::cylinder(height, radius, kWide)
                                             : Shape::cone(height, radius, kWide);
    Case placed{Shape::plane(), shape, randomPose(random, size), Pose::Identity(), 0.0, 0.0};
    // The pose of a plane has a z axis that is a unit vector up to rounding; the oracle takes the axis as it is.
    const Pose& plane = placed.world_from_first;
    const Eigen::AngleAxisd tiny(random.logUniform(1e-16, 1e-3), randomVector(random, -1.0, 1.0).normalized());
    placed.world_from_second.linear() =
        random.chance(0.3) ? randomPose(random, 1.0).linear() : (plane.linear() * tiny).eval();
    placed.world_from_second.translation() = plane.translation() + size * randomVector(random, -1.0, 1.0);
    if (random.chance(0.5)) placed.second_padding = size * random.logUniform(1e-6, 0.1);
    const Vector3r normal = plane.linear().col(2).cast<Real>(), origin = plane.translation().cast<Real>();
    const auto gap = [&] {
      const Convex second(shape, placed.world_from_second, placed.second_padding);
      return Real(normal.dot(second.support(-normal) - origin) / normal.norm() - second.radius());
    };
    const Real wanted = random.logUniform(1e-17, 1.0) * size * (random.chance(0.5) ? 1 : -1);
    placed.world_from_second.translation() += ((wanted - gap()) * normal).cast<double>();
    const Real truth = gap();
    const Proximity answer = Trial(placed).measure();
    if (isContact(answer.status)) {
      real.hold(static_cast<double>(truth), placed);
      deep.hold(static_cast<double>(-truth - answer.depth), placed);
      near.hold(std::abs(static_cast<double>(std::max<Real>(-truth, 0) - answer.depth)), placed);
      continue;
    }
    proved.hold(static_cast<double>(answer.lower_bound - truth), placed);
    near.hold(std::abs(static_cast<double>(truth - answer.distance)), placed);
  }
  for (const Claim* claim : {&proved, &real, &deep, &near}) claim->expectHeld();
}

}  // namespace
}  // namespace test
}  // namespace hgrid
