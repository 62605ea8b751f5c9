// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests OctoMaps that arrive on topics.
#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/Verdict.h>

#include "test/node/sources/room_map.h"
#include "test/node/support/built.h"
#include "test/node/support/raw_message.h"

namespace hgrid {
namespace test {
namespace {

using msg::Answer;

/// Returns the bytes of a message of octomap_server, from octomap_binary if `binary` is true, else from octomap_full.
std::string messageOf(const std::string& frame, const std::string& nodes, const std::string& id = "OcTree",
                      bool binary = true) {
  return bytesOf(std::uint32_t{7}) + bytesOf(std::uint64_t{0}) + stringOf(frame) +
         std::string(1, binary ? '\1' : '\0') + stringOf(id) + bytesOf(0.1) + stringOf(nodes);
}
std::string nodesOfRow(int count) {
  const std::string file = rowOf(count), mark = "data\n";
  return file.substr(file.find(mark) + mark.size());
}

/// Tests with a map that arrives on a topic.
class MapTopics : public Maps {
 protected:
  MapTopics() {
    start(list({dict({{"name", "room"}, {"topic", "octomap_binary"}})}));
    publisher_ = ros_.advertise<OctomapBytes>(node_->space() + "/octomap_binary", 1, true);
  }
  void send(const std::string& bytes) { publisher_.publish(OctomapBytes{bytes}); }
  void waitForRefusals(const std::string& code, std::uint64_t count) {
    node_->waitForStatus("a refusal",
                         [&](const msg::Status& status) { return counter(status, "maps.refused." + code) >= count; });
    EXPECT_EQ(metAt(0.05), Names({"map/room"})) << "the old map is still used";
  }

