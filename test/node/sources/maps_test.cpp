// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests OctoMaps from files and topics. The node loads, replaces and removes maps. A refused map does no harm.
#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/ClearMap.h>
#include <hgrid_proximity/Distances.h>
#include <hgrid_proximity/LoadOctomap.h>
#include <hgrid_proximity/ShapeKind.h>
#include <hgrid_proximity/Verdict.h>
#include <ros/service.h>
#include <ros/topic.h>
#include <sys/resource.h>
#include <visualization_msgs/MarkerArray.h>

#include <fstream>

#include "test/adapters/octomap_bytes.h"
#include "test/adapters/octomap_oracle.h"
#include "test/adapters/temporary_folder.h"
#include "test/node/support/built.h"
#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/raw_message.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

using msg::Answer;
using Names = std::vector<std::string>;

/// Returns a `.bt` file with a row of `count` cells of 0.1 m. The row begins at the origin and runs along x.
std::string rowOf(int count) {
  std::vector<Voxel> voxels;
  for (int i = 0; i < count; ++i) voxels.push_back({static_cast<std::uint16_t>(32768 + i), 32768, 32768, 0});
  std::sort(voxels.begin(), voxels.end(), [](const Voxel& a, const Voxel& b) { return mortonOf(a) < mortonOf(b); });
  const std::string nodes = binaryNodesOf(voxels);
  const Octomap read = readOctomapData({"OcTree", true, 0.1}, nodes, "the row");
  return "# Octomap OcTree binary file\nid OcTree\nsize " + std::to_string(read.nodes) + "\nres 0.1\ndata\n" + nodes;
}

/// A robot with a sphere of radius 0.1 m at (0.05, 0.05, 0.3) [m], which is 0.1 m above the first cell of the map.
class Maps : public ::testing::Test {
 protected:
  Maps() { folder_.write("row.bt", rowOf(1)); }
  void start(const Value& maps, double rate = 50.0, double history = 2.0) {
    NodeSetup setup;
    setup.params = dict({{"map", dict({{"folder", folder_.path()}})},
                         {"maps", maps},
                         {"margin", 0.15},
                         {"rate", rate},
                         {"history", history}});
    setup.beside["robot_description"] = balls({"a"});
    transforms_.stream("base", "a", at(0.05, 0.05, 0.3));
    node_ = std::make_unique<NodeUnderTest>(setup);
  }
  static Value mapOf(const std::string& name, const std::string& file) {
    return dict({{"name", name}, {"file", file}});
  }
  msg::LoadOctomap::Response load(const std::string& map, const std::string& file, double z = 0.0) {
    msg::LoadOctomap::Request request;
    request.map = map;
    request.file = file;
    request.pose.position.z = z;
    msg::LoadOctomap::Response response;
    if (!ros::service::call(node_->named("load_octomap"), request, response)) throw std::runtime_error("no answer");
    return response;
  }
  msg::ClearMap::Response clear(const std::string& map) {
    msg::ClearMap::Request request;
    request.map = map;
    msg::ClearMap::Response response;
    if (!ros::service::call(node_->named("clear_map"), request, response)) throw std::runtime_error("no answer");
    return response;
  }
  /// Returns the names of the maps that a vertical segment at x [m] hits.
  Names metAt(double x) {
    msg::QuerySegment::Request request;
    request.start.x = request.end.x = x;
    request.start.y = request.end.y = 0.05;
    request.start.z = 2.0;
    request.end.z = -1.0;
    request.exclude = {"robot/*"};
    return namesOf(node_->ask(request).answer);
  }
  void expectRefused(const msg::LoadOctomap::Response& response, const std::string& code, const std::string& words) {
    EXPECT_FALSE(response.success);
    EXPECT_EQ(response.code.name, code);
    EXPECT_TRUE(says(response.code.text, words));
    EXPECT_EQ(metAt(0.05), Names({"map/room"})) << "the old map is still used";
  }

  TemporaryFolder folder_;
  TransformSource transforms_;
  std::unique_ptr<NodeUnderTest> node_;
};

