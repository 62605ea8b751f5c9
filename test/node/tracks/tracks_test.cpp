// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests trackers on the wire: their tracks become bodies, and everything that the node received is accounted for.
#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/UnknownReason.h>
#include <hgrid_proximity/Verdict.h>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"
#include "test/node/tracks/tracker_messages.h"

namespace hgrid {
namespace test {
namespace {

using Names = std::vector<std::string>;

Value tracker(const std::string& type) {
  return dict({{"name", "people"},
               {"topic", "people"},
               {"type", type},
               {"shapes", list({dict({{"type", "capsule"}, {"height", 1.0}, {"radius", 0.3}})})},
               {"max_speed", 2.0},
               {"forget", 2.0},
               {"max_tracks", 20}});
}

/// A robot with a sphere of radius 0.1 m at the origin of "base", and a tracker that the test sends messages of.
class Tracks : public ::testing::Test {
 protected:
  /// Starts the node. @param publishes  whether the test will publish what the node expects
  void start(const std::string& type, bool publishes = true) {
    NodeSetup setup;
    // On a busy machine, messages may be late. LOST comes after 1 s, and the track ends 2 s later.
    setup.params = dict({{"tracks", list({tracker(type)})},
                         {"late_after", 1.0},
                         {"stale_after", 1.0},
                         {"lost_after", 1.0},
                         {"audit_rate", 10.0},
                         {"limits/track_queue_bytes", 100000}});
    setup.beside["robot_description"] = balls({"a"});
    transforms_.stream("base", "a", at(0));
    transforms_.stream("base", "eye", at(0.0, 0.0, 1.0));
    node_ = std::make_unique<NodeUnderTest>(setup);
    if (type == "markers") {
      markers_ = ros_.advertise<visualization_msgs::MarkerArray>(node_->space() + "/people", 10000);
    } else if (publishes) {
      poses_ = ros_.advertise<geometry_msgs::PoseArray>(node_->space() + "/people", 10000);
    } else {
      return;
    }
    node_->waitUntil("the node subscribes to the tracker",
                     [&](const Heard&) { return (type == "markers" ? markers_ : poses_).getNumSubscribers() > 0; });
  }
  /// Calls `send` at every tick until `holds` is true for a status.
  void sendUntil(const std::string& what, const std::function<void()>& send,
                 const std::function<bool(const msg::Status&)>& holds) {
    std::uint64_t last = 0;
    node_->waitUntil(what, [&](const Heard& heard) {
      if (heard.status.empty()) return false;
      if (std::exchange(last, heard.status.back()->world.sequence) != last) send();
      return holds(*heard.status.back());
    });
  }
  static bool isComplete(const msg::Status& status) { return status.world.complete != 0; }
  static std::string reasonOf(const msg::Status& status) {
    for (const msg::SourceStatus& source : status.sources) {
      if (source.name == "track/people") return source.complete ? "" : source.reason;
    }
    return "there is no source track/people";
  }
  std::uint64_t counted(const msg::Status& status, const std::string& what) const {
    return counter(status, "track/people." + what);
  }

