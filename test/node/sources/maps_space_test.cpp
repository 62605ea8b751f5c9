// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests how the node treats space that a map does not know, and cells outside of the crop box of ~map.
#include <gtest/gtest.h>
#include <hgrid_proximity/UnknownReason.h>
#include <hgrid_proximity/UnknownSpace.h>
#include <hgrid_proximity/Verdict.h>

#include "test/adapters/octomap_bytes.h"
#include "test/adapters/octomap_oracle.h"
#include "test/adapters/temporary_folder.h"
#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

using msg::Answer;
using Names = std::vector<std::string>;

/// A robot with a sphere at the origin, and a cubic map with edges of 6553.6 m. In the octant with positive x, y and z
/// the map is free. In the octant with negative x and positive y and z the map is occupied. All other octants are
/// unknown.
class MapSpace : public ::testing::Test {
 protected:
  MapSpace() { folder_.write("octants.bt", btHeader(usualLines("3")) + btNode("......of")); }
  void start(Value map) {
    map["folder"] = folder_.path();
    NodeSetup setup;
    setup.params["map"] = map;
    setup.params["maps"] = list({dict({{"name", "octants"}, {"file", "octants.bt"}})});
    setup.beside["robot_description"] = balls({"a"});
    if (streams_) transforms_.stream("base", "a", at(0));
    node_ = std::make_unique<NodeUnderTest>(setup);
    if (streams_) node_->waitForComplete();
  }
  Answer asked(double x, double y, double z) { return node_->sphere(x, y, z, 0.5).answer; }

  TemporaryFolder folder_;
  TransformSource transforms_;
  bool streams_ = true;  // whether start() publishes the pose of the sphere
  std::unique_ptr<NodeUnderTest> node_;
};

TEST_F(MapSpace, ThatIsUnknownIsFreeUnlessSaidOtherwise) {
  start(dict());
  EXPECT_EQ(asked(10, 10, 10).verdict, msg::Verdict::CLEAR);
  EXPECT_EQ(asked(10, 10, -10).verdict, msg::Verdict::CLEAR);
  EXPECT_EQ(namesOf(asked(-10, 10, 10)), Names({"map/octants"}));
  EXPECT_EQ(node_->heard().status.back()->world.unknown_space, msg::UnknownSpace::IGNORE);
}

TEST_F(MapSpace, ThatIsUnknownIsReported) {
  start(dict({{"unknown", "report"}}));
  EXPECT_EQ(asked(10, 10, 10).verdict, msg::Verdict::CLEAR);
  for (const double z : {-10.0, 0.4, 5000.0}) {
    const Answer answer = asked(10, 10, z);
    EXPECT_EQ(answer.verdict, msg::Verdict::UNKNOWN);
    EXPECT_EQ(answer.unknown_because, msg::UnknownReason::UNMAPPED);
    EXPECT_TRUE(says(answer.summary, "space that no map knows to be free"));
  }
  EXPECT_EQ(asked(-10, 10, 10).verdict, msg::Verdict::HIT);
  EXPECT_EQ(node_->heard().status.back()->world.unknown_space, msg::UnknownSpace::REPORT);
}

TEST_F(MapSpace, ThatIsUnknownIsOccupied) {
  start(dict({{"unknown", "occupied"}}));
  EXPECT_EQ(asked(10, 10, 10).verdict, msg::Verdict::CLEAR);
  EXPECT_EQ(namesOf(asked(10, 10, -10)), Names({"map/octants"}));
  EXPECT_EQ(node_->heard().status.back()->world.unknown_space, msg::UnknownSpace::OCCUPIED);
  node_->waitForPairs("a pair of the sphere and the unknown space", [](const msg::Pairs& pairs) {
    return pairs.names == Names({"map/octants", "robot/a", "robot/base"});
  });
}

TEST_F(MapSpace, OutsideTheCropIsNotRead) {
  folder_.write("octants.bt", btHeader(usualLines("4")) + btNode(".......n") + btNode("o......o"));
  start(dict({{"crop_min", list({1.0, 1.0, 1.0})}, {"crop_max", list({20.0, 20.0, 20.0})}, {"unknown", "report"}}));
  EXPECT_EQ(asked(10, 10, 10).verdict, msg::Verdict::HIT);
  EXPECT_EQ(asked(3000, 3000, 3000).unknown_because, msg::UnknownReason::UNMAPPED)
      << "the occupied cell outside the crop box is not read";
}

TEST_F(MapSpace, TheRobotsOwnCellsAreLeftOutOnceItIsKnownWhereItIs) {
  const std::string nodes =
      binaryNodesOf({{32768, 32768, 32768, 0}, {32778, 32768, 32768, 0}});  // in the sphere, and 1 m away
  const Octomap read = readOctomapData({"OcTree", true, 0.1}, nodes, "the two");
  folder_.write("octants.bt", btHeader(usualLines(std::to_string(read.nodes))) + nodes);
  streams_ = false;
  start(dict({{"self_filter", list({dict({{"pattern", "robot/*"}, {"padding", 0.05}})})}}));
  node_->waitForStatus("the map waits for the pose of the robot", [](const msg::Status& status) {
    return std::any_of(status.world.reasons.begin(), status.world.reasons.end(), [](const std::string& reason) {
      return reason.find("NOT_READY map 'octants': body 'robot/a'") == 0;
    });
  });
  transforms_.stream("base", "a", at(0));
  node_->waitForComplete();
  EXPECT_EQ(namesOf(node_->sphere(0.05, 0.05, 0.05, 0.01).answer), Names({"robot/a"}));
  EXPECT_EQ(namesOf(node_->sphere(1.05, 0.05, 0.05, 0.01).answer), Names({"map/octants"}));
  EXPECT_EQ(counter(*node_->heard().status.back(), "maps.own_cells"), 1u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
