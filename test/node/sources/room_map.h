// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <gtest/gtest.h>
#include <hgrid_proximity/ClearMap.h>
#include <hgrid_proximity/LoadOctomap.h>
#include <ros/service.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "test/adapters/octomap_bytes.h"
#include "test/adapters/octomap_oracle.h"
#include "test/adapters/temporary_folder.h"
#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {

/// Returns a `.bt` file with a row of `count` cells of 0.1 m. The row begins at the origin and runs along x.
inline std::string rowOf(int count) {
  std::vector<Voxel> voxels;
  for (int i = 0; i < count; ++i) voxels.push_back({static_cast<std::uint16_t>(32768 + i), 32768, 32768, 0});
  std::sort(voxels.begin(), voxels.end(), [](const Voxel& a, const Voxel& b) { return mortonOf(a) < mortonOf(b); });
  const std::string nodes = binaryNodesOf(voxels);
  const Octomap read = readOctomapData({"OcTree", true, 0.1}, nodes, "the row");
  return "# Octomap OcTree binary file\nid OcTree\nsize " + std::to_string(read.nodes) + "\nres 0.1\ndata\n" + nodes;
}

using Names = std::vector<std::string>;

/// Tests with a robot, and with the map file row.bt, which has one cell. The robot has a sphere of radius 0.1 m at
/// (0.05, 0.05, 0.3) [m], 0.1 m above this cell.
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

}  // namespace test
}  // namespace hgrid