  TransformSource transforms_;
  ros::NodeHandle ros_;
  std::unique_ptr<NodeUnderTest> node_;
  ros::Publisher markers_, poses_;
};

/// Claim: a person that a tracker reports with markers is a body like any other, until it was LOST for long enough.
TEST_F(Tracks, OfMarkersAreBodiesThatAreLostAndEnd) {
  start("markers");
  node_->waitForStatus("the silent tracker is reported", [](const msg::Status& status) {
    return bool(says(reasonOf(status), "NOT_READY tracker 'people': no visualization_msgs/MarkerArray has arrived"));
  });
  const auto both = [&] {
    markers_.publish(markers({marker(7, 0.3, transforms_.now(), "eye", "legs"), marker(8, 5.0, transforms_.now())}));
  };
  sendUntil("a complete world with a pair", both,
            [](const msg::Status& status) { return isComplete(status) && status.pair_count == 1; });
  node_->waitForPairs("the pair", [](const msg::Pairs& pairs) {
    return pairs.names == Names({"robot/a", "track/people/legs/7"}) && pairs.total == 1;
  });
  const auto bodies = node_->waitForBodies("the tracks", [](const msg::Bodies& now) { return now.bodies.size() >= 4; });
  EXPECT_EQ(bodies->bodies[2].name, "track/people/8");
  EXPECT_EQ(bodies->bodies[2].max_speed, 2.0);
  EXPECT_EQ(bodies->bodies[3].name, "track/people/legs/7");
  EXPECT_EQ(node_->sphere(0.3, 0.0, 1.0, 0.05).answer.verdict, msg::Verdict::HIT) << "placed by the frame 'eye'";
  EXPECT_TRUE(says(node_->explain("robot/a", "track/people/8").explanation, "track/people/8"));
  // The first marker is deleted; the second one is reported on.
  sendUntil(
      "the track is lost",
      [&] {
        markers_.publish(markers({deleting(7, "legs"), marker(8, 5.0, transforms_.now())}));
      },
      [](const msg::Status& status) { return bool(says(reasonOf(status), "LOST track/people/legs/7")); });
  sendUntil(
      "the track has ended", [&] { markers_.publish(markers({marker(8, 5.0, transforms_.now())})); },
      [](const msg::Status& status) { return isComplete(status) && status.pair_count == 0; });
  node_->waitUntil("the event", [](const Heard& heard) {
    return std::any_of(heard.events.begin(), heard.events.end(), [](const msg::Events::ConstPtr& events) {
      const auto told = eventsOf(*events);
      return std::find(told.begin(), told.end(), "2 END BODIES robot/a|track/people/legs/7") != told.end();
    });
  });
}

/// Claim: poses without ids keep their tracks while they move, and an empty array is a complete set.
TEST_F(Tracks, OfPosesKeepTheirIdsAndAnEmptyArrayIsComplete) {
  start("poses");
  sendUntil(
      "a complete world without tracks", [&] { poses_.publish(poses({}, transforms_.now(), "eye")); }, isComplete);
  EXPECT_EQ(node_->sphere(3.0, 0.0, 1.0, 0.05).answer.verdict, msg::Verdict::CLEAR);
  double x = 3.0;
  sendUntil(
      "the person is near the robot",
      [&] {
        poses_.publish(poses({x, 8.0}, transforms_.now(), "eye"));
        x = std::max(0.3, x - 0.05);
      },
      [](const msg::Status& status) { return status.pair_count == 1; });
  const auto pairs = node_->waitForPairs("the pair", [](const msg::Pairs& now) { return now.total == 1; });
  EXPECT_EQ(pairs->names, Names({"robot/a", "track/people/1"})) << "it is still the first track";
}

/// Claim: a message that is refused is counted and makes the tracker incomplete until the next good one. Whatever
/// arrives is applied, refused or dropped.
TEST_F(Tracks, AreAllAccountedForEvenIfTheyAreWrongOrFlood) {
  start("markers");
  const auto good = [&] { return markers({marker(1, 5.0, transforms_.now())}); };
  sendUntil(
      "a complete world", [&] { markers_.publish(good()); }, isComplete);
  std::vector<Marker> many;
  for (int id = 0; id < 500; ++id) many.push_back(marker(id, 9.0, transforms_.now()));
  const std::vector<std::pair<visualization_msgs::MarkerArray, std::string>> wrong{
      {markers({marker(2, std::nan(""), transforms_.now())}), "NONFINITE"},
      {markers({marker(2, 1.0, transforms_.now(), "nowhere")}), "UNKNOWN_FRAME"},
      {markers({marker(2, 1.0, transforms_.now() + ros::Duration(100.0))}), "CLOCK"},
      {markers({marker(2, 1.0, transforms_.now()), marker(2, 1.0, transforms_.now())}), "DUP_ID"},
      {markers(many), "LIMIT"}};
  for (const auto& [message, code] : wrong) {
    SCOPED_TRACE(code);
    markers_.publish(message);
    node_->waitForStatus("it is refused", [&, code = code](const msg::Status& status) {
      return counted(status, "refused." + code) == 1 && says(reasonOf(status), code);
    });
    EXPECT_EQ(node_->sphere(1.0, 0.0, 0.0, 0.05).answer.verdict, msg::Verdict::UNKNOWN);
    sendUntil(
        "a complete world again", [&] { markers_.publish(good()); }, isComplete);
  }
  std::vector<Marker> some(many.begin(), many.begin() + 20);
  const std::uint64_t before = counted(*node_->heard().status.back(), "received");
  for (int i = 0; i < 5000; ++i) markers_.publish(markers(some));
  const auto status = node_->waitForStatus("all messages are handled", [&](const msg::Status& now) {
    std::uint64_t handled = counted(now, "applied") + counted(now, "dropped.LIMIT");
    for (const auto& each : wrong) handled += counted(now, "refused." + each.second);
    return counted(now, "received") == handled && handled > before + 1000;
  });
  EXPECT_EQ(counter(*status, "tick.failed.INTERNAL"), 0u);
  sendUntil(
      "the newest message counts", [&] { markers_.publish(good()); },
      [&](const msg::Status& now) { return isComplete(now) && counted(now, "applied") > counted(*status, "applied"); });
}

/// Claim: roscpp refuses the connection, so the node receives nothing of the wrong type.
TEST_F(Tracks, OfAnotherTypeAreNotRead) {
  start("poses", false);
  markers_ = ros_.advertise<visualization_msgs::MarkerArray>(node_->space() + "/people", 10);
  int left = 50;  // messages, one at each tick: enough time for a connection
  sendUntil(
      "50 messages", [&] { markers_.publish(markers({})); }, [&](const msg::Status&) { return --left <= 0; });
  const auto status = node_->heard().status.back();
  EXPECT_TRUE(says(reasonOf(*status), "NOT_READY tracker 'people': no geometry_msgs/PoseArray has arrived"));
  EXPECT_EQ(counted(*status, "received"), 0u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
