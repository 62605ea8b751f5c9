// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <sstream>

#include "audited_world.h"
#include "src/node/audit/case_file.h"
#include "test/support/buildings.h"

namespace hgrid {
namespace test {
namespace {

/// Returns parameters with two rooms. Their wall is from x = -0.02 to 0.02 [m], amidst the bodies, and has a door.
Params withRoomParams() {
  Params params = AuditedWorld::defaults();
  params.origin = {3.0, -2.0, 1.0};
  params.rooms = {Room::ofBox("west", block(-5, -5, -5, -0.02, 5, 5)),
                  Room::ofBox("east", block(0.02, -5, -5, 5, 5, 5))};
  params.rooms[1].walls.push_back({Eigen::Vector3d(1, 1, 0).normalized(), 1.0});
  params.doors = {{{0, 1}, block(-0.02, 0.2, -0.2, 0.02, 0.3, 0.2)}};
  return params;
}

/// Makes ticks of a world and audits each of them, after `plant` changed its case. Returns all sentences.
std::string foundIn(const Params& params, unsigned seed, const std::function<void(AuditCase&)>& plant = {}) {
  AuditedWorld world(seed, params);
  std::string found;
  for (int tick = 0; tick < 40; ++tick) {
    world.is_silent = [tick](const std::string& frame) { return tick > 10 && frame == "f3"; };  // its pose grows old
    world.step();
    AuditCase audited = world.audited();
    if (plant) plant(audited);
    for (const std::string& sentence : audit(audited, 1).differences) found += sentence + "\n";
  }
  return found;
}

TEST(AuditRooms, AgreesWithANodeThatHasRooms) {
  for (const double horizon : {0.0, 0.05}) {
    Params params = withRoomParams();
    params.horizon = horizon;
    params.stale_after = 0.1;
    for (const unsigned seed : {21u, 22u, 23u, 24u}) EXPECT_EQ(foundIn(params, seed), "") << seed;
  }
}

TEST(AuditRooms, MissesThePairsThatOnlyTheRoomsRemove) {
  const std::string found = foundIn(withRoomParams(), 21, [](AuditCase& audited) { audited.rooms.clear(); });
  EXPECT_NE(found.find("is missing: the gap of its boxes is"), std::string::npos);
}

TEST(AuditRooms, MissesThePairsInADoorThatTheNodeDoesNotKnow) {
  const auto widened = [](AuditCase& audited) { audited.doors[0].opening = block(-5, -5, -5, 5, 5, 5); };
  EXPECT_NE(foundIn(withRoomParams(), 21, widened).find("is missing"), std::string::npos);
}

TEST(AuditRooms, FindsListedPairsWithoutACommonRoom) {
  Params without = withRoomParams();
  without.rooms.clear();
  without.doors.clear();
  const auto with_rooms = [](AuditCase& audited) { audited.rooms = withRoomParams().rooms; };
  EXPECT_NE(foundIn(without, 21, with_rooms).find("is listed, but its bodies have no room in common"),
            std::string::npos);
}

TEST(AuditRooms, AreInTheFileOfACase) {
  AuditedWorld world(21, withRoomParams());
  for (int tick = 0; tick < 3; ++tick) world.step();
  AuditCase audited = world.audited();
  audited.horizon = 0.25;
  std::stringstream file, again;
  writeCase(audited, file);
  const AuditCase read = readCase(file);
  EXPECT_EQ(read.rooms[1].name, "east");
  ASSERT_EQ(read.rooms[1].walls.size(), 7u);
  EXPECT_EQ(read.rooms[1].walls[6].normal, audited.rooms[1].walls[6].normal);
  EXPECT_EQ(read.rooms[1].walls[6].offset, 1.0);
  EXPECT_EQ(read.doors[0].rooms, audited.doors[0].rooms);
  EXPECT_EQ(read.doors[0].opening.max(), audited.doors[0].opening.max());
  EXPECT_EQ(read.horizon, 0.25);
  writeCase(read, again);
  EXPECT_EQ(again.str(), file.str());
}

}  // namespace
}  // namespace test
}  // namespace hgrid
