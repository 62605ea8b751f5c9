// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Claim: if memory runs out while a transform is stored, the tables of frames stay consistent.
#include <gtest/gtest.h>

#include <map>
#include <memory>

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

/// Returns a message with the transforms of 12 frames.
/// @param first  position x [m] of the first frame; each of the others is 1 m farther
tf2_msgs::TFMessage messageAt(std::uint64_t stamp, double first = 0.0) {
  tf2_msgs::TFMessage message;
  for (int i = 0; i < 12; ++i) {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = longName(i / 2);
    transform.child_frame_id = longName(i + 1);
    transform.header.stamp.fromNSec(stamp);
    transform.transform.rotation.w = 1.0;
    transform.transform.translation.x = first + i;
    message.transforms.push_back(transform);
  }
  return message;
}

TEST(TfIntakeFailedAllocation, HasNoEffectOnceTheSameMessageArrivesAgain) {
  const Moment now{Time(1000000000), {}};
  const tf2_msgs::TFMessage message = messageAt(1000000000);
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

/// Claim: a frame always names the publisher of its newest transform. Otherwise poses of two publishers would be mixed.
TEST(TfIntakeFailedAllocation, MixesNoPublishers) {
  constexpr double kOther = 100.0;  // [m] the transforms of the second publisher are so far away
  const std::string first(30, '1'), second(30, '2');
  Ledger ledger;
  for (const bool is_static : {false, true}) {
    std::size_t k = 1, of_second = 0;
    for (bool failed = true; failed; ++k) {
      SCOPED_TRACE("allocation " + std::to_string(k));
      TfIntake intake(20.0, 10.0, 1000, false, ledger);
      const auto take = [&](std::uint64_t time, const std::string& publisher, double x) {
        const auto message = std::make_shared<const tf2_msgs::TFMessage>(messageAt(time, x));
        const Time now(static_cast<std::int64_t>(time));
        const Moment moment{now, std::chrono::steady_clock::time_point(now)};
        return [&intake, is_static, publisher, message, views = viewsOf(*message), moment] {
          intake.take(views, is_static, publisher, moment);
        };
      };
      const auto expectRightPublishers = [&] {
        for (std::uint32_t frame = 0; frame < intake.table().size(); ++frame) {
          const PoseSample& newest = intake.history(frame).newest();
          if (newest.parent == TfIntake::kNone) continue;
          const bool is_second = newest.parent_from_frame.translation.x() >= kOther;
          of_second += is_second ? 1 : 0;
          ASSERT_NE(intake.frame(frame).publisher, nullptr);
          ASSERT_EQ(*intake.frame(frame).publisher, is_second ? second : first);
        }
      };
      failed = failsAt(k, Failing::one, take(1000000000, first, 0.0));
      expectRightPublishers();
      take(1010000000, second, kOther)();
      failed = failsAt(k, Failing::one, take(3000000000, second, kOther)) || failed;  // the first one was silent
      expectRightPublishers();
      take(3010000000, first, 0.0)();
      expectRightPublishers();
    }
    EXPECT_GT(k, 30u);
    EXPECT_GT(of_second, 100u);
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
