// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "src/node/params/params.h"
#include "src/node/params/yaml_value.h"
#include "test/node/support/values.h"

namespace hgrid {
namespace test {
namespace {

Value poseAt(double x, double y, double z) { return dict({{"xyz", xyz(x, y, z)}}); }

/// Two rooms whose wall is from x = 4.0 to 4.2 [m], and a door in it.
Value hall() { return dict({{"name", "hall"}, {"pose", poseAt(2, 2, 1.5)}, {"size", xyz(4, 4, 3)}}); }
Value cell() { return dict({{"name", "cell"}, {"pose", poseAt(6.2, 2, 1.5)}, {"size", xyz(4, 4, 3)}}); }
Value door() {
  return dict({{"rooms", list({"hall", "cell"})}, {"pose", poseAt(4.1, 2, 1)}, {"size", xyz(0.2, 1, 2)}});
}
Value wall(double x, double y, double z, double offset) { return dict({{"normal", xyz(x, y, z)}, {"offset", offset}}); }

Value paramsWith(const Value& rooms, const Value& doors) { return dict({{"rooms", rooms}, {"doors", doors}}); }

/// Returns the error message; empty if the parameters are accepted.
std::string errorsOfRooms(const Value& rooms, const Value& doors) {
  try {
    readParams(paramsWith(rooms, doors));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}
void expectRoomRefused(const Value& room, const std::string& sentence) {
  EXPECT_EQ(errorsOfRooms(list({room}), list()), "1 parameter is wrong:\n  " + sentence);
}
void expectDoorRefused(const Value& door, const std::string& sentence) {
  EXPECT_EQ(errorsOfRooms(list({hall(), cell()}), list({door})), "1 parameter is wrong:\n  " + sentence);
}

/// Returns the walls of a room that a point is beyond.
int beyond(const Room& room, const Eigen::Vector3d& point) {
  int count = 0;
  for (const RoomWall& wall : room.walls) count += wall.normal.dot(point) > wall.offset ? 1 : 0;
  return count;
}

TEST(RoomParams, ABoxHasSixWallsAndADoorAnOpening) {
  const Params params = readParams(paramsWith(list({hall(), cell()}), list({door()})));
  ASSERT_EQ(params.rooms.size(), 2u);
  EXPECT_EQ(params.rooms[1].name, "cell");
  const Room& hall = params.rooms[0];
  ASSERT_EQ(hall.walls.size(), 6u);
  EXPECT_EQ(beyond(hall, {3.99, 0.01, 2.99}), 0);
  EXPECT_EQ(beyond(hall, {4.01, -0.01, 3.01}), 3);
  ASSERT_EQ(params.doors.size(), 1u);
  EXPECT_EQ(params.doors[0].rooms, (std::array<std::size_t, 2>{0, 1}));
  EXPECT_TRUE(params.doors[0].opening.isApprox({Eigen::Vector3d(4, 1.5, 0), Eigen::Vector3d(4.2, 2.5, 2)}, 1e-5));
  EXPECT_TRUE(params.doors[0].opening.contains(Eigen::Vector3d(4.0, 1.5, 0.0))) << "it is not rounded inward";
  EXPECT_NO_THROW(Building(params.rooms, params.doors));
  EXPECT_TRUE(readParams(dict()).rooms.empty());
}

TEST(RoomParams, MayBeRotatedOrHaveAnyWalls) {
  Value turned = hall();
  turned["pose"] = dict({{"xyz", xyz(0, 0, 0)}, {"rpy", xyz(0, 0, M_PI / 4)}});
  Value wedge = dict(
      {{"name", "wedge"}, {"walls", list({wall(-1, 0, 0, 0), wall(0, -2, 0, 0), wall(3, 3, 0, 5), wall(0, 0, 1, 3)})}});
  const Params params = readParams(paramsWith(list({turned, wedge}), list()));
  EXPECT_EQ(beyond(params.rooms[0], {2.8, 0, 0}), 0);
  EXPECT_EQ(beyond(params.rooms[0], {2.0, 2.0, 0}), 1);
  const Room& room = params.rooms[1];
  EXPECT_EQ(beyond(room, {1.0, 0.6, -100}), 0);
  EXPECT_EQ(beyond(room, {5.0, 2.1, 0}), 1) << "the offset is in meters, whatever the length of the normal";
  EXPECT_EQ(beyond(room, {5.0, 2.0, 0}), 0);
  for (const RoomWall& wall : room.walls) EXPECT_NEAR(wall.normal.norm(), 1.0, 1e-12);
}

TEST(RoomParams, OfARotatedDoorAreTheBoxAroundIt) {
  Value turned = door();
  turned["pose"] = dict({{"xyz", xyz(4.1, 2, 1)}, {"rpy", xyz(0, 0, M_PI / 2)}});
  turned["size"] = xyz(1, 0.2, 2);
  const Params params = readParams(paramsWith(list({hall(), cell()}), list({turned})));
  EXPECT_TRUE(params.doors[0].opening.isApprox({Eigen::Vector3d(4, 1.5, 0), Eigen::Vector3d(4.2, 2.5, 2)}, 1e-5));
}

Value boxRoom(const std::string& name, double x0, double x1, double y0, double y1, double turn = 0.0) {
  const Value pose = dict({{"xyz", xyz((x0 + x1) / 2, (y0 + y1) / 2, 1.5)}, {"rpy", xyz(0, 0, turn)}});
  return dict({{"name", name}, {"pose", pose}, {"size", xyz(x1 - x0, y1 - y0, 3)}});
}

/// Claim: two bodies in the two arms of an L, near its inner corner, are a pair: no wall is between them. The node
/// pairs bodies of different rooms only through doors, so the overlap of the rooms must be one.
TEST(RoomParams, ThatOverlapHaveADoorAroundTheirCommonSpace) {
  const Params params = readParams(dict({{"rooms", list({boxRoom("a", 1, 5, 1, 2), boxRoom("b", 1, 2, 1, 5)})}}));
  ASSERT_EQ(params.doors.size(), 1u);
  EXPECT_EQ(params.doors[0].rooms, (std::array<std::size_t, 2>{0, 1}));
  EXPECT_TRUE(params.doors[0].opening.isApprox({Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(2, 2, 3)}, 1e-5));
  EXPECT_TRUE(params.doors[0].opening.contains(Eigen::Vector3d(2, 2, 3))) << "it is not rounded inward";
}

/// Claim: walls without thickness separate, also oblique ones, for which the boxes around the rooms overlap.
TEST(RoomParams, ThatOnlyTouchHaveNoDoor) {
  const double half = std::sqrt(0.5);  // b begins where a ends, both turned by 45 degrees
  for (const Value& rooms : {list({boxRoom("a", 0, 4, 0, 1), boxRoom("b", 4, 5, 0, 4)}),
                             list({boxRoom("a", -1, 1, -1, 1, M_PI / 4),
                                   boxRoom("b", 2 * half - 1, 2 * half + 1, 2 * half - 1, 2 * half + 1, M_PI / 4)})}) {
    EXPECT_TRUE(readParams(dict({{"rooms", rooms}})).doors.empty());
  }
}

TEST(RoomParams, OfAWrongRoomAreRefusedByName) {
  expectRoomRefused("hall", "~rooms[0] is a string ('hall'); it must be a dictionary");
  expectRoomRefused(dict({{"size", xyz(1, 1, 1)}}), "~rooms[0] has no 'name'; it must have one");
  expectRoomRefused(dict({{"name", "hall"}}), "~rooms[0] has no 'size'; it must have one");
  expectRoomRefused(with(hall(), {{"size", xyz(4, -1, 3)}}),
                    "~rooms[0]/size has a side of -1 m; each side must be greater than 0 m");
  expectRoomRefused(with(hall(), {{"size", xyz(4, std::nan(""), 3)}}),
                    "~rooms[0]/size[1] is nan; it must be within -1000000 .. 1000000");
  expectRoomRefused(with(hall(), {{"color", "red"}}),
                    "~rooms[0]/color is not a field of a room (name, pose, size, walls); the name may be misspelled");
  expectRoomRefused(with(hall(), {{"walls", list({wall(1, 0, 0, 1)})}}),
                    "~rooms[0] has walls, and size or pose; a room must have either walls, or a size and a pose");
  EXPECT_EQ(errorsOfRooms(list({hall(), hall()}), list()),
            "1 parameter is wrong:\n  ~rooms[1]/name is 'hall', which is already used; names must differ");
  EXPECT_EQ(errorsOfRooms("hall", list()), "1 parameter is wrong:\n  ~rooms is a string ('hall'); it must be a list");
}

TEST(RoomParams, OfWrongWallsAreRefusedByName) {
  const auto room = [](const Value& walls) { return dict({{"name", "hall"}, {"walls", walls}}); };
  expectRoomRefused(room(list()), "~rooms[0]/walls has no wall; it must have at least one");
  expectRoomRefused(room(list({dict({{"offset", 1.0}})})), "~rooms[0]/walls[0] has no 'normal'; it must have one");
  expectRoomRefused(room(list({dict({{"normal", xyz(1, 0, 0)}})})),
                    "~rooms[0]/walls[0] has no 'offset'; it must have one");
  expectRoomRefused(room(list({wall(0, 0, 0, 1)})),
                    "~rooms[0]/walls[0]/normal has the length 0; it must be at least 1e-06");
  expectRoomRefused(room(list({wall(1, 0, 0, 1e7)})),
                    "~rooms[0]/walls[0]/offset is 10000000 m; it must be within -1000000 .. 1000000 m");
  expectRoomRefused(room(list({wall(1, 0, 0, -1), wall(-1, 0, 0, -1)})),
                    "~rooms[0]/walls enclose no space; the normal of each wall must point out of the room");
  Value many = list();
  for (int i = 0; i < 65; ++i) many[i] = wall(1, 0.01 * i, 0, 1);
  expectRoomRefused(room(many), "~rooms[0]/walls has 65 walls; at most 64 are allowed");
}

TEST(RoomParams, OfAWrongDoorAreRefusedByName) {
  expectDoorRefused(with(door(), {{"rooms", list({"hall", "cel"})}}),
                    "~doors[0]/rooms names 'cel', which is not in ~rooms; correct the name");
  expectDoorRefused(with(door(), {{"rooms", list({"hall", "hall"})}}),
                    "~doors[0]/rooms names 'hall' twice; a door must lead from a room to another one");
  expectDoorRefused(with(door(), {{"rooms", list({"hall"})}}),
                    "~doors[0]/rooms has 1 names; it must have 2, those of the rooms on both sides");
  expectDoorRefused(with(door(), {{"rooms", "hall"}}), "~doors[0]/rooms is a string ('hall'); it must be a list");
  expectDoorRefused(with(door(), {{"size", xyz(0, 1, 2)}}),
                    "~doors[0]/size has a side of 0 m; each side must be greater than 0 m");
  expectDoorRefused(with(door(), {{"width", 1.0}}),
                    "~doors[0]/width is not a field of a door (rooms, pose, size); the name may be misspelled");
  expectDoorRefused(dict({{"rooms", list({"hall", "cell"})}}), "~doors[0] has no 'size'; it must have one");
  expectDoorRefused(
      with(door(), {{"size", xyz(0.18, 1, 2)}, {"pose", poseAt(4.09, 2, 1)}}),
      "~doors[0] does not reach the room 'cell'; its box must go through the whole thickness of the wall");
  expectDoorRefused("door", "~doors[0] is a string ('door'); it must be a dictionary");
}

TEST(RoomParams, BeyondTheLimitsAreRefused) {
  Value rooms = list(), doors = list();
  rooms[1000] = 0;
  doors[4000] = 0;
  const std::string errors = errorsOfRooms(rooms, doors);
  EXPECT_EQ(errors,
            "2 parameters are wrong:\n  ~rooms has 1001 rooms; at most 1000 are allowed\n  ~doors has 4001 doors; at "
            "most 4000 are allowed");
}

TEST(RoomParams, OfTooManyRoomsThatOverlapAreRefused) {
  Value rooms = list();
  for (int i = 0; i < 142; ++i) rooms[i] = boxRoom("room" + std::to_string(i), 0, 1, 0, 1 + 0.01 * i);
  EXPECT_EQ(
      errorsOfRooms(rooms, list()),
      "1 parameter is wrong:\n  ~rooms has more than 10000 pairs of rooms whose surrounding boxes overlap; divide "
      "the space into fewer rooms");
}

/// Claim: the example is valid, and describes what its comments say.
TEST(RoomParams, OfTheExampleAreValid) {
  std::ifstream file(std::string(HGRID_PROJECT_DIR) + "/config/rooms.yaml");
  std::stringstream text;
  text << file.rdbuf();
  const Params params = readParams(valueOfYaml(text.str(), "config/rooms.yaml"));
  EXPECT_EQ(params.rooms.size(), 3u);
  EXPECT_EQ(params.doors.size(), 2u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
