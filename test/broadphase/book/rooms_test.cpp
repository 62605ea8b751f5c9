// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <limits>
#include <type_traits>

#include "hgrid_proximity/broadphase/partitions.h"
#include "hgrid_proximity/broadphase/room_layer.h"
#include "test/support/expectations.h"
#include "test/support/grids.h"

namespace hgrid {
namespace {

using test::Random;

Eigen::AlignedBox3d boxOf(double x0, double y0, double x1, double y1) {
  return {Eigen::Vector3d(x0, y0, 0), Eigen::Vector3d(x1, y1, 3)};
}

/// Two rooms of 4 m x 4 m beside each other, with a wall of 0.2 m between them and a door in it. A third room of the
/// form of a wedge is apart.
Building building() {
  Room wedge = Room::ofBox("wedge", boxOf(20, 0, 24, 4));
  wedge.walls.push_back({Eigen::Vector3d(1, 1, 0), 24.0});
  return Building({Room::ofBox("west", boxOf(0, 0, 4, 4)), Room::ofBox("east", boxOf(4.2, 0, 8.2, 4)), wedge},
                  {{{0, 1}, boxOf(4, 1, 4.2, 2)}});
}

Aabb cube(float x, float y, float half = 0.3f) {
  return {{x - half, y - half, 1 - half}, {x + half, y + half, 1 + half}};
}

bool isEven(const void*, ProxyId first, ProxyId second) { return (first + second) % 2 == 0; }

std::unique_ptr<RoomLayer> layerOf(BroadPhaseType type) {
  return std::make_unique<RoomLayer>(building(), makeBroadPhase({type}));
}

TEST(Rooms, ABoxIsInTheRoomsAndPortalsThatItOverlaps) {
  const Building rooms = building();
  const auto of = [&](const Aabb& box) {
    std::vector<std::uint32_t> found;
    rooms.roomsOf(box, found);
    return found;
  };
  EXPECT_EQ(of(cube(1, 1)), std::vector<std::uint32_t>({0}));
  EXPECT_EQ(of(cube(3.6f, 3)), std::vector<std::uint32_t>({0})) << "it only touches the wall";
  EXPECT_EQ(of(cube(4.1f, 3, 0.05f)), std::vector<std::uint32_t>()) << "it is inside the wall";
  EXPECT_EQ(of(cube(4.1f, 1.5f, 0.05f)), std::vector<std::uint32_t>({0, 1})) << "it is in the door";
  EXPECT_EQ(of(cube(4.1f, 3, 0.3f)), std::vector<std::uint32_t>({0, 1})) << "it reaches through the wall";
  EXPECT_EQ(of(cube(21, 1)), std::vector<std::uint32_t>({2}));
  EXPECT_EQ(of(cube(23.5f, 3.5f)), std::vector<std::uint32_t>()) << "the oblique wall cuts this corner off";
}

// The broad phase below calls its filter with the address of the layer, so a moved layer would leave a wrong address.
static_assert(!std::is_copy_constructible_v<RoomLayer> && !std::is_move_constructible_v<RoomLayer> &&
              !std::is_move_assignable_v<RoomLayer>);

TEST(Rooms, BoxesWithoutACommonRoomAreNoPair) {
  for (const BroadPhaseType type : broadPhaseTypes()) {
    SCOPED_TRACE(name(type));
    const std::unique_ptr<RoomLayer> layer = layerOf(type);
    layer->insert(0, {{3.5f, 3, 1}, {3.9f, 3.4f, 1.5f}});   // in the west
    layer->insert(1, {{4.25f, 3, 1}, {4.6f, 3.4f, 1.5f}});  // in the east
    layer->insert(2, {{3.8f, 3, 1}, {4.1f, 3.4f, 1.5f}});   // in the west and in the wall
    layer->insert(3, {{4.05f, 3, 1}, {4.5f, 3.4f, 1.5f}});  // in the wall and in the east: overlaps 1 and 2
    EXPECT_EQ(test::pairsOf(*layer), test::Pairs({{0, 2}, {1, 3}}));
    layer->move({2, 3}, {{{3.8f, 1.2f, 1}, {4.1f, 1.4f, 1.5f}}, {{4.05f, 1.2f, 1}, {4.5f, 1.4f, 1.5f}}});
    EXPECT_EQ(test::pairsOf(*layer), test::Pairs({{2, 3}})) << "both are in the door";
    layer->update(2, {{4.06f, 3, 1}, {4.1f, 3.4f, 1.5f}});  // inside the wall: nothing is known about it
    layer->update(3, {{4.05f, 3, 1}, {4.5f, 3.4f, 1.5f}});
    EXPECT_EQ(test::pairsOf(*layer), test::Pairs({{1, 3}, {2, 3}}));
    EXPECT_EQ(test::foundBy(*layer, cube(4, 3)).size(), 4u) << "queries find all boxes";
    EXPECT_NO_THROW(layer->checkInvariants());
  }
}

/// Claim: above each type, the layer finds the pairs of a scan that have a common room, also with a filter of the
/// caller, after failed calls, and if some boxes rest or are removed.
TEST(Rooms, TheLayerLeavesOutExactlyTheOtherPairs) {
  const Building rooms = building();
  std::size_t left_out = 0, kept = 0;
  for (const BroadPhaseType type : broadPhaseTypes()) {
    SCOPED_TRACE(name(type));
    Random random(8);
    const std::unique_ptr<RoomLayer> layer = layerOf(type);
    std::vector<Aabb> boxes(80);
    for (int frame = 0; frame < 5; ++frame) {
      for (Aabb& box : boxes) {
        if (frame > 0 && random.chance(0.5)) continue;  // this box rests
        const double size = random.uniform(0.1, 0.9);
        double x = random.uniform(-1, 9);
        if (random.chance(0.5)) {  // one side ends inside the wall, where boxes of both rooms can meet
          x = 4.1 + random.uniform(-0.09, 0.09) + (random.chance(0.5) ? 0.5 : -0.5) * size;
        }
        box = test::boxAround({x, random.uniform(0, 4), 1}, Eigen::Vector3d::Constant(size));
      }
      layer->update(test::allIds(boxes.size()), boxes);
      EXPECT_THROW(layer->update({3, 2}, {boxes[0], boxes[1]}), std::invalid_argument);
      EXPECT_THROW(layer->move({500}, {boxes[0]}), std::invalid_argument);
      EXPECT_THROW(layer->insert(0, boxes[0]), std::invalid_argument);
      const bool odd = frame % 2 != 0;
      layer->setOverlapFilter(odd ? OverlapFilter::of<isEven>(nullptr) : OverlapFilter{});
      test::Pairs expected;
      std::vector<std::uint32_t> a, b, common;
      for (const auto& pair : test::allOverlaps(boxes)) {
        rooms.roomsOf(boxes[pair.first], a);
        rooms.roomsOf(boxes[pair.second], b);
        common.clear();
        std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
        const bool counts = a.empty() || b.empty() || !common.empty();
        (counts ? kept : left_out) += 1;
        if (counts && (!odd || (pair.first + pair.second) % 2 == 0)) expected.push_back(pair);
      }
      ASSERT_EQ(test::pairsOf(*layer), expected);
      ASSERT_NO_THROW(layer->checkInvariants());
      if (frame % 2 == 0) continue;
      layer->update({3, 70}, {boxes[3], boxes[0]});  // removes all boxes but two, of which one rests
      ASSERT_NO_THROW(layer->checkInvariants());
    }
  }
  EXPECT_GT(left_out, 50u);
  EXPECT_GT(kept, 500u);
}

TEST(Rooms, AWrongBuildingIsRefusedByName) {
  const Room hall = Room::ofBox("hall", boxOf(0, 0, 1, 1)), other = Room::ofBox("other", boxOf(2, 0, 3, 1));
  const auto refusal = [](std::vector<Room> rooms, std::vector<Portal> portals) {
    try {
      Building(std::move(rooms), std::move(portals));
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const Eigen::AlignedBox3d door = boxOf(1, 0, 2, 1);
  EXPECT_EQ(refusal({hall, other}, {{{0, 1}, door}}), "accepted");
  EXPECT_NE(refusal({hall, hall}, {}).find("'hall'"), std::string::npos);
  EXPECT_NE(refusal({{"bare", {}}}, {}).find("'bare' has no walls"), std::string::npos);
  EXPECT_NE(refusal({{"odd", {{Eigen::Vector3d::Zero(), 1.0}}}}, {}).find("'odd'"), std::string::npos);
  EXPECT_NE(refusal({{"far", {{Eigen::Vector3d::UnitX(), std::numeric_limits<double>::infinity()}}}}, {}).find("'far'"),
            std::string::npos);
  EXPECT_NE(refusal({hall, other}, {{{0, 2}, door}}).find("portal 0 leads to room 2"), std::string::npos);
  EXPECT_NE(refusal({hall, other}, {{{1, 1}, door}}).find("to itself"), std::string::npos);
  EXPECT_NE(refusal({hall, other}, {{{0, 1}, {}}}).find("portal 0 has an opening"), std::string::npos);
  EXPECT_NE(refusal(std::vector<Room>(Building::kMostRooms + 1, hall), {}).find("4097 rooms"), std::string::npos);
}

}  // namespace
}  // namespace hgrid
