// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests which pairs the markers show, and how.
#include "src/node/markers/pair_markers.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "test/node/support/marker_ticks.h"

namespace hgrid {
namespace test {
namespace {

using visualization_msgs::Marker;

std::vector<Marker> pairMarkersOf(const Tick& tick, const PairDistances* distances) {
  return pairMarkers(tick, nearPairs(tick, distances), scaleOf(tick));
}

TEST(PairMarkers, OfAPlaneConnectTheLowestCornerWithTheSurface) {
  SceneOptions options;
  options.margin = 3.0;
  Scene scene(options);
  put(scene, planeBody("floor"), at(0.0));
  put(scene, ball("ball", 0.5), at(7.0, 0.0, 2.5));
  put(scene, ball("z_ball", 0.5), at(-7.0, 0.0, 2.5));
  const std::vector<Marker> markers = pairMarkersOf(tickOf(scene), nullptr);
  double low = 9.0, high = -9.0;
  std::size_t points = 0;
  for (const Marker& marker : markers) {
    for (const geometry_msgs::Point& point : marker.points) {
      ++points;
      low = std::min(low, point.z);
      high = std::max(high, point.z);
    }
  }
  EXPECT_EQ(points, 8u) << "a line and its two ends for each of the two pairs";
  EXPECT_NEAR(low, 0.0, 1e-6);
  EXPECT_NEAR(high, 2.0, 1e-6);
}

/// Two spheres that are 40 mm apart. Their boxes overlap.
class PairMarkersOf : public ::testing::Test {
 protected:
  void SetUp() override {
    first_ = put(scene_, measuredBall("a", 0.5), at(0));
    put(scene_, measuredBall("b", 0.5), at(1.04 * 0.6, 1.04 * 0.8));
    tick_ = tickOf(scene_);
    ASSERT_EQ(tick_.snapshot->pairs().size(), 1u);
    distances_ = distancesOf(tick_);
  }
  static Eigen::Vector3d point(const Marker& marker, std::size_t i) {
    return {marker.points[i].x, marker.points[i].y, marker.points[i].z};
  }
  Scene scene_{SceneOptions()};
  BodyId first_;
  Tick tick_;
  std::shared_ptr<const PairDistances> distances_;
};

TEST_F(PairMarkersOf, AMeasuredPairConnectTheNearestPointsOfTheShapes) {
  const std::vector<Marker> markers = pairMarkersOf(tick_, distances_.get());
  ASSERT_EQ(markers[0].points.size(), 2u);
  EXPECT_TRUE(point(markers[0], 0).isApprox(Eigen::Vector3d(0.3, 0.4, 0.0), 1e-6));
  EXPECT_NEAR((point(markers[0], 1) - point(markers[0], 0)).norm(), 0.04, 1e-6);
  EXPECT_EQ(markers[0].colors[0].b, 1.0f) << "white";
  EXPECT_EQ(shownOf(markers, "pair_numbers").size(), 1u) << "there is one pair only";
  EXPECT_EQ(listText(tick_, nearPairs(tick_, distances_.get())), "1. obstacle/a to obstacle/b: 40 mm");
}

TEST_F(PairMarkersOf, APairThatWasNotMeasuredAreGrayAndSayThatTheDistanceIsABound) {
  const std::vector<Marker> markers = pairMarkersOf(tick_, nullptr);
  ASSERT_EQ(markers[0].points.size(), 2u);
  EXPECT_EQ(listText(tick_, nearPairs(tick_, nullptr)), "1. obstacle/a to obstacle/b: at least 0 mm")
      << "boxes overlap";
  EXPECT_TRUE(point(markers[0], 0).isApprox(point(markers[0], 1)));
  EXPECT_EQ(markers[0].colors[0].r, markers[0].colors[0].b);
  EXPECT_LT(markers[0].colors[0].b, 1.0f);
}

TEST_F(PairMarkersOf, ABodyWhosePoseCannotBeTrustedAreGrayAndSayTheState) {
  scene_.setState(first_, Freshness::lost, 3.0);
  const Tick tick = tickOf(scene_);
  const std::shared_ptr<const PairDistances> distances = distancesOf(tick);
  EXPECT_EQ(listText(tick, nearPairs(tick, distances.get())), "1. obstacle/a to obstacle/b: 40 mm, LOST");
  EXPECT_LT(pairMarkersOf(tick, distances.get())[0].colors[0].b, 1.0f);
}

TEST(NearPairs, AreNotThoseWhoseShapesAreKnownToBeFarther) {
  Scene scene{SceneOptions()};
  put(scene, measuredBall("a", 0.5), at(0));
  put(scene, measuredBall("b", 0.5), at(1.2 * 0.6, 1.2 * 0.8));  // 0.2 m apart; the boxes overlap
  const Tick tick = tickOf(scene);
  ASSERT_EQ(tick.snapshot->pairs().size(), 1u);
  EXPECT_EQ(nearPairs(tick, nullptr).count, 1u) << "nobody knows yet";
  const NearPairs near = nearPairs(tick, distancesOf(tick).get());
  EXPECT_EQ(near.count, 0u);
  EXPECT_EQ(near.nearness, std::vector<std::optional<double>>(2));
}

/// Claim: a pair whose own margin is larger than the longest measured distance stays near, with a bound.
TEST(NearPairs, AreThoseThatMayBeNearerThanTheirOwnMargin) {
  Scene scene{SceneOptions()};
  Body wide = measuredBall("a", 0.5);
  wide.margin = 0.5;
  put(scene, wide, at(0));
  put(scene, measuredBall("b", 0.5), at(1.3));
  const Tick tick = tickOf(scene);
  ASSERT_EQ(tick.snapshot->pairs().size(), 1u);
  EXPECT_EQ(listText(tick, nearPairs(tick, distancesOf(tick).get())), "1. obstacle/a to obstacle/b: at least 300 mm");
}

TEST(PairMarkers, HaveNumbersThatDoNotCoverEachOther) {
  for (int pairs = 2; pairs <= 20; ++pairs) {
    SCOPED_TRACE(pairs);
    Scene scene{SceneOptions()};
    put(scene, ball("hub", 0.05), at(0));
    for (int i = 0; i < pairs; ++i) {
      put(scene, ball(std::to_string(i), 0.01, Mobility::fixed), at(0.07, 0.005 * i, i % 2 ? 0.0 : 0.03));
    }
    const Tick tick = tickOf(scene);
    const std::vector<Marker> texts = shownOf(pairMarkersOf(tick, nullptr), "pair_numbers");
    ASSERT_FALSE(texts.empty());
    std::string all;
    for (const Marker& text : texts) all += (all.empty() ? "" : ",") + text.text;
    EXPECT_EQ(std::count(all.begin(), all.end(), ',') + 1, std::min(pairs, 6)) << all;
    for (const Marker& a : texts) {
      for (const Marker& b : texts) {
        if (a.id == b.id) continue;
        EXPECT_GE((placeOf(a) - placeOf(b)).norm(), 2.0 * a.scale.z);
      }
    }
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
