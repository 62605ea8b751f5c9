// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/Verdict.h>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/simulated_clock.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

/// Tests with a simulated clock: the launch file sets /use_sim_time to true. A robot has two moving spheres that are
/// near each other. The obstacle "post" does not move.
class Clock : public ::testing::Test {
 protected:
  explicit Clock() : clock_(1000.0), transforms_([this] { return clock_.now(); }), node_(setup()) {
    stream();
    node_.waitForComplete();
  }
  static NodeSetup setup() {
    NodeSetup setup;
    setup.params = dict({{"obstacles", list({ball("post", 2, 0, 0, 0.1)})}, {"valid_for", 0.1}});
    setup.beside["robot_description"] = balls({"a", "b"});
    return setup;
  }
  void stream() {
    transforms_.stream("base", "a", at(0));
    transforms_.stream("base", "b", at(0.25));
  }
  void stop() {
    transforms_.stop("a");
    transforms_.stop("b");
    node_.waitForTicks(2);  // after these ticks, the node has received all transforms
  }
  void expectTheObstacleServes() {
    EXPECT_EQ(node_.sphere(2, 0, 0, 0.05).answer.verdict, msg::Verdict::HIT);
    EXPECT_EQ(namesOf(node_.sphere(0, 0, 0, 0.05).answer), std::vector<std::string>({"robot/a"}));
    EXPECT_EQ(node_.sphere(50, 0, 0, 0.05).answer.verdict, msg::Verdict::UNKNOWN);
  }

  SimulatedClock clock_;
  TransformSource transforms_;
  NodeUnderTest node_;
};

TEST_F(Clock, AgesAreInItsTime) {
  const auto status = node_.heard().status.back();
  EXPECT_GE(status->made.toSec(), 1000.0);
  EXPECT_LT(status->made.toSec(), 2000.0);
  EXPECT_LE(status->header.stamp, status->made);
  EXPECT_NEAR((status->world.valid_until - status->made).toSec(), 0.1, 1e-6);
}

TEST_F(Clock, AJumpBackBeginsAnEpochInWhichNothingIsFreshUntilNewTransformsArrive) {
  for (const double back : {90.0, 90.0, 1.0}) {
    SCOPED_TRACE(back);
    const auto before = node_.heard().status.back()->world;
    stop();
    clock_.set(clock_.now().toSec() - back);
    const auto status =
        node_.waitForStatus("a new epoch", [&](const msg::Status& s) { return s.world.epoch != before.epoch; });
    EXPECT_EQ(status->world.sequence, 1u);
    EXPECT_EQ(stateOf(*status, "robot/a"), msg::BodyState::FROZEN);
    EXPECT_EQ(entryOf(*status, "robot/a")->code.name, "UNKNOWN_FRAME");
    EXPECT_FALSE(status->world.complete);
    EXPECT_EQ(status->body_count, 4u);
    expectTheObstacleServes();

    const auto resumed = std::chrono::steady_clock::now();
    stream();
    node_.waitForComplete();
    EXPECT_LT(std::chrono::steady_clock::now() - resumed, std::chrono::seconds(2));
    EXPECT_EQ(node_.sphere(50, 0, 0, 0.05).answer.verdict, msg::Verdict::CLEAR);
    EXPECT_EQ(namesOf(*node_.heard().pairs.back()), std::vector<std::string>({"robot/a|robot/b"}));
  }
  EXPECT_TRUE(says(node_.output(), "ROS time jumped back; a new epoch begins"));
}

TEST_F(Clock, AJumpAheadMakesEverythingOldAtOnce) {
  const auto before = node_.heard().status.back()->world;
  stop();
  clock_.set(clock_.now().toSec() + 1000.0);
  const auto status =
      node_.waitForStatus("a new epoch", [&](const msg::Status& s) { return s.world.epoch != before.epoch; });
  for (const char* body : {"robot/a", "robot/b"}) {
    EXPECT_GE(stateOf(*status, body), msg::BodyState::STALE);
    ASSERT_NE(entryOf(*status, body), nullptr);
    EXPECT_GT(entryOf(*status, body)->age, 999.0);
  }
  EXPECT_FALSE(status->world.complete);
  expectTheObstacleServes();
  stream();
  node_.waitForComplete();
  EXPECT_EQ(
      node_.waitForStatus("all bodies are FRESH", [](const msg::Status& s) { return s.bodies_total == 0; })->body_count,
      4u);
}

TEST_F(Clock, AClockThatStandsStillIsReportedAndTicksGoOn) {
  clock_.run(false);
  const auto status = node_.waitForStatus(
      "robot/a is FROZEN", [](const msg::Status& s) { return stateOf(s, "robot/a") == msg::BodyState::FROZEN; });
  EXPECT_EQ(entryOf(*status, "robot/a")->code.name, "CLOCK");
  EXPECT_TRUE(says(entryOf(*status, "robot/a")->code.text, "the clock stands still"));
  EXPECT_FALSE(status->world.complete);
  EXPECT_EQ(status->world.worst_state, msg::BodyState::FROZEN);
  node_.waitForTicks(10);
  const auto later = node_.heard().status.back();
  EXPECT_GE(later->world.sequence, status->world.sequence + 10);
  EXPECT_EQ(later->made, status->made);
  EXPECT_EQ(later->world.epoch, status->world.epoch);
  EXPECT_GT(later->world.max_age, status->world.max_age) << "ages are measured by the steady clock";
  expectTheObstacleServes();
  node_.waitUntil("/diagnostics while the clock stands still", [](const Heard& all) {
    const auto found = all.diagnostics.find("world");
    return found != all.diagnostics.end() && found->second.message.find("FROZEN") != std::string::npos;
  });

  clock_.run(true);
  node_.waitForComplete();
}

TEST(NoClock, WithoutAnyTimeThereIsNoWorldAndServicesSaySo) {
  NodeSetup setup;
  setup.params = dict({{"world_frame", "base"}, {"obstacles", list({ball("post", 2, 0, 0, 0.1)})}});
  setup.beside["robot_description"] = balls({"a", "b"});
  NodeUnderTest node(setup);
  node.waitForTicks(5);
  const auto status = node.heard().status.back();
  EXPECT_TRUE(oneSays(status->not_ready,
                      "NOT_READY: there is no time yet; /use_sim_time is set, but nothing is published on /clock"));
  EXPECT_TRUE(oneSays(status->world.reasons, "there is no time yet"));
  EXPECT_FALSE(status->world.complete);
  EXPECT_EQ(status->world.sequence, 0u);
  EXPECT_TRUE(node.heard().pairs.back()->first.empty());
  const auto answer = node.sphere(2, 0, 0, 0.05).answer;
  EXPECT_FALSE(answer.success);
  EXPECT_EQ(answer.code.name, "NOT_READY");
  EXPECT_EQ(answer.verdict, msg::Verdict::UNKNOWN);
  EXPECT_TRUE(node.reset().success);

  SimulatedClock clock(500.0);
  TransformSource transforms([&] { return clock.now(); });
  transforms.stream("base", "a", at(0));
  transforms.stream("base", "b", at(0.25));
  node.waitForComplete();
}

}  // namespace
}  // namespace test
}  // namespace hgrid