TEST_F(Maps, MakePairsAnswersAndDistances) {
  start(list({mapOf("room", "row.bt")}));
  node_->waitForComplete();
  node_->waitForPairs("a pair of the sphere and the map", [](const msg::Pairs& pairs) {
    return pairs.names == Names({"map/room", "robot/a"}) && std::abs(pairs.gap.at(0) - 0.1) < 1e-6;
  });
  const auto bodies = node_->waitForBodies("the map", [](const msg::Bodies& now) {
    return now.bodies.front().name == "map/room" && now.bodies.front().shapes.size() == 1;
  });
  const msg::Shape& shape = bodies->bodies.front().shapes[0];
  EXPECT_EQ(shape.kind, msg::ShapeKind::CELLS);
  EXPECT_EQ(shape.dimensions, std::vector<double>({0.1, 0.1, 0.1, 0.1}));
  EXPECT_EQ(shape.vertex_count, 1u);
  EXPECT_NEAR(shape.pose.position.z, 0.05, 1e-12);
  EXPECT_EQ(node_->heard().status.back()->gauges.front().name, "cells.map/room");
  EXPECT_EQ(node_->heard().status.back()->gauges.front().value, 1.0);
  const auto distances = ros::topic::waitForMessage<msg::Distances>(node_->named("distances"), ros::Duration(20.0));
  ASSERT_TRUE(distances);
  ASSERT_EQ(distances->distance.size(), 1u);
  EXPECT_NEAR(distances->distance[0], 0.1, 1e-9);
  EXPECT_NEAR(distances->point_on_first[0].z, 0.1, 1e-9) << "the nearest point of the map";
  ASSERT_EQ(distances->cells_end, std::vector<std::uint32_t>({1}));
  EXPECT_NEAR(distances->cell_center[0].z, 0.05, 1e-9);
  EXPECT_NEAR(distances->cell_edge[0], 0.1, 1e-12);
  EXPECT_NEAR(distances->cell_distance[0], 0.1, 1e-9);
  const auto hits = node_->sphere(0.05, 0.05, 0.14, 0.05).answer.hits;
  ASSERT_EQ(hits.size(), 1u);
  EXPECT_EQ(hits[0].name, "map/room");
  EXPECT_NEAR(hits[0].cell_edge, 0.1, 1e-12);
  EXPECT_NEAR(hits[0].center_distance, 0.04, 1e-9);
  EXPECT_EQ(metAt(0.05), Names({"map/room"}));
  EXPECT_EQ(metAt(0.15), Names());
  const auto why = node_->explain("map/room", "robot/a");
  EXPECT_TRUE(why.reported);
  EXPECT_NEAR(why.distance, 0.1, 1e-9);
}

TEST_F(Maps, AreDrawnWhereBodiesAre) {
  folder_.write("long.bt", rowOf(100));  // a row of cells that is 10 m long
  start(list({mapOf("room", "long.bt")}));
  node_->waitForComplete();
  std::vector<visualization_msgs::Marker> cubes;
  std::mutex mutex;
  const ros::Subscriber subscriber = ros::NodeHandle().subscribe<visualization_msgs::MarkerArray>(
      node_->named("markers"), 10, [&](const visualization_msgs::MarkerArray::ConstPtr& array) {
        const std::lock_guard<std::mutex> lock(mutex);
        for (const auto& marker : array->markers) {
          if (marker.ns == "maps") cubes.push_back(marker);
        }
      });
  node_->waitUntil("cubes", [&](const Heard&) {
    const std::lock_guard<std::mutex> lock(mutex);
    return !cubes.empty();
  });
  const std::lock_guard<std::mutex> lock(mutex);
  EXPECT_EQ(cubes[0].type, visualization_msgs::Marker::CUBE_LIST);
  EXPECT_NEAR(cubes[0].scale.x, 0.1, 1e-12);
  EXPECT_GE(cubes[0].points.size(), 10u);
  EXPECT_LE(cubes[0].points.size(), 15u) << "only the cells within 1 m of the sphere";
  EXPECT_NEAR(cubes[0].points[0].x, 0.05, 1e-9);
}

