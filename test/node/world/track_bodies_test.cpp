// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests the bodies of tracks in the world: pairs, states, completeness and events. It needs no ROS master.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "src/node/audit/audit.h"
#include "test/node/audit/audited_world.h"
#include "test/node/support/simulated_world.h"
#include "test/node/tracks/tracker_messages.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {
namespace {

using Reported = std::vector<std::pair<std::string, double>>;
using Lines = std::vector<std::string>;

Params withPeople(Params params = Params{}, TrackerType type = TrackerType::markers) {
  params.trackers = {people(type)};
  params.late_after = 0.1;
  return params;
}

/// Stands for the thread that reads a tracker: it takes reports and puts all tracks into the world.
class Reports {
 public:
  Reports(SimulatedWorld& world, bool simulated = false)
      : world_(world), list_(world.params().trackers[0], 2.0, world.params(), simulated) {}

  void take(const Reported& xs, double delay = 0.0) {
    TrackReport report;
    report.arrival = world_.moment();
    report.stamp = report.arrival.ros - s(delay);
    report.has_ids = true;
    for (const auto& [id, x] : xs) {
      report.poses.push_back({id, "", report.stamp, Pose(Eigen::Translation3d(x, 0.0, 0.0))});
    }
    list_.take(report, placed(report), report.arrival);
    put();
  }
  void refuse(const std::string& why) {
    list_.noteRefused(why);
    put();
  }
  /// Does what the thread does all the time.
  void forget() {
    if (list_.forget(world_.moment())) put();
  }

 private:
  void put() { world_.world().setTracks("people", std::make_shared<const TrackSet>(list_.set())); }

  SimulatedWorld& world_;
  TrackList list_;
};

/// A world with an obstacle "cart", which follows its frame, and a tracker of people.
class TracksOf : public ::testing::Test {
 protected:
  /// Makes a tick after the cart was placed at x = 0.
  const Snapshot& tick() {
    reports_.forget();
    world_.sendNow("/driver", "base", "cart", 0.0);
    for (const PairEvent& event : world_.tick().snapshot->events()) {
      const BodyList& bodies = world_.snapshot().structureOf(event).bodies;
      events_.push_back(std::string(event.kind == EventKind::begin ? "BEGIN " : "END ") +
                        (event.cause == EventCause::bodies      ? "BODIES "
                         : event.cause == EventCause::staleness ? "STALENESS "
                                                                : "other ") +
                        bodies[event.first].name + "|" + bodies[event.second].name);
    }
    return world_.snapshot();
  }
  /// Makes ticks for this long. The tracker reports the same all the time.
  void report(double duration, const Reported& xs) {
    for (long left = std::lround(10.0 * duration); left > 0; --left) {
      world_.wait(0.1);
      reports_.take(xs);
      tick();
    }
  }
  const BodyPose& pose(const std::string& track) {
    return world_.snapshot().poses()[world_.snapshot().structure().find("track/people/" + track)];
  }
  bool has(const std::string& track) {
    return world_.snapshot().structure().find("track/people/" + track) != Structure::kNone;
  }
  Lines incomplete() { return world_.snapshot().incompleteSources(); }
  std::string reason() { return world_.snapshot().reasonOf("track/people"); }

