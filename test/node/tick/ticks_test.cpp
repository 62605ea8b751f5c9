// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests when a running node makes ticks. The heartbeat is so slow that only data can cause a tick in time. This file is
// part of two programs: one with the wall clock, and one with a simulated clock that is slow or fast.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/simulated_clock.h"
#include "test/node/support/transform_source.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {
namespace {

constexpr double kMaxSyncWait = 0.1;  // [s] ~limits/max_sync_wait

/// A publisher that sends one frame at a rate, with jitter, and perhaps stops.
struct Stream {
  std::string frame;
  double rate;           // [Hz]
  double end = 1e9;      // [s] it sends nothing from here on
  double newest = -1.0;  // [s] stamp of the newest transform that was sent
};

/// A transform that a stream sends. Times are seconds since the beginning of the test.
struct Sent {
  double stamp, arrival;
  std::size_t stream;
};

/// Returns what the streams send, in the order of arrival.
std::vector<Sent> sendingsOf(const std::vector<Stream>& streams, double duration, Random& random) {
  std::vector<Sent> sendings;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const double period = 1.0 / streams[i].rate, end = std::min(duration, streams[i].end);
    for (double time = 0.0; time < end; time += period) {
      const double stamp = 0.001 * std::floor(1000.0 * (time + random.uniform(0.0, 0.3 * period)));
      sendings.push_back({stamp, stamp + random.uniform(0.0, 0.3 * period), i});
    }
  }
  std::sort(sendings.begin(), sendings.end(), [](const Sent& a, const Sent& b) { return a.arrival < b.arrival; });
  return sendings;
}

/// Returns the newest time at which all streams that keep up are known. This is the specification of the time of a
/// tick, for streams that are not ahead of the clock.
double commonTimeOf(const std::vector<Stream>& streams) {
  double newest = -1.0;
  for (const Stream& stream : streams) newest = std::max(newest, stream.newest);
  double common = newest;
  for (const Stream& stream : streams) {
    if (stream.newest >= 0.0 && newest - stream.newest <= kMaxSyncWait + 1e-9) common = std::min(common, stream.newest);
  }
  return common;
}

/// Returns times [s] in microseconds, because stamps are rounded to nanoseconds.
std::vector<std::int64_t> rounded(const std::vector<double>& times) {
  std::vector<std::int64_t> result;
  for (const double time : times) result.push_back(std::llround(1e6 * time));
  return result;
}

/// Returns the times of all ticks from `begin` on, without repetitions, relative to `begin` [us].
std::vector<std::int64_t> publishedTimes(const Heard& heard, const ros::Time& begin) {
  std::vector<std::int64_t> times;
  for (const msg::Pairs::ConstPtr& pairs : heard.pairs) {
    const std::int64_t time = std::llround(1e6 * (pairs->world.stamp - begin).toSec());
    if (time >= 0 && (times.empty() || time != times.back())) times.push_back(time);
  }
  return times;
}

/// A node that follows the data. With a simulated clock, the clock has a speed.
class TicksNode {
 public:
  explicit TicksNode(double speed)
      : clock_(ros::Time::isSimTime() ? std::make_unique<SimulatedClock>(1000.0, speed) : nullptr),
        transforms_([this] { return clock_ ? clock_->now() : wallTime(); }),
        node_(setup()) {
    node_.waitForStatus("the robot", [](const msg::Status& s) { return s.body_count == 5; });
  }
  TransformSource& transforms() { return transforms_; }
  NodeUnderTest& node() { return node_; }
  void waitUntilClock(const ros::Time& time) const {
    while (transforms_.now() < time) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

 private:
  static NodeSetup setup() {
    NodeSetup setup;
    setup.params = dict({{"rate", 1000.0},
                         {"heartbeat", 0.1},
                         {"limits/max_sync_wait", kMaxSyncWait},
                         {"late_after", 3600.0},
                         {"stale_after", 3600.0},
                         {"lost_after", 3600.0}});
    setup.beside["robot_description"] = balls({"a", "b", "c", "d"});
    return setup;
  }

  std::unique_ptr<SimulatedClock> clock_;
  TransformSource transforms_;
  NodeUnderTest node_;
};

/// Returns the speeds of clocks for which the claims are tested.
std::vector<double> speeds() {
  return ros::Time::isSimTime() ? std::vector<double>{0.3, 4.0} : std::vector<double>{1.0};
}

/// Claim: each transform that completes a newer common time causes a tick with this time, and no other transform does.
/// A stream that stops delays the others for ~limits/max_sync_wait only.
TEST(Ticks, FollowStreamsOfDifferentRatesAsASimulationDoes) {
  for (const double speed : speeds()) {
    SCOPED_TRACE("speed of the clock " + std::to_string(speed));
    TicksNode ticks(speed);
    Random random(7);
    std::vector<Stream> streams{{"a", 100.0}, {"b", 50.0}, {"c", 30.0}, {"d", 50.0, 0.6}};
    const ros::Time begin = ticks.transforms().now() + ros::Duration(0.2);
    const ros::Duration slack(0.02 * speed);  // the clock may reach the node later than the transforms
    std::vector<double> expected;
    for (const Sent& sent : sendingsOf(streams, 1.5, random)) {
      ticks.waitUntilClock(begin + ros::Duration(sent.arrival) + slack);
      Stream& stream = streams[sent.stream];
      stream.newest = std::max(stream.newest, sent.stamp);
      ticks.transforms().send({stamped("base", stream.frame, at(0.0), begin + ros::Duration(sent.stamp))});
      const double common = commonTimeOf(streams);
      if (!expected.empty() && common <= expected.back()) continue;
      expected.push_back(common);
      const auto has_time = [&](const Heard& heard) {
        return !heard.pairs.empty() && std::abs((heard.pairs.back()->world.stamp - begin).toSec() - common) < 1e-6;
      };
      ticks.node().waitUntil("a tick at " + std::to_string(common) + " s", has_time, 9.0);
    }
    EXPECT_GT(expected.size(), 40u);
    EXPECT_EQ(publishedTimes(ticks.node().heard(), begin), rounded(expected));
  }
}

/// Claim: a change of the world waits for no data and no heartbeat. Each request waits for two ticks.
TEST(Ticks, BeginWhenARequestWaits) {
  TicksNode ticks(1.0);
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(ticks.node().setAllowed({}).success);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30)) << "ten heartbeats take 100 s";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
