// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests FCL's reference distances themselves, for shapes whose distance is known.
#include "test/adapters/fcl_witness.h"

#include <gtest/gtest.h>

#include "test/adapters/urdf_texts.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

Pose at(double x, double y, double z) { return Pose(Eigen::Translation3d(x, y, z)); }

Body bodyOf(std::vector<BodyShape> shapes) {
  Body body;
  body.shapes = std::move(shapes);
  return body;
}

BodyShape shape(Shape shape, const Pose& body_from_shape = Pose::Identity()) {
  return BodyShape{std::move(shape), body_from_shape, 0.0, "", Eigen::Vector3d::Ones()};
}

TEST(FclWitness, KnownDistancesAreRight) {
  const FclBody ball(bodyOf({shape(Shape::sphere(1))}));
  const FclBody box(bodyOf({shape(Shape::box({2, 4, 6}))}));
  const FclBody cylinder(bodyOf({shape(Shape::cylinder(4, 1))}));
  const FclBody solid(bodyOf({shape(Shape::mesh(tetrahedron()))}));
  EXPECT_NEAR(fclDistance(ball, at(0, 0, 0), ball, at(3, 4, 0), 10), 3.0, 1e-9);
  EXPECT_NEAR(fclDistance(box, at(0, 0, 0), ball, at(0, 0, 5), 10), 1.0, 1e-7);
  EXPECT_NEAR(fclDistance(cylinder, at(0, 0, 0), box, at(0, 0, 6), 10), 1.0, 1e-7);
  EXPECT_NEAR(fclDistance(cylinder, at(0, 0, 0), box, at(4, 0, 0), 10), 2.0, 1e-7);
  EXPECT_NEAR(fclDistance(solid, at(0, 0, 0), ball, at(2, 0, 0), 10), 0.5, 1e-7);
  EXPECT_NEAR(fclDistance(solid, at(0, 0, 0), solid, at(0, 0, 0.25), 10), 0.125, 1e-9);
  EXPECT_EQ(fclDistance(ball, at(0, 0, 0), ball, at(1, 0, 0), 10), 0.0);
  EXPECT_EQ(fclDistance(solid, at(0, 0, 0), solid, at(0.01, 0.01, 0.01), 10), 0.0);
  EXPECT_EQ(fclDistance(ball, at(0, 0, 0), ball, at(100, 0, 0), 10), 10.0) << "a far distance must be the cutoff";
}

TEST(FclWitness, EveryPartCountsWithItsOwnPose) {
  const FclBody two(bodyOf({shape(Shape::sphere(1), at(-5, 0, 0)), shape(Shape::sphere(1), at(5, 0, 0))}));
  const FclBody ball(bodyOf({shape(Shape::sphere(1))}));
  EXPECT_NEAR(fclDistance(two, at(0, 0, 0), ball, at(9, 0, 0), 10), 2.0, 1e-9);
  EXPECT_NEAR(fclDistance(ball, at(-9, 0, 0), two, at(0, 0, 0), 10), 2.0, 1e-9);
}

TEST(FclWitness, TheCutoffHidesNothingNearer) {
  Random random(1);
  const std::vector<FclBody> bodies = {
      FclBody(bodyOf({shape(Shape::mesh(tetrahedron()))})), FclBody(bodyOf({shape(Shape::cylinder(0.5, 0.1))})),
      FclBody(bodyOf({shape(Shape::box({0.2, 0.3, 0.4}))})), FclBody(bodyOf({shape(Shape::sphere(0.2))}))};
  for (int i = 0; i < 2000; ++i) {
    const FclBody &a = bodies[static_cast<std::size_t>(random.below(4))],
                  &b = bodies[static_cast<std::size_t>(random.below(4))];
    const Pose pose_a = uniformPose(random, 0.5), pose_b = uniformPose(random, 0.5);
    const double far = fclDistance(a, pose_a, b, pose_b, 100), near = fclDistance(a, pose_a, b, pose_b, 0.1);
    EXPECT_NEAR(near, std::min(far, 0.1), 1e-7);
    EXPECT_NEAR(fclDistance(b, pose_b, a, pose_a, 0.1), near, 1e-7) << "in the other order";
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
