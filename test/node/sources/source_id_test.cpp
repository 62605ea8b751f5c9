// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/sources/source_id.h"

#include <gtest/gtest.h>

namespace hgrid {
namespace {

TEST(SourceId, NamesASourceAsItsBodiesAndGapsDo) {
  EXPECT_EQ(SourceId::ofRobot("arm").name, "arm");
  EXPECT_EQ(SourceId::ofMap("hall").name, "map/hall");
  EXPECT_EQ(SourceId::ofCloud("eye").name, "cloud/eye");
  EXPECT_EQ(SourceId::ofTracker("people").name, "track/people");
  EXPECT_EQ(SourceId::ofObstacle("obstacle/post").name, "obstacle/post");
}

TEST(SourceId, LeavesAGapOfAllItsBodies) {
  const SourceGap robot = gapOf(SourceId::ofRobot("arm"), "why"), map = gapOf(SourceId::ofMap("hall"), "why"),
                  obstacle = gapOf(SourceId::ofObstacle("obstacle/post"), "why");
  EXPECT_EQ(gapOf(SourceId::ofTracker("people"), "why").source, "track/people");
  EXPECT_EQ(gapOf(SourceId::ofTracker("people"), "why").bodies, "track/people/*");
  EXPECT_EQ(robot.source, "arm");
  EXPECT_EQ(robot.bodies, "arm/*");
  EXPECT_EQ(robot.sentence, "why");
  EXPECT_FALSE(robot.within) << "bodies of a missing robot can be anywhere";
  EXPECT_EQ(map.source, "map/hall");
  EXPECT_EQ(map.bodies, "map/hall");
  EXPECT_EQ(obstacle.source, "obstacle") << "all obstacles are one source";
  EXPECT_EQ(obstacle.bodies, "obstacle/post");
}

TEST(SourceId, OfTheSameNameButOfAnotherKindIsAnotherSource) {
  EXPECT_FALSE(SourceId::ofRobot("map/hall") == SourceId::ofMap("hall"));
  EXPECT_TRUE(SourceId::ofMap("hall") == SourceId::ofMap("hall"));
}

}  // namespace
}  // namespace hgrid
