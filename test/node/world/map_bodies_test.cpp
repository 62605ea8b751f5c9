// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/world/map_bodies.h"

#include <gtest/gtest.h>

#include "test/support/refusals.h"

namespace hgrid {
namespace test {
namespace {

LoadedMap mapAt(double x, const std::string& frame = "") {
  LoadedMap map;
  map.params.name = "hall";
  map.params.frame = frame;
  map.params.frame_from_map.translation().x() = x;
  return map;
}

TEST(MapBodies, FollowTheirFrameOrAreFixedInTheWorld) {
  const Body fixed = mapBodyOf(mapAt(1.0), "world", {}), moving = mapBodyOf(mapAt(1.0, "cart"), "world", {});
  EXPECT_EQ(fixed.name, "map/hall");
  EXPECT_EQ(fixed.frame, "world");
  EXPECT_EQ(fixed.mobility, Mobility::fixed);
  EXPECT_EQ(fixed.frame_from_body.translation().x(), 1.0);
  EXPECT_EQ(moving.frame, "cart");
  EXPECT_EQ(moving.mobility, Mobility::moving);
}

TEST(MapBodies, MustBeWithinTheWorldLimit) {
  EXPECT_EQ(refusalOf([] { mapBodyOf(mapAt(1e9), "world", {}); }), Code::out_of_range);
}

TEST(MapBodies, AreTheSameOnlyAtTheSamePoseInTheSameFrame) {
  const SourceId hall = SourceId::ofMap("hall");
  const auto bodyAt = [](double x, const std::string& frame) { return mapBodyOf(mapAt(x, frame), "world", {}); };
  MapBodies maps(false);
  EXPECT_FALSE(maps.has(hall));
  EXPECT_FALSE(maps.hasSame(hall, bodyAt(1.0, "cart")));
  maps.set(hall, bodyAt(1.0, "cart"), mapAt(1.0, "cart"));
  EXPECT_TRUE(maps.has(hall));
  EXPECT_TRUE(maps.hasSame(hall, bodyAt(1.0, "cart")));
  EXPECT_FALSE(maps.hasSame(hall, bodyAt(1.5, "cart")));
  EXPECT_FALSE(maps.hasSame(hall, bodyAt(1.0, "world")));
}

TEST(MapBodies, LeaveAGapAfterARefusedMessageUntilTheyAreErased) {
  const SourceId hall = SourceId::ofMap("hall");
  MapBodies maps(false);
  EXPECT_FALSE(maps.noteRefused(hall, "PARSE")) << "the map is not in the world yet";
  maps.set(hall, mapBodyOf(mapAt(0.0), "world", {}), mapAt(0.0));
  EXPECT_TRUE(maps.gaps({}).empty());
  EXPECT_TRUE(maps.noteRefused(hall, "PARSE"));
  MapBodies copy = maps;
  EXPECT_EQ(copy.gaps({}).size(), 1u);
  maps.eraseIf([&](const SourceId& source) { return source == hall; });
  EXPECT_TRUE(maps.gaps({}).empty());
  EXPECT_FALSE(maps.has(hall));
  maps.swap(copy);
  EXPECT_EQ(maps.gaps({}).size(), 1u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
