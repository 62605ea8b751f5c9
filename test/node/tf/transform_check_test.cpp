// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/tf/transform_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "test/node/support/moments.h"
#include "test/node/support/transform_views.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace test {
namespace {

constexpr double kMaxFuture = 0.5;  // [s]

geometry_msgs::TransformStamped good() {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "base";
  transform.header.stamp.fromSec(100.0);
  transform.child_frame_id = "arm";
  transform.transform.rotation.w = 1.0;
  return transform;
}

Code checked(const geometry_msgs::TransformStamped& transform, bool is_static = false, double now = 100.0) {
  return refusalOf([&] { checkTransform(viewOf(transform), is_static, moment(now, 1.0), kMaxFuture); });
}

TEST(TransformCheck, AcceptsAGoodTransform) {
  EXPECT_EQ(checked(good()), Code::ok);
  EXPECT_EQ(checked(good(), true), Code::ok);
}

TEST(TransformCheck, RefusesNamesThatAreEmptyTooLongOrTheSame) {
  for (const std::string& name : {std::string(), std::string(257, 'x')}) {
    geometry_msgs::TransformStamped child = good(), parent = good();
    child.child_frame_id = parent.header.frame_id = name;
    EXPECT_EQ(checked(child), Code::bad_id);
    EXPECT_EQ(checked(parent), Code::bad_id);
  }
  geometry_msgs::TransformStamped longest = good(), itself = good();
  longest.child_frame_id = std::string(256, 'x');
  itself.child_frame_id = "base";
  EXPECT_EQ(checked(longest), Code::ok);
  EXPECT_EQ(checked(itself), Code::bad_id);
}

TEST(TransformCheck, RefusesNumbersThatAreNoPose) {
  geometry_msgs::TransformStamped nan = good(), far = good(), zero = good();
  nan.transform.translation.y = std::numeric_limits<double>::quiet_NaN();
  far.transform.translation.z = -1.1e9;
  zero.transform.rotation.w = 0.0;
  for (const bool is_static : {false, true}) {
    EXPECT_NE(checked(nan, is_static), Code::ok);
    EXPECT_EQ(checked(far, is_static), Code::out_of_range);
    EXPECT_NE(checked(zero, is_static), Code::ok);
  }
}

TEST(TransformCheck, RefusesStampsThatAreZeroOrTooFarAheadOnTf) {
  geometry_msgs::TransformStamped unstamped = good();
  unstamped.header.stamp = ros::Time();
  EXPECT_EQ(checked(unstamped), Code::clock);
  EXPECT_EQ(checked(unstamped, true), Code::ok) << "the stamp of a static transform is ignored";
  EXPECT_EQ(checked(good(), false, 99.5), Code::ok);
  EXPECT_EQ(checked(good(), false, 99.49), Code::clock);
  EXPECT_EQ(checked(good(), false, 1e5), Code::ok) << "an old transform is valid for its own time";
}

/// Claim: this holds for a stamp near 0, too, which is not too far ahead of a clock that shows 0.
TEST(TransformCheck, RefusesTransformsOnTfBeforeThereIsATime) {
  geometry_msgs::TransformStamped early = good();
  early.header.stamp.fromSec(0.1);
  EXPECT_EQ(checked(early, false, 0.0), Code::clock);
  EXPECT_EQ(checked(early, true, 0.0), Code::ok);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