  ros::NodeHandle ros_;
  ros::Publisher publisher_;
};

TEST_F(MapTopics, ComeWithTheTypeNameOfOctomapServerAndFollowTheirFrame) {
  node_->waitForStatus("the missing map is reported", [](const msg::Status& status) {
    return !status.world.reasons.empty() &&
           status.world.reasons[0].find("NOT_READY map 'room': no message has arrived on") == 0;
  });
  transforms_.stream("base", "odom", at(1.0));
  send(messageOf("odom", nodesOfRow(1)));
  node_->waitForComplete();
  EXPECT_EQ(metAt(1.05), Names({"map/room"}));
  transforms_.stream("base", "odom", at(2.0));  // the map moves with its frame and is not read again
  node_->waitForTicks(20);
  EXPECT_EQ(metAt(2.05), Names({"map/room"}));
  EXPECT_EQ(metAt(1.05), Names());
  send(messageOf("odom", nodesOfRow(5)));
  node_->waitUntil("the longer row", [&](const Heard&) { return !metAt(2.45).empty(); });
}

TEST_F(MapTopics, MayHaveProbabilitiesAndColors) {
  const std::string color("\x10\x20\x30", 3);
  const auto octants = [&](float log_odds, const std::string& between) {  // a root node whose last child is a leaf
    return otNode(0.0f, 0).substr(0, 4) + between + '\x80' + otNode(log_odds, 0).substr(0, 4) + between + '\0';
  };
  send(messageOf("", octants(2.0f, ""), "OcTree", false));
  node_->waitForComplete();
  EXPECT_EQ(node_->sphere(5, 5, 5, 0.1).answer.verdict, msg::Verdict::HIT);
  send(messageOf("", octants(-2.0f, ""), "OcTree", false));
  node_->waitUntil("the octant is free",
                   [&](const Heard&) { return node_->sphere(5, 5, 5, 0.1).answer.verdict == msg::Verdict::CLEAR; });
  send(messageOf("", octants(2.0f, color), "ColorOcTree", false));
  node_->waitUntil("the octant is occupied",
                   [&](const Heard&) { return node_->sphere(5, 5, 5, 0.1).answer.verdict == msg::Verdict::HIT; });
}

TEST_F(MapTopics, StayWhereTheyAreWhenTheirFrameIsLostOrTheNextOneIsUnknown) {
  transforms_.stream("base", "odom", at(1.0));
  send(messageOf("odom", nodesOfRow(1)));
  node_->waitForComplete();
  EXPECT_EQ(counter(*node_->heard().status.back(), "maps.unstamped"), 1u) << "a map needs no stamp, but it is counted";
  send(messageOf("nowhere", nodesOfRow(5)));
  node_->waitForStatus("a refusal",
                       [](const msg::Status& status) { return counter(status, "maps.refused.UNKNOWN_FRAME") > 0; });
  EXPECT_EQ(metAt(1.05), Names({"map/room"})) << "the old map stays";
  node_->waitForStatus("the map is not complete",
                       [](const msg::Status& status) { return status.world.incomplete == Names({"map/room"}); });
  transforms_.stop("odom");
  const auto stale = [](std::uint8_t state) {
    return [state](const msg::Status& status) {
      return !status.bodies.empty() && status.bodies[0].name == "map/room" && status.bodies[0].state == state;
    };
  };
  node_->waitForStatus("it is STALE", stale(msg::BodyState::STALE));
  EXPECT_EQ(metAt(1.05), Names({"map/room"}));
  node_->waitForStatus("it is LOST", stale(msg::BodyState::LOST));
  EXPECT_EQ(metAt(1.05), Names({"map/room"})) << "a LOST map is never dropped";
  EXPECT_EQ(node_->sphere(-3, -3, -3, 0.1).answer.verdict, msg::Verdict::UNKNOWN);
  transforms_.stream("base", "nowhere", at(2.0));
  node_->waitUntil("the second map after a retry", [&](const Heard&) { return metAt(2.45) == Names({"map/room"}); });
  node_->waitForComplete();
}

TEST_F(MapTopics, WhoseNewestMessageWasRefusedAreNotCompleteAndKeepTheirCells) {
  send(messageOf("", nodesOfRow(1)));
  node_->waitForComplete();
  EXPECT_EQ(node_->sphere(3, 3, 3, 0.1).answer.verdict, msg::Verdict::CLEAR);
  send(messageOf("", ""));
  const auto status = node_->waitForStatus(
      "the map is not complete", [](const msg::Status& now) { return now.world.incomplete == Names({"map/room"}); });
  EXPECT_TRUE(says(status->world.reasons.at(0), "REFUSED 'map/room': its newest message could not be used (PARSE"));
  const auto source = std::find_if(status->sources.begin(), status->sources.end(),
                                   [](const msg::SourceStatus& one) { return one.name == "map/room"; });
  ASSERT_NE(source, status->sources.end());
  EXPECT_FALSE(source->complete);
  EXPECT_EQ(source->state, msg::BodyState::FRESH);
  EXPECT_TRUE(says(source->reason, "PARSE"));
  EXPECT_EQ(metAt(0.05), Names({"map/room"})) << "the old cells are still used";
  const Answer answer = node_->sphere(3, 3, 3, 0.1).answer;
  EXPECT_EQ(answer.verdict, msg::Verdict::UNKNOWN);
  EXPECT_TRUE(says(answer.summary, "REFUSED 'map/room'"));
  send(messageOf("", nodesOfRow(5)));
  node_->waitForComplete();
  EXPECT_EQ(node_->sphere(3, 3, 3, 0.1).answer.verdict, msg::Verdict::CLEAR);
}

TEST_F(Maps, ThatMustKeepComingAreNotCompleteWhenTheyStop) {
  start(list({dict({{"name", "room"}, {"topic", "octomap_binary"}, {"max_age", 0.5}})}));
  ros::NodeHandle ros;
  ros::Publisher publisher = ros.advertise<OctomapBytes>(node_->space() + "/octomap_binary", 1);
  const std::string message = messageOf("", nodesOfRow(1));
  node_->waitUntil("the map is complete", [&](const Heard& heard) {
    publisher.publish(OctomapBytes{message});
    return !heard.status.empty() && heard.status.back()->world.complete;
  });
  const auto status = node_->waitForStatus(
      "the map is too old", [](const msg::Status& now) { return now.world.incomplete == Names({"map/room"}); });
  EXPECT_TRUE(says(status->world.reasons.at(0), "at most max_age, 0.5 s, is allowed"));
  EXPECT_EQ(metAt(0.05), Names({"map/room"}));
  EXPECT_EQ(node_->sphere(3, 3, 3, 0.1).answer.verdict, msg::Verdict::UNKNOWN);
}

TEST_F(MapTopics, ThatAnnounceALongMessageAndSendNothingCostOnlyAddressSpace) {
  send(messageOf("", nodesOfRow(1)));
  node_->waitForComplete();
  const auto before = memoryOf(node_->process().pid());
  const std::string output = folder_ / "silent.txt";
  ChildProcess silent({"/usr/bin/python3", HGRID_PROJECT_DIR "/test/node/support/silent_publisher.py",
                       node_->space() + "/octomap_binary", OctomapKind::kType, OctomapKind::kMd5},
                      output, {});
  node_->waitUntil("the announcement", [&](const Heard&) { return hasReserved(node_->process().pid(), before); });
  node_->waitForTicks(10);
  EXPECT_EQ(metAt(0.05), Names({"map/room"}));
  EXPECT_TRUE(costsOnlyAddressSpace(node_->process().pid(), before));
  send(messageOf("", nodesOfRow(5)));
  node_->waitUntil("the map of another publisher", [&](const Heard&) { return !metAt(0.45).empty(); });
}

TEST_F(MapTopics, WithWrongLengthsLeaveTheMapAsItWas) {
  const std::string whole = messageOf("", nodesOfRow(1));
  send(whole);
  node_->waitForComplete();
  const std::size_t before = residentKilobytes(node_->process().pid());
  send(whole.substr(0, 12) + bytesOf(std::uint32_t{0xffffffff}) + "map");  // declares a frame_id of 4 GB
  waitForRefusals("TRUNCATED", 1);
  send(messageOf("", "").substr(0, messageOf("", "").size() - 4) +
       bytesOf(std::uint32_t{0x08000000}));  // declares 134 MB of data
  waitForRefusals("TRUNCATED", 2);
  send(whole.substr(0, 20));
  waitForRefusals("TRUNCATED", 3);
  send(messageOf("", ""));
  waitForRefusals("PARSE", 1);
  send(whole + "x");
  waitForRefusals("TRUNCATED", 4);
  send(messageOf("", nodesOfRow(1), "SemanticOcTree"));
  waitForRefusals("UNSUPPORTED", 1);
  EXPECT_LT(residentKilobytes(node_->process().pid()), before + mostGrowth(4000))
      << "kB: no memory is allocated for wrong lengths";
  EXPECT_TRUE(node_->process().alive());
}

}  // namespace
}  // namespace test
}  // namespace hgrid