TEST_F(Maps, AreReplacedMovedAndTakenAway) {
  start(list({mapOf("room", "row.bt")}));
  node_->waitForComplete();
  folder_.write("longer.bt", rowOf(5));
  const std::uint64_t revision = node_->heard().status.back()->world.bodies_revision;
  const auto loaded = load("room", "longer.bt");
  ASSERT_TRUE(loaded.success) << loaded.code.text;
  EXPECT_EQ(loaded.occupied_leaves, 5u);
  EXPECT_EQ(loaded.resolution, 0.1);
  EXPECT_EQ(loaded.world.bodies_revision, revision) << "new cells do not change the structure";
  EXPECT_EQ(metAt(0.45), Names({"map/room"}));
  ASSERT_TRUE(load("hall", "row.bt", 1.0).success);
  EXPECT_EQ(metAt(0.05), Names({"map/hall", "map/room"})) << "hits are sorted along the line";
  ASSERT_TRUE(load("room", "longer.bt", -5.0).success) << "the map moves to another place";
  EXPECT_EQ(metAt(0.05), Names({"map/hall"}));
  ASSERT_TRUE(clear("hall").success);
  EXPECT_EQ(metAt(0.05), Names());
  const auto unknown = clear("hall");
  EXPECT_EQ(unknown.code.name, "UNKNOWN_ID");
  ASSERT_TRUE(clear("").success);
  node_->waitForTicks(2);
  EXPECT_EQ(node_->heard().status.back()->body_count, 2u);
}

TEST_F(Maps, ThatCannotBeReadAreRefusedByName) {
  start(list({mapOf("room", "row.bt")}));
  node_->waitForComplete();
  for (const char* file : {"../row.bt", "/etc/passwd", "", ".", "..", ".hidden", "a b.bt", "row.bt\n", "%2e%2e"}) {
    SCOPED_TRACE(file);
    expectRefused(load("room", file), "BAD_ID", "it must be the name of a file in ~map/folder");
  }
  expectRefused(load("room", std::string(65, 'a')), "BAD_ID", "with at most 64 letters");
  expectRefused(load("a/b\n", "row.bt"), "BAD_ID", "the map's name");
  expectRefused(load("room", "nothing.bt"), "RESOURCE_MISSING", "nothing.bt");
  ASSERT_EQ(symlink("/etc/passwd", (folder_ / "link.bt").c_str()), 0);
  expectRefused(load("room", "link.bt"), "RESOURCE_DENIED", "link.bt");
  const std::string whole = rowOf(3);
  folder_.write("cut.bt", whole.substr(0, whole.size() - 1));
  expectRefused(load("room", "cut.bt"), "TRUNCATED", "cut.bt");
  folder_.write("other.bt", "# Octomap OcTree binary file\nid Quadtree\nsize 1\nres 0.1\ndata\n\1\1");
  expectRefused(load("room", "other.bt"), "UNSUPPORTED", "Quadtree");
  msg::LoadOctomap::Request request;
  request.map = "room";
  request.file = "row.bt";
  request.pose.orientation.x = 3.0;
  msg::LoadOctomap::Response response;
  ASSERT_TRUE(ros::service::call(node_->named("load_octomap"), request, response));
  expectRefused(response, "BAD_ROTATION", "the map's pose");
}

TEST_F(Maps, ThatAreMissingAtTheStartLeaveTheWorldIncompleteUntilTheyCome) {
  start(list({mapOf("room", "late.bt")}));
  node_->waitForStatus("the missing map is reported", [](const msg::Status& status) {
    return !status.world.complete && !status.world.reasons.empty() &&
           status.world.reasons[0].find("RESOURCE_MISSING map 'room'") == 0;
  });
  EXPECT_EQ(node_->sphere(3, 3, 3, 0.1).answer.verdict, msg::Verdict::UNKNOWN);
  folder_.write("late.bt", rowOf(1));
  node_->waitForComplete();
  EXPECT_EQ(metAt(0.05), Names({"map/room"}));
}

