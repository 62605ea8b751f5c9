// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/tf/publisher_clocks.h"

#include <gtest/gtest.h>

#include "test/node/support/moments.h"

namespace hgrid {
namespace test {
namespace {

/// Notes 50 messages per second, whose offsets are `offset` minus up to 10 ms.
void publish(PublisherClocks& clocks, const std::string& publisher, double offset, double from, double to) {
  int count = 0;
  for (double time = from; time < to; time += 0.02) clocks.note(publisher, s(offset - 0.002 * (count++ % 6)), s(time));
}

TEST(PublisherClocks, ThatAreConstantlyAheadOrBehindAreListedWithTheirOffset) {
  PublisherClocks clocks;
  publish(clocks, "/ahead", 0.3, 10.0, 15.0);
  publish(clocks, "/behind", -1.5, 10.0, 15.0);
  publish(clocks, "/fine", -0.02, 10.0, 15.0);
  const std::vector<ClockOffset> offsets = clocks.offsets(s(15.0));
  ASSERT_EQ(offsets.size(), 2u);
  EXPECT_EQ(offsets[0].publisher, "/behind");
  EXPECT_NEAR(offsets[0].offset, -1.5, 1e-9) << "the offset that is nearest to 0";
  EXPECT_EQ(offsets[1].publisher, "/ahead");
  EXPECT_NEAR(offsets[1].offset, 0.29, 1e-9);
}

TEST(PublisherClocks, ThatAreOnlySometimesAheadOrBehindAreNotListed) {
  PublisherClocks clocks;
  for (double time = 10.0; time < 20.0; time += 0.5) {
    publish(clocks, "/late", -0.5, time, time + 0.4);
    publish(clocks, "/late", -0.01, time + 0.4, time + 0.5);
    publish(clocks, "/early", 0.5, time, time + 0.4);
    publish(clocks, "/early", -0.01, time + 0.4, time + 0.5);
  }
  EXPECT_TRUE(clocks.offsets(s(20.0)).empty());
}

TEST(PublisherClocks, AreListedNoLongerWhenTheClockWasCorrectedOrThePublisherStopped) {
  PublisherClocks clocks;
  publish(clocks, "/ahead", 0.3, 10.0, 15.0);
  publish(clocks, "/stopped", 0.3, 10.0, 15.0);
  EXPECT_EQ(clocks.offsets(s(15.0)).size(), 2u);
  publish(clocks, "/ahead", 0.0, 15.0, 20.0);
  EXPECT_TRUE(clocks.offsets(s(20.0)).empty());
}

TEST(PublisherClocks, AreBoundedAndMakeRoomWhenSomeStop) {
  PublisherClocks clocks;
  for (std::size_t i = 0; i < 2 * PublisherClocks::kMaxPublishers; ++i) {
    publish(clocks, "/name" + std::to_string(i), 0.3, 10.0, 12.5);
  }
  EXPECT_EQ(clocks.offsets(s(12.5)).size(), PublisherClocks::kMaxPublishers);
  publish(clocks, "/new", 0.3, 20.0, 22.5);
  EXPECT_EQ(clocks.offsets(s(22.5)).size(), 1u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
