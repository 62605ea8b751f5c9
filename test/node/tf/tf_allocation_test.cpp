// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Claim: if memory runs out while a transform is stored, the tables of frames stay consistent.
#include <gtest/gtest.h>

#include <map>

#include "src/node/tf/tf_intake.h"
#include "test/node/support/transform_views.h"
#include "test/support/failing_allocations.h"

namespace hgrid {
namespace test {
namespace {

std::string longName(int number) { return "a_frame_with_a_name_too_long_for_a_small_string_" + std::to_string(number); }

TEST(FrameTableFailedAllocation, ChangesNothing) {
  std::size_t failures = 0;
  for (int frames = 0; frames < 40; ++frames) {
    FrameTable table(1000);
    for (int i = 0; i < frames; ++i) table.setParent(table.admit(longName(i + 1), longName(i)), longName(i + 1));
    const std::size_t size = table.size();
    const std::uint64_t revision = table.revision();
    for (std::size_t k = 1;; ++k) {
      const bool failed = failsAt(k, Failing::one, [&] { table.admit("a", longName(1000)); });
      if (!failed) break;
      ++failures;
      ASSERT_EQ(table.size(), size);
      ASSERT_EQ(table.placed(), static_cast<std::size_t>(frames));
      ASSERT_EQ(table.revision(), revision);
      ASSERT_EQ(table.find(longName(1000)), FrameTable::kNone);
    }
    EXPECT_EQ(table.find(longName(1000)), size) << "the next frame gets the next number";
  }
  EXPECT_GT(failures, 80u);
}

/// Returns the position x [m] of each frame in its parent at the time 1 s. -1 means that the pose is not known.
std::vector<double> positions(const TfIntake& intake) {
  std::vector<double> x;
  for (std::uint32_t frame = 0; frame < intake.table().size(); ++frame) {
    const auto pose = intake.history(frame).at(Time(1000000000));
    x.push_back(pose ? pose->translation.x() : -1.0);
  }
  return x;
}

TEST(TfIntakeFailedAllocation, HasNoEffectOnceTheSameMessageArrivesAgain) {
  const Moment now{Time(1000000000), {}};
  tf2_msgs::TFMessage message;
  for (int i = 0; i < 12; ++i) {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = longName(i / 2);
    transform.child_frame_id = longName(i + 1);
    transform.header.stamp.fromNSec(1000000000);
    transform.transform.rotation.w = 1.0;
    transform.transform.translation.x = i;
    message.transforms.push_back(transform);
  }
  const std::vector<TransformView> views = viewsOf(message);
  Ledger ledger;
  TfIntake all_well(1.0, 10.0, 1000, false, ledger);
  all_well.take(views, false, "/publisher", now);
  const auto byName = [&](const TfIntake& intake) {
    std::map<std::string, double> result;
    const std::vector<double> x = positions(intake);
    for (std::uint32_t frame = 0; frame < x.size(); ++frame) result[intake.table().name(frame)] = x[frame];
    return result;
  };
  std::size_t k = 1;
  for (bool failed = true; failed; ++k) {
    SCOPED_TRACE("allocation " + std::to_string(k));
    TfIntake intake(1.0, 10.0, 1000, false, ledger);
    failed = failsAt(k, Failing::one, [&] { intake.take(views, false, "/publisher", now); });
    positions(intake);  // a tick between the two calls must not read beyond the end of a table
    intake.take(views, false, "/publisher", now);
    ASSERT_EQ(byName(intake), byName(all_well));
  }
  EXPECT_GT(k, 50u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
