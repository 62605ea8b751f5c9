// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests the texts that say which poses are old.
#include "src/node/markers/state_markers.h"

#include <gtest/gtest.h>

#include "test/node/support/marker_ticks.h"

namespace hgrid {
namespace test {
namespace {

void putOld(Scene& scene, const std::string& name, BodyKind kind, double x, Freshness state) {
  Body body = ball("", 0.1);
  body.name = name;
  body.kind = kind;
  if (kind == BodyKind::link) body.robot = name.substr(0, name.find('/'));
  scene.setState(put(scene, body, at(x)), state, 1.0);
}

std::vector<std::string> textsFor(Scene& scene) {
  const Tick tick = tickOf(scene);
  std::vector<std::string> texts;
  for (const auto& marker : shownOf(stateMarkers(tick, scaleOf(tick)), "states")) texts.push_back(marker.text);
  return texts;
}

TEST(StateMarkers, HaveOneTextForEachSource) {
  Scene scene{SceneOptions()};
  putOld(scene, "obstacle/good", BodyKind::obstacle, 0.0, Freshness::fresh);
  putOld(scene, "obstacle/late", BodyKind::obstacle, 0.1, Freshness::late);
  EXPECT_EQ(textsFor(scene), std::vector<std::string>());
  putOld(scene, "obstacle/old", BodyKind::obstacle, 0.2, Freshness::stale);
  for (int i = 0; i < 3; ++i) putOld(scene, "arm/" + std::to_string(i), BodyKind::link, 9.0, Freshness::lost);
  putOld(scene, "arm/hand", BodyKind::link, 9.0, Freshness::stale);
  putOld(scene, "track/people/1", BodyKind::track, 5.0, Freshness::invalid);
  EXPECT_EQ(textsFor(scene),
            (std::vector<std::string>{"track/people/1: INVALID", "arm: 3 LOST, 1 STALE", "obstacle/old: STALE"}))
      << "the worst come first";
}

TEST(StateMarkers, AreAboveTheBodies) {
  Scene scene{SceneOptions()};
  for (const double x : {1.0, 3.0}) putOld(scene, "arm/" + std::to_string(x), BodyKind::link, x, Freshness::lost);
  const Tick tick = tickOf(scene);
  const MarkerScale scale = scaleOf(tick);
  const auto text = stateMarkers(tick, scale)[0];
  EXPECT_NEAR(text.pose.position.x, 2.0, 1e-6);
  EXPECT_NEAR(text.pose.position.z, 0.1 + scale.text_height, 1e-6) << "the radius is 0.1 m";
}

TEST(StateMarkers, ThatWouldCoverEachOtherAreOneText) {
  for (int robots = 2; robots <= 20; ++robots) {
    Scene scene{SceneOptions()};
    for (int i = 0; i < robots; ++i) {
      putOld(scene, "robot_" + std::to_string(i) + "/arm", BodyKind::link, 0.001 * i, Freshness::lost);
    }
    const std::vector<std::string> texts = textsFor(scene);
    ASSERT_EQ(texts.size(), 1u);
    EXPECT_EQ(std::count(texts[0].begin(), texts[0].end(), '\n') + 1, robots);
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