TEST(MapsBeyondTheLimit, AreReportedAsMissing) {
  const TemporaryFolder folder;
  folder.write("row.bt", rowOf(1));
  NodeSetup setup;
  setup.params = dict({{"map", dict({{"folder", folder.path()}})},
                       {"maps", list({dict({{"name", "room"}, {"file", "row.bt"}})})},
                       {"max_bodies", 2},
                       {"margins", list({dict({{"pattern", "robot/aa"}, {"margin", 0.3}})})}});
  setup.beside["robot_description"] = balls({"a"});
  NodeUnderTest node(setup);
  const auto refused = [](const msg::Status& status, std::uint64_t count) {
    return counter(status, "maps.refused.LIMIT") >= count;
  };
  const auto status =
      node.waitForStatus("the map was refused a second time", [&](const msg::Status& now) { return refused(now, 2); });
  EXPECT_FALSE(status->world.complete);
  bool told = false;
  for (const std::string& reason : status->world.reasons) told = told || reason.find("LIMIT map 'room'") == 0;
  EXPECT_TRUE(told);
  ASSERT_EQ(status->model_warnings.size(), 1u) << "the warning is given although a map is missing";
  EXPECT_TRUE(says(status->model_warnings[0], "~margins: 'robot/aa' matches no body"));
}

TEST_F(Maps, ThatWereMissingDoNotComeBackOnceOthersWereChosen) {
  start(list({mapOf("room", "late.bt"), mapOf("hall", "later.bt")}));
  node_->waitForStatus("only the maps are missing", [](const msg::Status& status) {
    return status.world.reasons.size() == 2 && counter(status, "maps.refused.RESOURCE_MISSING") >= 2;
  });
  const auto loaded = load("room", "row.bt");
  ASSERT_TRUE(loaded.success) << loaded.code.text;
  ASSERT_TRUE(clear("hall").success) << "the node no longer waits for this map";
  node_->waitForComplete();
  folder_.write("late.bt", rowOf(5));
  folder_.write("later.bt", rowOf(5));
  const auto refusals = [](const msg::Status& status) { return counter(status, "maps.refused.RESOURCE_MISSING"); };
  const std::uint64_t before = refusals(*node_->heard().status.back());
  node_->waitForTicks(75);  // 1.5 s, which includes the time of the next try (after 0.5 s)
  EXPECT_EQ(metAt(0.05), Names({"map/room"}));
  EXPECT_EQ(metAt(0.45), Names()) << "the file that appeared later is not read";
  EXPECT_EQ(refusals(*node_->heard().status.back()), before);
}

TEST_F(Maps, ThatCannotBePlacedAreRefused) {
  start(list({mapOf("room", "row.bt")}));
  node_->waitForComplete();
  expectRefused(load("room", "row.bt", 1e9), "OUT_OF_RANGE", "map 'room': its position in its frame");
  EXPECT_TRUE(node_->heard().status.back()->world.complete);
}

TEST_F(Maps, ThatDoNotFitIntoMemoryAreRefused) {
  start(list({mapOf("room", "row.bt")}));
  node_->waitForComplete();
  std::string nodes;
  std::uint64_t count = 1;
  for (int level = Voxel::kLevels; level > 8; --level) nodes += btNode("n......."), ++count;
  const std::function<void(int)> fill = [&](int levels) {  // 8^8 leaves; eight leaves take two bytes
    nodes += btNode(levels > 1 ? "nnnnnnnn" : "oooooooo");
    count += 8;
    for (int child = 0; levels > 1 && child < 8; ++child) fill(levels - 1);
  };
  fill(8);
  folder_.write("full.bt", btHeader(usualLines(std::to_string(count))) + nodes);
  rlimit unlimited{}, tight{};
  const pid_t node = node_->process().pid();
  ASSERT_EQ(prlimit(node, RLIMIT_AS, nullptr, &unlimited), 0);
  tight = unlimited;
  tight.rlim_cur = (virtualKilobytes(node) << 10) + (std::size_t{64} << 20);
  ASSERT_EQ(prlimit(node, RLIMIT_AS, &tight, nullptr), 0);
  expectRefused(load("room", "full.bt"), "LIMIT", "does not fit into the memory that is left");
  ASSERT_EQ(prlimit(node, RLIMIT_AS, &unlimited, nullptr), 0);
  const auto loaded = load("room", "full.bt");
  EXPECT_TRUE(loaded.success) << loaded.code.text;
  EXPECT_EQ(loaded.occupied_leaves, std::uint64_t{1} << 24);
}

