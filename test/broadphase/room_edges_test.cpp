// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/broadphase/room_edges.h"

#include <gtest/gtest.h>

#include "test/support/buildings.h"

namespace hgrid {
namespace {

double lengthOf(const std::vector<RoomEdge>& edges) {
  double sum = 0.0;
  for (const RoomEdge& edge : edges) sum += (edge.to - edge.from).norm();
  return sum;
}

const Eigen::AlignedBox3d kLarge = test::block(-1e6, -1e6, -1e6, 1e6, 1e6, 1e6);

TEST(RoomEdges, OfABoxAreItsTwelveEdges) {
  const Room room = Room::ofBox("room", test::block(1, 2, 3, 2, 4, 6));
  const std::vector<RoomEdge> edges = edgesOf(room, kLarge);
  EXPECT_EQ(edges.size(), 12u);
  EXPECT_NEAR(lengthOf(edges), 4.0 * (1 + 2 + 3), 1e-4);
  for (const RoomEdge& edge : edges) {
    for (const Eigen::Vector3d& end : {edge.from, edge.to}) {
      EXPECT_TRUE(test::block(1, 2, 3, 2, 4, 6).exteriorDistance(end) < 1e-5) << end.transpose();
    }
  }
}

/// Claim: neither the length of a normal nor a wall that cuts nothing off matters.
TEST(RoomEdges, OfAPrismWithObliqueWalls) {
  Room prism = Room::ofBox("prism", test::block(0, 0, 0, 1, 1, 1));
  prism.walls.push_back({Eigen::Vector3d(3, 3, 0), 4.5});  // x + y <= 1.5
  prism.walls.push_back({Eigen::Vector3d(0, 0, 1), 5.0});
  const std::vector<RoomEdge> edges = edgesOf(prism, kLarge);
  EXPECT_EQ(edges.size(), 15u);
  EXPECT_NEAR(lengthOf(edges), 2.0 * (3.0 + std::sqrt(0.5)) + 5.0, 1e-4);
}

TEST(RoomEdges, OfAnOpenRoomAreCutOff) {
  const Room yard{"yard", {{Eigen::Vector3d::UnitX(), 0.0}}};
  const std::vector<RoomEdge> edges = edgesOf(yard, test::block(-1, -1, -1, 5, 1, 1));
  EXPECT_EQ(edges.size(), 12u);
  EXPECT_NEAR(lengthOf(edges), 4.0 * (1 + 2 + 2), 1e-4);
}

TEST(RoomEdges, OfARoomWithoutSpaceAreNone) {
  Room inside_out;
  for (const RoomWall& wall : Room::ofBox("", test::block(0, 0, 0, 1, 1, 1)).walls)
    inside_out.walls.push_back({-wall.normal, -wall.offset});
  EXPECT_TRUE(edgesOf(inside_out, kLarge).empty());
  EXPECT_TRUE(edgesOf(Room::ofBox("far", test::block(5, 5, 5, 6, 6, 6)), test::block(0, 0, 0, 1, 1, 1)).empty());
}

}  // namespace
}  // namespace hgrid
