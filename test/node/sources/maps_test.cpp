// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests OctoMaps from files. The node loads, replaces and removes maps. A refused map does no harm.
#include <hgrid_proximity/Distances.h>
#include <hgrid_proximity/ShapeKind.h>
#include <hgrid_proximity/Verdict.h>
#include <ros/topic.h>
#include <sys/resource.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>

#include "test/node/sources/room_map.h"

namespace hgrid {
namespace test {
namespace {

using msg::Answer;

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
                       {"limits/max_bodies", 2},
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

}  // namespace
}  // namespace test
}  // namespace hgrid
