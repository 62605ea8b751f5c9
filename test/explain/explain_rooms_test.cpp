// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include "hgrid_proximity/explain/explain.h"
#include "test/support/buildings.h"
#include "test/support/rules.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::at;
using test::ball;
using test::put;

/// A body at each side of the wall of test::twoRooms(), and one far from the wall.
class ExplainRooms : public ::testing::Test {
 protected:
  ExplainRooms() : scene_(options()) {
    put(scene_, ball("a", 0.2), at(-0.21, 2));
    put(scene_, ball("b", 0.2), at(0.21, 2));
    put(scene_, ball("far", 0.2), at(3, 2));
  }
  static SceneOptions options() {
    SceneOptions options;
    options.building = test::twoRooms();
    return options;
  }
  std::string ask(const std::string& second) {
    const Explanation what = explain(*scene_.commit(Time{1}, {}), "obstacle/a", "obstacle/" + second, nullptr);
    EXPECT_FALSE(what.reported);
    EXPECT_FALSE(what.cut);
    EXPECT_EQ(what.separate, second != "a");
    return what.text;
  }
  Scene scene_;
};

const std::string kSeparate = "they have no room of SceneOptions::building in common, so they are never a pair: ";

TEST_F(ExplainRooms, NameTheRoomsOfBodiesThatWallsSeparate) {
  EXPECT_EQ(ask("b"),
            "obstacle/a and obstacle/b are not reported: " + kSeparate +
                "obstacle/a is in 'west', and obstacle/b is in 'east'. Otherwise they would be reported: their boxes "
                "are 0.02 m apart, within the margin of 0.1 m.");
  EXPECT_EQ(ask("far"),
            "obstacle/a and obstacle/far are not reported: " + kSeparate +
                "obstacle/a is in 'west', and obstacle/far is in 'east'. Also, their boxes are 2.81 m apart, more than "
                "the margin of 0.1 m.");
  EXPECT_EQ(ask("a").find("room"), std::string::npos) << "a body and itself";
}

TEST_F(ExplainRooms, ComeAfterARuleThatSwitchesThePairOff) {
  scene_.setRules({test::allow("obstacle/a", "obstacle/b")});
  EXPECT_EQ(ask("b"),
            "obstacle/a and obstacle/b are not reported: rule 'obstacle/a', 'obstacle/b' of Scene::setRules() allows "
            "them to touch. Also, " +
                kSeparate + "obstacle/a is in 'west', and obstacle/b is in 'east'.");
}

TEST(ExplainManyRooms, NameOnlyTheFirstOnes) {
  std::vector<Room> rooms;
  for (int i = 0; i < 8; ++i) {
    rooms.push_back(Room::ofBox("room" + std::to_string(i), test::block(-8, -4, -4, -0.25, 4, 4)));
  }
  rooms.push_back(Room::ofBox("east", test::block(0.25, -4, -4, 8, 4, 4)));
  SceneOptions options;
  options.building = std::make_shared<const Building>(rooms, std::vector<Portal>{});
  Scene scene(options);
  put(scene, ball("a", 0.2), at(-0.21, 2));
  put(scene, ball("b", 0.2), at(0.21, 2));
  const Explanation what = explain(*scene.commit(Time{1}, {}), "obstacle/a", "obstacle/b", nullptr);
  EXPECT_NE(
      what.text.find("obstacle/a is in 'room0', 'room1', 'room2', 'room3' and 4 more, and obstacle/b is in 'east'"),
      std::string::npos)
      << what.text;
}

}  // namespace
}  // namespace hgrid
