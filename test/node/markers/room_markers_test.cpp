// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests the markers that draw ~rooms and ~doors.
#include "src/node/markers/room_markers.h"

#include <gtest/gtest.h>

#include <set>

#include "test/node/support/settings.h"
#include "test/support/buildings.h"

namespace hgrid {
namespace test {
namespace {

using visualization_msgs::Marker;

Tick tickWithRooms(const std::vector<Room>& rooms, const std::vector<Portal>& doors) {
  Params params;
  params.rooms = rooms;
  params.doors = doors;
  Tick tick;
  tick.world_frame = "world";
  tick.settings = settingsOf(params);
  return tick;
}

/// Returns the box around the lines of the markers of a namespace.
Eigen::AlignedBox3d drawnIn(const std::vector<Marker>& markers, const std::string& name_space) {
  Eigen::AlignedBox3d around;
  for (const Marker& marker : markers) {
    if (marker.ns != name_space) continue;
    for (const geometry_msgs::Point& point : marker.points) around.extend(Eigen::Vector3d(point.x, point.y, point.z));
  }
  return around;
}

TEST(RoomMarkers, DrawTheEdgesAndNamesOfRoomsAndDoors) {
  const auto building = twoRooms();
  const std::vector<Marker> markers = roomMarkers(tickWithRooms(building->rooms(), building->portals()));
  std::set<std::string> texts;
  std::set<std::pair<std::string, int>> ids;
  std::size_t lines = 0;
  for (const Marker& marker : markers) {
    EXPECT_EQ(marker.header.frame_id, "world");
    EXPECT_EQ(marker.action, Marker::ADD);
    EXPECT_TRUE(ids.emplace(marker.ns, marker.id).second) << marker.ns << marker.id;
    if (marker.type == Marker::TEXT_VIEW_FACING) texts.insert(marker.ns + ": " + marker.text);
    lines += marker.points.size() / 2;
  }
  EXPECT_EQ(texts, (std::set<std::string>{"rooms: west", "rooms: east", "doors: west - east"}));
  EXPECT_EQ(lines, 3u * 12u);
  EXPECT_TRUE(drawnIn(markers, "rooms").isApprox(block(-8, -4, -4, 8, 4, 4), 1e-5));
  EXPECT_TRUE(drawnIn(markers, "doors").isApprox(block(-0.25, -0.5, -1, 0.25, 0.5, 1), 1e-5));
}

TEST(RoomMarkers, CutOpenRoomsOff) {
  const std::vector<Room> rooms = {Room::ofBox("hut", block(0, 0, 0, 1, 1, 1)),
                                   {"yard", {{-Eigen::Vector3d::UnitX(), -1.5}}}};
  EXPECT_TRUE(drawnIn(roomMarkers(tickWithRooms(rooms, {})), "rooms").isApprox(block(0, -2, -2, 3, 3, 3), 1e-5));
}

/// Claim: a door is cut off like the rooms, if two open rooms overlap without an end.
TEST(RoomMarkers, CutDoorsOfOpenRoomsOff) {
  const std::vector<Room> rooms = {{"east", {{-Eigen::Vector3d::UnitX(), 0.0}}},
                                   {"west", {{Eigen::Vector3d::UnitX(), 1.0}}}};
  const std::vector<Marker> markers = roomMarkers(tickWithRooms(rooms, {{{0, 1}, block(0, -2e6, -2e6, 1, 2e6, 2e6)}}));
  EXPECT_LT(drawnIn(markers, "doors").sizes().maxCoeff(), 10.0);
  for (const Marker& marker : markers) EXPECT_LT(std::abs(marker.pose.position.y), 10.0);
}

TEST(RoomMarkers, AreNoneWithoutRooms) { EXPECT_TRUE(roomMarkers(tickWithRooms({}, {})).empty()); }

}  // namespace
}  // namespace test
}  // namespace hgrid
