// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/tf/frame_history.h"

#include <gtest/gtest.h>

#include <map>

#include "test/node/support/moments.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {
namespace {

constexpr Time kKeepAll{0};

PoseSample sample(double time, double x, std::uint32_t parent = 7) {
  PoseSample result;
  result.stamp = s(time);
  result.parent = parent;
  result.parent_from_frame.translation.x() = x;
  return result;
}

PoseSample seamAt(double time, double x) {
  PoseSample result = sample(time, x);
  result.continues = false;
  return result;
}

/// Returns the position x [m] of the frame in its newest parent at a time; empty if the pose is not known.
std::optional<double> xAt(const FrameHistory& history, double time) {
  const auto pose = history.at(s(time));
  return pose ? std::optional<double>(pose->translation.x()) : std::nullopt;
}

TEST(FrameHistory, KnowsNothingAtFirst) {
  const FrameHistory history;
  EXPECT_FALSE(history.moves());
  EXPECT_EQ(xAt(history, 1.0), std::nullopt);
  EXPECT_EQ(history.newest().parent, FrameTable::kNone);
}

TEST(FrameHistory, OfAStaticFrameIsOnePoseAtAnyTime) {
  FrameHistory history;
  history.fix(sample(0, 3.0));
  EXPECT_FALSE(history.moves());
  EXPECT_EQ(xAt(history, 1.0), 3.0);
  EXPECT_EQ(xAt(history, 1e9), 3.0);
}

TEST(FrameHistory, InterpolatesBetweenSamples) {
  FrameHistory history;
  for (const double time : {8.0, 10.0, 12.0}) history.advance(sample(time, time / 2.0), kKeepAll);
  EXPECT_TRUE(history.moves());
  EXPECT_EQ(xAt(history, 12.0), 6.0);
  EXPECT_EQ(xAt(history, 11.0), 5.5);
  EXPECT_EQ(xAt(history, 10.0), 5.0);
  EXPECT_EQ(xAt(history, 8.5), 4.25);
  EXPECT_EQ(xAt(history, 8.0), 4.0);
  EXPECT_EQ(xAt(history, 7.9), std::nullopt) << "before the first sample";
  EXPECT_EQ(xAt(history, 12.1), std::nullopt) << "after the last sample";
}

TEST(FrameHistory, UsesASampleThatCameLateAndKeepsTheFirstOfTwoWithOneStamp) {
  FrameHistory history;
  history.advance(sample(10, 1.0), kKeepAll);
  history.advance(sample(12, 2.0), kKeepAll);
  EXPECT_TRUE(history.fill(sample(11, 5.0)));
  EXPECT_EQ(xAt(history, 11.5), 3.5);
  EXPECT_TRUE(history.fill(sample(11, 50.0)));
  EXPECT_EQ(xAt(history, 11.5), 3.5);
  EXPECT_TRUE(history.fill(sample(8, 0.0)));
  EXPECT_EQ(xAt(history, 9.0), 0.5);
  EXPECT_EQ(history.newest().stamp, s(12));
}

TEST(FrameHistory, DropsSamplesOlderThanTheCache) {
  FrameHistory history;
  history.advance(sample(10, 1.0), kKeepAll);
  history.advance(sample(12, 2.0), kKeepAll);
  history.advance(sample(14, 3.0), s(11));
  EXPECT_EQ(xAt(history, 12.0), 2.0);
  EXPECT_EQ(xAt(history, 11.9), std::nullopt);
  EXPECT_FALSE(history.fill(sample(10.9, 1.0)));
  EXPECT_TRUE(history.fill(sample(11, 1.0)));
  history.advance(sample(99, 4.0), s(89));
  EXPECT_EQ(xAt(history, 99.0), 4.0) << "the newest stays";
}

TEST(FrameHistory, IsNotKnownWithinASeamButAtBothOfItsEnds) {
  FrameHistory history;
  history.advance(sample(10, 1.0), kKeepAll);
  history.advance(seamAt(12, 2.0), kKeepAll);
  EXPECT_EQ(xAt(history, 10.0), 1.0);
  EXPECT_EQ(xAt(history, 11.0), std::nullopt);
  EXPECT_EQ(xAt(history, 12.0), 2.0);
  EXPECT_FALSE(history.fill(sample(11.9, 9.0))) << "it is not known to which side of the seam the sample belongs";
  history.advance(sample(14, 3.0), kKeepAll);
  EXPECT_TRUE(history.fill(sample(13, 9.0)));
}

TEST(FrameHistory, IsKnownInTheParentOfEachTime) {
  FrameHistory history;
  history.advance(sample(10, 1.0, 7), kKeepAll);
  history.advance(sample(11, 2.0, 7), kKeepAll);
  history.advance(sample(12, 3.0, 8), kKeepAll);
  history.advance(sample(14, 5.0, 8), kKeepAll);
  EXPECT_EQ(xAt(history, 13.0), 4.0);
  EXPECT_EQ(xAt(history, 11.9), std::nullopt) << "the pose is not known between samples in two parents";
  EXPECT_EQ(xAt(history, 10.5), std::nullopt) << "at this time, the frame was not in its newest parent";
  EXPECT_EQ(history.sampleAt(s(10.5))->parent, 7u);
  EXPECT_EQ(history.sampleAt(s(10.5))->parent_from_frame.translation.x(), 1.5);
  EXPECT_FALSE(history.sampleAt(s(11.9)));
}

TEST(FrameHistory, DropsSamplesThatWereAheadOfANewerOne) {
  FrameHistory history;
  history.advance(sample(10, 1.0), kKeepAll);
  history.advance(sample(100, 9.0), kKeepAll);
  history.advance(sample(101, 9.0), kKeepAll);
  history.advance(sample(12, 2.0), kKeepAll);
  EXPECT_EQ(xAt(history, 12.0), 2.0);
  EXPECT_EQ(xAt(history, 50.0), std::nullopt);
  EXPECT_EQ(xAt(history, 11.0), 1.5);
  history.advance(seamAt(100, 9.0), kKeepAll);
  history.advance(sample(14, 3.0), kKeepAll);
  EXPECT_EQ(xAt(history, 13.0), std::nullopt) << "one of the dropped samples ended a seam";
}

TEST(FrameHistory, DoesNotInheritASeamFromSamplesThatAreTooOld) {
  FrameHistory history;
  for (int time = 1; time <= 5; ++time) {
    PoseSample next = sample(time, 0.0);
    next.continues = time != 2;
    history.advance(next, kKeepAll);
  }
  history.advance(sample(10, 0.0), s(9));
  history.advance(sample(1.5, 0.0), kKeepAll);  // replaces all newer samples
  EXPECT_TRUE(history.fill(sample(1.2, 0.0)));
}

TEST(FrameHistory, KeepsTheNewestPoseWhenStampsAreForgotten) {
  FrameHistory history;
  history.advance(sample(10, 1.0), kKeepAll);
  history.advance(sample(12, 2.0), s(9));
  history.forgetStamps();
  EXPECT_EQ(history.newest().stamp, Time(0));
  EXPECT_EQ(history.newest().parent_from_frame.translation.x(), 2.0);
  EXPECT_EQ(xAt(history, 11.0), std::nullopt);
  history.advance(sample(5, 3.0), kKeepAll);
  EXPECT_EQ(xAt(history, 5.0), 3.0);
  EXPECT_EQ(xAt(history, 4.0), std::nullopt) << "no sample connects the old time to the new time";
  EXPECT_TRUE(history.fill(sample(3, 1.0))) << "keep_from of the old time no longer applies";
}

TEST(FrameHistory, OfAFrameThatBecomesStaticForgetsItsSamples) {
  FrameHistory history;
  history.advance(sample(10, 1.0), kKeepAll);
  history.advance(sample(11, 1.0), kKeepAll);
  history.fix(sample(0, 3.0));
  EXPECT_EQ(xAt(history, 5.0), 3.0);
  history.advance(sample(12, 2.0), kKeepAll);
  EXPECT_EQ(xAt(history, 11.0), std::nullopt) << "the static pose has no stamp, so nothing is interpolated";
}

TEST(FrameHistory, SaysForWhichTimesAPoseIsKnown) {
  FrameHistory history;
  history.advance(sample(10, 1.0), kKeepAll);
  history.advance(sample(12, 2.0), kKeepAll);
  history.advance(seamAt(14, 3.0), kKeepAll);
  EXPECT_EQ(history.knownTimes(s(9)), "is known from 10 s to 14 s");
  EXPECT_EQ(history.knownTimes(s(15)), "is known from 10 s to 14 s");
  EXPECT_EQ(history.knownTimes(s(13)),
            "is not known between 12 s and 14 s, because its publisher or parent changed or its transforms paused");
  history.forgetStamps();
  EXPECT_EQ(history.knownTimes(s(13)), "has received no transform since the clock jumped");
}

/// A simple reference for FrameHistory. It checks all pairs of successive samples one by one.
class Oracle {
 public:
  void advance(const PoseSample& sample, Time keep_from) {
    bool continues = sample.continues;
    while (!samples_.empty() && samples_.rbegin()->first >= sample.stamp) {
      continues = continues && samples_.rbegin()->second.continues;
      samples_.erase(std::prev(samples_.end()));
    }
    samples_[sample.stamp] = sample;
    samples_[sample.stamp].continues = continues;
    kept_from_ = keep_from;
    while (samples_.size() > 1 && samples_.begin()->first < keep_from) samples_.erase(samples_.begin());
  }
  bool fill(const PoseSample& sample) {
    if (sample.stamp < kept_from_) return false;
    for (const auto& [stamp, other] : samples_) {
      if (stamp > sample.stamp && !other.continues) return false;
    }
    samples_.emplace(sample.stamp, sample);
    return true;
  }
  std::optional<double> xAt(Time time, bool in_newest_parent) const {
    for (auto to = samples_.begin(); to != samples_.end(); ++to) {
      const bool suits = !in_newest_parent || to->second.parent == samples_.rbegin()->second.parent;
      if (to->first == time) {
        return suits ? std::optional<double>(to->second.parent_from_frame.translation.x()) : std::nullopt;
      }
      if (to == samples_.begin() || to->first < time || std::prev(to)->first > time) continue;
      const auto& [begin, from] = *std::prev(to);
      if (!suits || !to->second.continues || from.parent != to->second.parent) return std::nullopt;
      const double fraction =
          static_cast<double>((time - begin).count()) / static_cast<double>((to->first - begin).count());
      const double x = from.parent_from_frame.translation.x();
      return x + fraction * (to->second.parent_from_frame.translation.x() - x);
    }
    return std::nullopt;
  }
  std::uint32_t parent() const { return samples_.empty() ? 7 : samples_.rbegin()->second.parent; }