  SimulatedWorld world_{{"cart"}, SimulatedWorld::Clock::wall, withPeople()};
  Reports reports_{world_};
  Lines events_;
};

TEST_F(TracksOf, ATrackerAreBodiesWithItsShapeAtTheReportedPose) {
  reports_.take({{"7", 0.45}, {"legs/8", 5.0}}, 0.05);
  const Snapshot& snapshot = tick();
  const std::uint32_t index = snapshot.structure().find("track/people/7");
  ASSERT_NE(index, Structure::kNone);
  const Body& body = snapshot.structure().bodies[index];
  EXPECT_EQ(body.kind, BodyKind::track);
  EXPECT_EQ(body.max_speed, 2.0);
  ASSERT_EQ(body.shapes.size(), 1u);
  EXPECT_EQ(body.shapes[0].shape.kind(), ShapeKind::capsule);
  EXPECT_TRUE(body.shapes[0].solid) << "its distances can be measured";
  EXPECT_EQ(sourceOf(body), "track/people");
  EXPECT_EQ(pose("7").world_from_body.translation().x(), 0.45);
  EXPECT_EQ(pose("7").stamp, world_.moment().ros - s(0.05));
  EXPECT_NEAR(pose("7").age, 0.05, 1e-9);
  EXPECT_EQ(pose("7").state, Freshness::fresh);
  EXPECT_EQ(incomplete(), Lines());
  EXPECT_EQ(events_, Lines({"BEGIN BODIES obstacle/cart|track/people/7"}));
  EXPECT_EQ(world_.sphere(0.45, 0.1), Verdict::hit);
  EXPECT_EQ(world_.sphere(2.5, 0.1), Verdict::clear);
}

TEST_F(TracksOf, ATrackerMoveWithItsReports) {
  reports_.take({{"7", 0.45}});
  tick();
  world_.wait(0.1);
  reports_.take({{"7", 3.0}});
  tick();
  EXPECT_EQ(pose("7").world_from_body.translation().x(), 3.0);
  EXPECT_EQ(world_.sphere(0.45, 0.1), Verdict::clear);
}

/// Claim: a pose that was measured after the time of the tick has its own stamp. So the time until a contact is
/// possible is counted from before the pose.
TEST_F(TracksOf, ATrackerThatIsNewerThanTheTickHaveTheStampsOfTheirReports) {
  world_.sendNow("/driver", "base", "cart", 0.0);
  world_.wait(0.04);
  reports_.take({{"7", 3.0}}, 0.01);
  world_.tick();
  EXPECT_EQ(pose("7").stamp, world_.moment().ros - s(0.01));
  EXPECT_GT(pose("7").stamp, world_.snapshot().stamp());
}

/// Claim: a track that is no longer reported grows old, is LOST after ~lost_after, and ends after `forget` with an
/// event. Meanwhile its margins grow by its speed limit.
TEST_F(TracksOf, ATrackThatIsNoLongerReportedAreLostAndThenEnd) {
  report(0.5, {{"1", 1.2}, {"2", 9.0}});
  EXPECT_EQ(events_, Lines());
  report(0.5, {{"2", 9.0}});
  EXPECT_EQ(pose("1").state, Freshness::stale);
  EXPECT_EQ(pose("2").state, Freshness::fresh);
  EXPECT_EQ(events_, Lines({"BEGIN STALENESS obstacle/cart|track/people/1"})) << "0.8 m apart, after 0.5 s at 2 m/s";
  EXPECT_EQ(incomplete(), Lines());
  report(1.6, {{"2", 9.0}});
  EXPECT_EQ(pose("1").state, Freshness::lost);
  EXPECT_EQ(incomplete(), Lines({"track/people"}));
  EXPECT_NE(reason().find("LOST track/people/1: its pose is 2.1 s old"), std::string::npos) << reason();
  EXPECT_EQ(world_.sphere(5.0, 0.1), Verdict::unknown) << "it can be anywhere within its speed limit";
  EXPECT_EQ(world_.sphere(30.0, 0.1), Verdict::clear);
  report(4.7, {{"2", 9.0}});
  EXPECT_TRUE(has("1"));
  report(0.5, {{"2", 9.0}});
  EXPECT_FALSE(has("1"));
  EXPECT_EQ(events_.back(), "END BODIES obstacle/cart|track/people/1");
  EXPECT_EQ(incomplete(), Lines());
  EXPECT_EQ(world_.sphere(5.0, 0.1), Verdict::clear);
}

TEST_F(TracksOf, ATrackThatIsReportedAgainAreFreshAgain) {
  report(0.3, {{"1", 1.2}});
  report(3.0, {});
  EXPECT_EQ(pose("1").state, Freshness::lost);
  report(0.1, {{"1", 1.2}});
  EXPECT_EQ(pose("1").state, Freshness::fresh);
  EXPECT_EQ(events_.back(), "END STALENESS obstacle/cart|track/people/1");
}

/// Claim: a tracker that does not publish is an incomplete source. An empty message is a complete set without tracks.
TEST_F(TracksOf, ATrackerThatIsSilentAreNotComplete) {
  tick();
  EXPECT_EQ(incomplete(), Lines({"track/people"}));
  EXPECT_NE(reason().find("NOT_READY tracker 'people': no visualization_msgs/MarkerArray has arrived on people yet"),
            std::string::npos)
      << reason();
  EXPECT_EQ(world_.sphere(5.0, 0.1), Verdict::unknown);
  report(0.3, {});
  EXPECT_EQ(incomplete(), Lines());
  EXPECT_EQ(world_.sphere(5.0, 0.1), Verdict::clear);
  world_.wait(2.2);
  tick();
  EXPECT_EQ(incomplete(), Lines({"track/people"}));
  EXPECT_NE(reason().find("LOST track/people: its newest usable message is 2.2 s old"), std::string::npos) << reason();
  EXPECT_EQ(world_.sphere(500.0, 0.1), Verdict::unknown) << "new persons can be anywhere";
}

TEST_F(TracksOf, ATrackerWhoseMessageIsRefusedStayAndAreNotComplete) {
  reports_.refuse("LIMIT first");
  tick();
  EXPECT_NE(reason().find("no message could be used yet (LIMIT first)"), std::string::npos) << reason();
  report(0.3, {{"1", 1.2}});
  reports_.refuse("NONFINITE marker '3'");
  tick();
  EXPECT_TRUE(has("1"));
  EXPECT_EQ(pose("1").state, Freshness::fresh);
  EXPECT_EQ(incomplete(), Lines({"track/people"}));
  EXPECT_NE(reason().find("could not be used (NONFINITE marker '3')"), std::string::npos) << reason();
  EXPECT_EQ(world_.sphere(500.0, 0.1), Verdict::unknown);
  world_.wait(0.3);
  tick();
  EXPECT_EQ(pose("1").state, Freshness::stale) << "it grows old meanwhile";
  report(0.1, {{"1", 1.2}});
  EXPECT_EQ(incomplete(), Lines());
}

TEST_F(TracksOf, ATrackerForWhichTheWorldHasNoRoomAreNotComplete) {
  Params params = withPeople();
  params.max_bodies = 3;
  SimulatedWorld small({"cart"}, SimulatedWorld::Clock::wall, params);
  small.sendNow("/driver", "base", "cart", 0.0);
  small.tick();
  Reports reports(small);
  reports.take({{"1", 1.0}, {"2", 2.0}, {"3", 3.0}});
  EXPECT_NE(small.tick().snapshot->reasonOf("track/people").find("has no room for its tracks (LIMIT"),
            std::string::npos);
  EXPECT_EQ(small.counter("track/people.unplaced.LIMIT"), 1u);
  reports.take({{"1", 1.0}, {"2", 2.0}});
  EXPECT_EQ(small.tick().snapshot->incompleteSources(), Lines({"track/people"})) << "1, 2 and 3 are still LATE at most";
  small.wait(8.0);
  reports.take({{"4", 4.0}});
  small.sendNow("/driver", "base", "cart", 0.0);
  EXPECT_EQ(small.tick().snapshot->incompleteSources(), Lines());
  EXPECT_NE(small.snapshot().structure().find("track/people/4"), Structure::kNone);
}

TEST_F(TracksOf, ATrackerAreFrozenWhileTheClockStandsStill) {
  SimulatedWorld world({"cart"}, SimulatedWorld::Clock::simulated, withPeople());
  Reports reports(world, true);
  reports.take({{"1", 1.0}});
  world.sendNow("/driver", "base", "cart", 0.0);
  world.tick();
  const double stopped = world.now();
  for (int i = 0; i < 10; ++i) {
    world.wait(0.1);
    world.setRosClock(stopped);
    world.tick();
  }
  const Snapshot& snapshot = world.snapshot();
  EXPECT_EQ(snapshot.poses()[snapshot.structure().find("track/people/1")].state, Freshness::frozen);
  EXPECT_NE(snapshot.reasonOf("track/people").find("FROZEN"), std::string::npos);
}

TEST_F(TracksOf, ATrackerAreNoRequiredBodiesOfOthers) {
  Params params = withPeople();
  params.required = {"track/people/7", "track/carts/*"};
  SimulatedWorld world({"cart"}, SimulatedWorld::Clock::wall, params);
  Reports(world).take({{"7", 1.0}});
  world.sendNow("/driver", "base", "cart", 0.0);
  EXPECT_EQ(world.tick().snapshot->incompleteSources(), Lines({"track/carts"}));
}

/// Claim: the audit finds no difference in a world with tracks, whatever the tracks do.
TEST(AuditedTracks, MakeNoDifference) {
  AuditedWorld world(5, withPeople(AuditedWorld::defaults()));
  Reports reports(world.world());
  for (int i = 0; i < 200; ++i) {
    Reported reported;
    for (int id = 0; id < 4; ++id) {
      if (world.random().chance(0.3)) reported.emplace_back(std::to_string(id), world.random().uniform(-1.0, 1.0));
    }
    if (world.random().chance(0.7)) reports.take(reported, world.random().uniform(0.0, 0.2));
    if (world.random().chance(0.02)) world.world().wait(world.random().uniform(0.0, 9.0));
    reports.forget();
    world.step();
    const AuditFindings findings = audit(world.audited(), 1);
    ASSERT_EQ(findings.differences, Lines()) << "tick " << i;
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