TEST_F(Maps, OneThousandReplacementsLeaveNothingBehind) {
  start(list({mapOf("room", "row.bt")}), 500.0, 0.05);  // a longer history would keep hundreds of maps
  node_->waitForComplete();
  std::vector<Voxel> voxels;
  for (std::uint16_t x = 0; x < 30; ++x) {
    for (std::uint16_t y = 0; y < 30; ++y)
      voxels.push_back(
          {static_cast<std::uint16_t>(32768 + 2 * x), static_cast<std::uint16_t>(32768 + 2 * y), 32768, 0});
  }
  std::sort(voxels.begin(), voxels.end(), [](const Voxel& a, const Voxel& b) { return mortonOf(a) < mortonOf(b); });
  const std::string nodes = binaryNodesOf(voxels);
  const Octomap read = readOctomapData({"OcTree", true, 0.1}, nodes, "the field");
  folder_.write("field.bt", "# Octomap OcTree binary file\nid OcTree\nsize " + std::to_string(read.nodes) +
                                "\nres 0.1\ndata\n" + nodes);
  // All requests use one connection. If thousands of calls open one each, roscpp sometimes loses a call.
  ros::ServiceClient loader = ros::NodeHandle().serviceClient<msg::LoadOctomap>(node_->named("load_octomap"), true);
  msg::LoadOctomap call;
  call.request.map = "room";
  std::size_t after_100 = 0;
  for (int i = 1; i <= 1000; ++i) {
    call.request.file = i % 2 == 0 ? "row.bt" : "field.bt";
    ASSERT_TRUE(loader.call(call));
    ASSERT_TRUE(call.response.success);
    if (i == 100) after_100 = residentKilobytes(node_->process().pid());
  }
  EXPECT_LT(residentKilobytes(node_->process().pid()), after_100 + 2000) << "kB";
  EXPECT_EQ(metAt(0.05), Names({"map/room"}));
}

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

TEST_F(Maps, ThatAreRequiredMakeUnknownWhatWasClearWhenTheyAreGone) {
  NodeSetup setup;
  setup.params = dict({{"map", dict({{"folder", folder_.path()}})}, {"required", list({Value("map/hall")})}});
  setup.beside["robot_description"] = balls({"a"});
  transforms_.stream("base", "a", at(0.05, 0.05, 0.3));
  for (int life = 0; life < 2; ++life) {  // the second run begins after the node was killed
    node_ = std::make_unique<NodeUnderTest>(setup);
    node_->waitForStatus("the robot is placed", [](const msg::Status& now) {
      return now.body_count == 2 && now.bodies_total == 0 && now.world.incomplete == Names({"map/hall"});
    });
    const Answer answer = node_->sphere(0.05, 0.05, 0.05, 0.01).answer;
    EXPECT_EQ(answer.verdict, msg::Verdict::UNKNOWN);
    EXPECT_TRUE(says(answer.summary, "REQUIRED 'map/hall'"));
    if (life == 1) break;
    ASSERT_TRUE(load("hall", "row.bt").success);
    node_->waitForComplete();
    EXPECT_EQ(node_->sphere(0.05, 0.05, 0.05, 0.01).answer.verdict, msg::Verdict::HIT);
    node_->process().signal(SIGKILL);
    node_->process().waitForEnd(10.0);
  }
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