 private:
  std::map<Time, PoseSample> samples_;
  Time kept_from_{0};
};

TEST(FrameHistory, AnswersAsTheOracleDoesAfterRandomSamples) {
  std::size_t known = 0, unknown = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    FrameHistory history;
    Oracle oracle;
    for (int i = 0; i < 60; ++i) {
      PoseSample next = sample(0.1 * random.between(100, 160 + i), random.uniform(-1.0, 1.0), oracle.parent());
      if (i > 0 && random.below(3) == 0 && next.stamp < history.newest().stamp) {
        ASSERT_EQ(history.fill(next), oracle.fill(next));
      } else if (i == 0 || next.stamp > history.newest().stamp || random.below(10) == 0) {
        if (random.below(8) == 0) next.parent = 7 + random.below(2);
        if (i > 0) next.continues = random.below(8) > 0;
        const bool usual = seed % 2 == 0;  // as in the node: nearly always the same duration before the newest sample
        const Time keep_from = (random.below(usual ? 50 : 4) != 0) == usual ? next.stamp - s(3) : kKeepAll;
        history.advance(next, keep_from);
        oracle.advance(next, keep_from);
      }
      for (int look = 0; look < 10; ++look) {
        const Time time = s(0.05 * random.between(190, 450));
        const auto expected = oracle.xAt(time, true), in_any = oracle.xAt(time, false);
        const auto pose = history.at(time);
        const auto found = history.sampleAt(time);
        ASSERT_EQ(pose.has_value(), expected.has_value()) << seconds(time);
        ASSERT_EQ(found.has_value(), in_any.has_value()) << seconds(time);
        if (expected) {
          ASSERT_NEAR(pose->translation.x(), *expected, 1e-12);
        }
        if (in_any) {
          ASSERT_NEAR(found->parent_from_frame.translation.x(), *in_any, 1e-12);
        }
        ++(expected ? known : unknown);
        const auto newest = history.newestKnownTime(time);
        if (newest) {
          ASSERT_TRUE(oracle.xAt(*newest, true));
        }
        for (Time later = newest ? *newest + Time(1) : s(9.5); later <= time; later += Time(12345678)) {
          ASSERT_FALSE(oracle.xAt(later, true)) << seconds(later) << " s is known and newer";
        }
      }
    }
  }
  EXPECT_GT(known, 10000u);
  EXPECT_GT(unknown, 10000u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
