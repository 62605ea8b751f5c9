// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/tf/frame_history.h"

#include <gtest/gtest.h>

#include "test/node/support/moments.h"

namespace hgrid {
namespace test {
namespace {

PoseSample sample(double time, double x, std::uint32_t parent = 7) {
  PoseSample result{s(time), parent, {}};
  result.parent_from_frame.translation.x() = x;
  return result;
}

/// x [m] at a time, or no value. What this does not store itself is at x = -1 m.
std::optional<double> xAt(const FrameHistory& history, double time) {
  const auto older = [](Time) -> std::optional<FramePose> { return sample(0, -1.0).parent_from_frame; };
  const auto pose = history.at(s(time), older);
  return pose ? std::optional<double>(pose->translation.x()) : std::nullopt;
}

constexpr bool kSameParent = true, kKeepsAll = true;

TEST(FrameHistory, OfAStaticFrameIsOnePoseAtAnyTime) {
  FrameHistory history;
  history.fix(sample(0, 3.0));
  EXPECT_FALSE(history.moves());
  EXPECT_EQ(xAt(history, 1.0), 3.0);
  EXPECT_EQ(xAt(history, 1e9), 3.0);
}

TEST(FrameHistory, InterpolatesBetweenTheTwoNewestSamplesAndAsksForOlderOnes) {
  FrameHistory history;
  history.advance(sample(10, 1.0), !kSameParent, !kKeepsAll);
  history.advance(sample(12, 2.0), kSameParent, !kKeepsAll);
  EXPECT_TRUE(history.moves());
  EXPECT_EQ(xAt(history, 12.0), 2.0);
  EXPECT_EQ(xAt(history, 11.0), 1.5);
  EXPECT_EQ(xAt(history, 10.0), 1.0);
  EXPECT_EQ(xAt(history, 9.0), -1.0);
  EXPECT_EQ(xAt(history, 12.1), std::nullopt) << "nobody knows the future";
  history.fill(sample(11, 5.0));
  EXPECT_EQ(xAt(history, 11.5), 3.5) << "a sample that came late is used";
  EXPECT_EQ(xAt(history, 10.5), -1.0);
}

TEST(FrameHistory, IsNotKnownWithinASeamButAtBothOfItsEnds) {
  FrameHistory history;
  history.advance(sample(10, 1.0), !kSameParent, !kKeepsAll);
  history.addSeam(s(12));
  history.advance(sample(12, 2.0), kSameParent, !kKeepsAll);
  EXPECT_EQ(xAt(history, 10.0), 1.0);
  EXPECT_EQ(xAt(history, 11.0), std::nullopt);
  EXPECT_EQ(xAt(history, 12.0), 2.0);
  EXPECT_TRUE(history.isBeforeSeam(s(11.9)));
  EXPECT_FALSE(history.isBeforeSeam(s(12)));
}

TEST(FrameHistory, IsNotKnownBeforeTheFrameGotItsParent) {
  FrameHistory history;
  history.advance(sample(10, 1.0, 7), !kSameParent, !kKeepsAll);
  history.advance(sample(12, 2.0, 8), !kSameParent, !kKeepsAll);
  EXPECT_EQ(xAt(history, 11.0), std::nullopt);
  history.advance(sample(14, 4.0, 8), kSameParent, !kKeepsAll);
  EXPECT_EQ(xAt(history, 13.0), 3.0);
  EXPECT_EQ(xAt(history, 11.9), std::nullopt);
}

TEST(FrameHistory, OfAStampThatRanBackBeginsAgain) {
  FrameHistory history;
  history.advance(sample(100, 9.0), !kSameParent, !kKeepsAll);
  history.advance(sample(10, 1.0), kSameParent, !kKeepsAll);
  EXPECT_EQ(xAt(history, 10.0), 1.0);
  EXPECT_EQ(xAt(history, 50.0), std::nullopt);
  history.fill(sample(8, 3.0));
  EXPECT_EQ(xAt(history, 9.0), 2.0) << "the sample that was ahead is forgotten";
}

TEST(FrameHistory, KeepsSixtyFourSamplesOfAFrameThatTf2DoesNotStore) {
  FrameHistory history;
  for (int i = 1; i <= 100; ++i) history.advance(sample(i, i), i > 1, kKeepsAll);
  EXPECT_EQ(xAt(history, 99.5), 99.5);
  EXPECT_EQ(xAt(history, 37.5), 37.5);
  EXPECT_EQ(xAt(history, 36.5), std::nullopt) << "and it asks nobody else";
}

TEST(FrameHistory, KeepsTheNewestPoseWhenStampsAreForgotten) {
  FrameHistory history;
  history.advance(sample(10, 1.0), !kSameParent, kKeepsAll);
  history.advance(sample(12, 2.0), kSameParent, kKeepsAll);
  history.forgetStamps();
  EXPECT_EQ(history.newest().stamp, Time(0));
  EXPECT_EQ(history.newest().parent_from_frame.translation.x(), 2.0);
  EXPECT_EQ(xAt(history, 11.0), std::nullopt);
  history.advance(sample(5, 3.0), kSameParent, kKeepsAll);
  EXPECT_EQ(xAt(history, 5.0), 3.0);
  EXPECT_EQ(xAt(history, 4.0), std::nullopt) << "nothing leads from the old time to the new one";
}

TEST(FrameHistory, OfAFrameThatBecomesStaticForgetsItsSamples) {
  FrameHistory history;
  history.advance(sample(10, 1.0), !kSameParent, !kKeepsAll);
  history.fix(sample(0, 3.0));
  EXPECT_EQ(xAt(history, 5.0), 3.0);
  history.advance(sample(12, 2.0), kSameParent, kKeepsAll);
  EXPECT_EQ(xAt(history, 11.0), std::nullopt) << "the static pose is of no time";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
