// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests the frames around tracks.
#include "src/node/markers/box_markers.h"

#include <gtest/gtest.h>

#include "src/node/markers/marker_colors.h"
#include "test/node/support/marker_ticks.h"

namespace hgrid {
namespace test {
namespace {

using visualization_msgs::Marker;

/// Returns the frame around a person at x = 0 who touches an obstacle.
Marker frameOf(Freshness state) {
  Scene scene{SceneOptions()};
  scene.setState(put(scene, measuredBall("ann", 0.5, BodyKind::track), at(0.0)), state, 1.0);
  put(scene, measuredBall("a", 0.5), at(0.9));
  const Tick tick = tickOf(scene);
  return trackMarker(tick, scaleOf(tick));
}

TEST(TrackMarker, IsAFrameInTheColorOfTracksAlsoIfTheTrackIsNearAnotherBody) {
  const Marker frame = frameOf(Freshness::fresh);
  ASSERT_EQ(frame.action, Marker::ADD);
  ASSERT_EQ(frame.points.size(), 24u) << "no frame around the obstacle";
  for (const geometry_msgs::Point& point : frame.points) EXPECT_NEAR(std::abs(point.x), 0.5, 1e-5);
  const std_msgs::ColorRGBA color = colorOfBody(BodyKind::track, Freshness::fresh, std::nullopt);
  EXPECT_EQ(frame.colors[0].r, color.r);
  EXPECT_EQ(frame.colors[0].b, color.b);
}

TEST(TrackMarker, IsGrayIfThePoseCannotBeTrusted) {
  const Marker frame = frameOf(Freshness::lost);
  EXPECT_EQ(frame.colors[0].r, frame.colors[0].b);
}

TEST(TrackMarker, IsNotShownWithoutTracks) {
  Scene scene{SceneOptions()};
  put(scene, ball("a"), at(0.0));
  const Tick tick = tickOf(scene);
  EXPECT_EQ(trackMarker(tick, scaleOf(tick)).action, Marker::DELETE);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
