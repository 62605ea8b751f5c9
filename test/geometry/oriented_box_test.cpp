// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/geometry/oriented_box.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "test/support/shapes.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace test {
namespace {

/// Claim: the depth of two boxes is that which the narrow phase proves, also if their edges are almost parallel.
TEST(OrientedBox, TheDepthOfLongBoxesWithAlmostParallelEdgesIsTheLeastOfAllAxes) {
  const auto narrow_phase = makeCoreNarrowPhase();
  Random random(9);
  int deep = 0;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d long_side(100.0, 1e-5, 1e-5);
    const double from_face = random.uniform(-0.2, 0.2);  // [rad] angle of the axis of the tilt from a face normal
    const Eigen::Vector3d axis(0.0, std::cos(from_face), std::sin(from_face));
    OrientedBox first{randomPose(random, 1.0), long_side}, second = first;
    const Eigen::AngleAxisd tilt(random.logUniform(1e-9, 1e-6), axis);
    second.world_from_box.linear() = first.world_from_box.linear() * tilt.toRotationMatrix();
    second.world_from_box.translation() += first.world_from_box.linear() * (random.uniform(0.0, 1e-5) * axis);
    const auto block = narrow_phase->block(long_side);
    const PlacedSolid a{*block, first.world_from_box, 0.0}, b{*block, second.world_from_box, 0.0};
    if (!isContact(narrow_phase->measure(a, b, 0.0).status)) continue;
    const Contact contact = narrow_phase->measureContact(a, b);
    ASSERT_NEAR(penetrationDepth(first, second), contact.depth, 1e-9) << "tilt " << tilt.angle();
    ASSERT_LE(contact.depth_at_least, contact.depth);
    ++deep;
  }
  EXPECT_GT(deep, 1000);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
