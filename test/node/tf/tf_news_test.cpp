// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/tf/tf_news.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "test/node/support/moments.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {
namespace {

TEST(TfNews, AreCompleteWhenEachAwaitedFrameHasANewerTransform) {
  TfNews news(0.1);
  EXPECT_FALSE(news.complete());
  news.await({{3, s(5.0)}, {7, s(5.02)}, {9, s(5.0)}}, s(5.0), s(5.03));
  EXPECT_FALSE(news.complete());
  news.note(3, s(5.01), s(5.03));
  news.note(3, s(5.02), s(5.04));
  news.note(4, s(5.02), s(5.04));
  EXPECT_FALSE(news.complete()) << "frame 9 has no news";
  news.note(9, s(5.01), s(5.04));
  EXPECT_TRUE(news.complete());
  news.await({{3, s(5.02)}}, s(5.02), s(5.05));
  EXPECT_FALSE(news.complete());
  news.note(9, s(5.03), s(5.05));
  EXPECT_FALSE(news.complete()) << "frame 9 is not awaited anymore";
}

TEST(TfNews, AFrameThatStoppedDelaysTheOthersForMaxWaitOnly) {
  TfNews news(0.1);
  news.await({{1, s(5.0)}, {2, s(5.0)}}, s(5.0), s(5.0));
  news.note(1, s(5.1), s(5.1));
  EXPECT_FALSE(news.complete());
  news.note(1, s(5.11), s(5.11));
  EXPECT_TRUE(news.complete());
}

TEST(TfNews, AFrameThatStoppedDelaysTheOthersNoLongerIfTheirStampsAreAhead) {
  TfNews news(0.1);
  news.await({{1, s(5.02)}, {2, s(5.0)}}, s(5.0), s(5.0));
  news.note(1, s(5.12), s(5.1));
  EXPECT_FALSE(news.complete());
  news.note(1, s(5.14), s(5.12));
  EXPECT_TRUE(news.complete());
}

TEST(TfNews, TransformsThatTheLastTickKnewAreNoReasonForAnother) {
  TfNews news(0.1);
  news.await({{1, s(5.5)}, {2, s(5.0)}}, s(5.0), s(5.5));
  EXPECT_FALSE(news.complete()) << "nothing arrived since";
  news.note(1, s(5.52), s(5.52));
  EXPECT_TRUE(news.complete());
}

TEST(TfNews, AFrameThatIsStampedAheadDoesNotMakeTheOthersSlow) {
  TfNews news(0.1);
  news.await({{1, s(5.0)}, {2, s(5.3)}}, s(5.0), s(5.01));
  EXPECT_FALSE(news.complete());
  news.note(2, s(5.35), s(5.02));
  EXPECT_FALSE(news.complete());
  news.note(1, s(5.02), s(5.03));
  EXPECT_TRUE(news.complete());
}

TEST(TfNews, AChangeOfTheStructureIsNewsAtOnce) {
  TfNews news(0.1);
  news.noteStructure();
  EXPECT_TRUE(news.complete());
  news.await({}, s(5), s(5));
  EXPECT_FALSE(news.complete()) << "no frame moves";
}

TEST(TfNews, AreThoseThatAnInspectionOfAllFramesFinds) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    TfNews news(0.1);
    std::map<std::uint32_t, Time> newest;  // of all frames
    double now = 10.0;
    for (std::uint32_t frame = 0; frame < 6; ++frame) newest[frame] = s(now - random.uniform(0.0, 0.2));
    for (int round = 0; round < 20; ++round) {
      std::vector<FrameStamp> awaited;
      for (const auto& [frame, stamp] : newest) {
        if (random.below(3) > 0) awaited.push_back({frame, stamp});
      }
      const Time tick = s(now - random.uniform(0.0, 0.2));
      news.await(awaited, tick, s(now));
      Time ahead = tick;  // newest stamp; at most the time of its arrival
      bool heard = false;
      for (const FrameStamp& frame : awaited) {
        if (frame.newest <= s(now)) ahead = std::max(ahead, frame.newest);
      }
      for (int step = 0; step < 8; ++step) {
        now += random.uniform(0.0, 0.05);
        const auto frame = static_cast<std::uint32_t>(random.below(6));
        const Time stamp = std::max(newest[frame], s(now + random.uniform(-0.1, 0.05)));
        newest[frame] = stamp;
        news.note(frame, stamp, s(now));
        bool all = !awaited.empty();
        for (const FrameStamp& one : awaited) {
          if (one.frame == frame) ahead = std::max(ahead, std::min(stamp, s(now)));
          heard = heard || one.frame == frame;
          all = all && newest[one.frame] > tick;
        }
        EXPECT_EQ(news.complete(), all || (heard && ahead - tick > s(0.1)));
      }
    }
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
