// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests the markers that RViz draws for a tick.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "src/node/messages/pair_markers.h"
#include "src/node/messages/shape_markers.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace test {
namespace {

using visualization_msgs::Marker;

Tick tickWith(std::shared_ptr<const Snapshot> snapshot) {
  Tick tick;
  tick.world_frame = "world";
  tick.snapshot = std::move(snapshot);
  return tick;
}

Body bodyOf(const std::string& name, const Shape& shape, double padding = 0.0) {
  Body body = obstacle(name);
  body.shapes.push_back(shapeOf(shape));
  body.shapes.back().padding = padding;
  return body;
}

Pose turnedAt(double x, double angle) {
  Pose pose = at(x, 2.0, 3.0);
  pose.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d(1.0, 2.0, 2.0) / 3.0));
  return pose;
}

Pose poseOf(const Marker& marker) {
  Pose pose = Pose::Identity();
  pose.translate(Eigen::Vector3d(marker.pose.position.x, marker.pose.position.y, marker.pose.position.z));
  pose.rotate(Eigen::Quaterniond(marker.pose.orientation.w, marker.pose.orientation.x, marker.pose.orientation.y,
                                 marker.pose.orientation.z));
  return pose;
}

Eigen::Vector3d scaleOf(const Marker& marker) { return {marker.scale.x, marker.scale.y, marker.scale.z}; }

/// Returns the markers of one body at a rotated pose. The shape of the body has the same pose.
std::vector<Marker> drawn(const Body& body, const Pose& pose) {
  Scene scene{SceneOptions()};
  put(scene, body, pose);
  return shapeMarkers(tickWith(scene.commit(Time{1}, {})));
}

TEST(ShapeMarkers, AreSolidsInTheTruePosesWithPadding) {
  const Pose pose = turnedAt(1.0, 0.7);
  const std::map<int, std::pair<Shape, Eigen::Vector3d>> expected = {
      {Marker::CUBE, {Shape::box({0.1, 0.2, 0.3}), {0.14, 0.24, 0.34}}},
      {Marker::SPHERE, {Shape::sphere(0.5), {1.04, 1.04, 1.04}}},
      {Marker::CYLINDER, {Shape::cylinder(0.4, 0.1), {0.24, 0.24, 0.44}}},
  };
  for (const auto& [type, shape] : expected) {
    SCOPED_TRACE(type);
    const std::vector<Marker> markers = drawn(bodyOf("a", shape.first, 0.02), pose);
    ASSERT_EQ(markers.size(), 1u);
    EXPECT_EQ(markers[0].type, type);
    EXPECT_EQ(markers[0].action, Marker::ADD);
    EXPECT_EQ(markers[0].header.frame_id, "world");
    EXPECT_TRUE(poseOf(markers[0]).isApprox(pose, 1e-9));
    EXPECT_TRUE(scaleOf(markers[0]).isApprox(shape.second, 1e-9)) << scaleOf(markers[0]).transpose();
  }
}

TEST(ShapeMarkers, OfACapsuleAreACylinderAndTwoSpheres) {
  const Pose pose = turnedAt(1.0, 2.0);
  const std::vector<Marker> markers = drawn(bodyOf("a", Shape::capsule(0.6, 0.1)), pose);
  ASSERT_EQ(markers.size(), 3u);
  EXPECT_EQ(markers[0].type, Marker::CYLINDER);
  EXPECT_TRUE(scaleOf(markers[0]).isApprox(Eigen::Vector3d(0.2, 0.2, 0.6)));
  for (const int end : {1, 2}) {
    EXPECT_EQ(markers[std::size_t(end)].type, Marker::SPHERE);
    const Eigen::Vector3d center = pose * Eigen::Vector3d(0, 0, end == 1 ? -0.3 : 0.3);
    EXPECT_TRUE(poseOf(markers[std::size_t(end)]).translation().isApprox(center, 1e-9));
  }
}

TEST(ShapeMarkers, OfAConeAreClosedAndPointOutward) {
  const std::vector<Marker> markers = drawn(bodyOf("a", Shape::cone(0.6, 0.2)), turnedAt(1.0, 1.0));
  ASSERT_EQ(markers.size(), 1u);
  ASSERT_EQ(markers[0].type, Marker::TRIANGLE_LIST);
  const auto point = [&](std::size_t i) {
    return Eigen::Vector3d(markers[0].points[i].x, markers[0].points[i].y, markers[0].points[i].z);
  };
  ASSERT_EQ(markers[0].points.size() % 3, 0u);
  double volume = 0.0;
  for (std::size_t i = 0; i < markers[0].points.size(); i += 3) {
    volume += point(i).dot(point(i + 1).cross(point(i + 2))) / 6.0;
  }
  EXPECT_NEAR(volume, M_PI * 0.2 * 0.2 * 0.6 / 3.0, 3e-4)
      << "of a pyramid with 32 sides, counter-clockwise from outside";
}

TEST(ShapeMarkers, OfAPlaneAreAThinSquareBelowItsSurfaceNearWhatMoves) {
  Scene scene{SceneOptions()};
  Body floor = obstacle("floor", Mobility::fixed);
  floor.shapes.push_back(shapeOf(Shape::plane()));
  floor.shapes.back().padding = 0.02;
  const Pose pose = turnedAt(1.0, 0.7);
  const Eigen::Vector3d center(100.0, -20.0, 4.0);
  put(scene, floor, pose);
  put(scene, ball("ball"), at(center.x(), center.y(), center.z()));
  const Tick tick = tickWith(scene.commit(Time{1}, {}));
  const std::vector<Marker> markers = shapeMarkers(tick);
  ASSERT_EQ(markers.size(), 2u);
  const Marker& square = markers[1];
  EXPECT_EQ(square.type, Marker::CUBE);
  EXPECT_GE(scaleOf(square).x(), 1.0);
  EXPECT_EQ(scaleOf(square).x(), scaleOf(square).y());
  EXPECT_LT(scaleOf(square).z(), 0.01);
  EXPECT_LT(square.color.a, 0.5f);
  const Eigen::Vector3d surface = poseOf(square) * Eigen::Vector3d(0, 0, 0.5 * square.scale.z),
                        in_plane = pose.inverse() * surface;
  EXPECT_NEAR(in_plane.z(), 0.02, 1e-9);
  EXPECT_NEAR((in_plane - pose.inverse() * center).head<2>().norm(), 0.0, 1e-4);
  EXPECT_EQ(boxMarker(tick).points.size(), 24u) << "the plane has no box";
}

TEST(PairMarkers, OfAPlaneConnectTheLowestCornerWithTheSurface) {
  SceneOptions options;
  options.margin = 3.0;
  Scene scene(options);
  Body floor = obstacle("floor", Mobility::fixed);
  floor.shapes.push_back(shapeOf(Shape::plane()));
  put(scene, floor, at(0.0));
  put(scene, ball("ball", 0.5), at(7.0, 0.0, 2.5));
  put(scene, ball("z_ball", 0.5), at(-7.0, 0.0, 2.5));
  const std::vector<Marker> markers = pairMarkers(tickWith(scene.commit(Time{1}, {})), nullptr);
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

TEST(ShapeMarkers, OfAMeshFileNameTheFile) {
  auto triangles = std::make_shared<TriangleMesh>();
  triangles->vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangles->triangles = {{0, 1, 2}};
  Body body = bodyOf("a", Shape::mesh(triangles));
  body.shapes[0].resource = "package://robot/hand.stl";
  body.shapes[0].scale = {0.001, 0.001, 0.002};
  const std::vector<Marker> file = drawn(body, turnedAt(1.0, 1.0));
  ASSERT_EQ(file.size(), 1u);
  EXPECT_EQ(file[0].type, Marker::MESH_RESOURCE);
  EXPECT_EQ(file[0].mesh_resource, "package://robot/hand.stl");
  EXPECT_EQ(file[0].scale.z, 0.002);
  body.shapes[0].resource.clear();
  const std::vector<Marker> list = drawn(body, turnedAt(1.0, 1.0));
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].type, Marker::TRIANGLE_LIST);
  EXPECT_EQ(list[0].points.size(), 3u);
}

TEST(ShapeMarkers, HaveAnIdOfTheirOwnAndAColorForEachState) {
  Scene scene{SceneOptions()};
  std::vector<BodyId> ids;
  for (int i = 0; i < 6; ++i) {
    ids.push_back(put(scene, bodyOf(std::string(1, char('a' + i)), Shape::capsule(0.2, 0.1)), at(i)));
  }
  Body link = bodyOf("link", Shape::sphere(0.1));
  link.kind = BodyKind::link;
  put(scene, link, at(9));
  scene.add(bodyOf("never_placed", Shape::sphere(0.1)));
  scene.setState(ids[1], Freshness::late, 0.1);
  scene.setState(ids[2], Freshness::stale, 0.3);
  scene.setState(ids[3], Freshness::lost, 3.0);
  scene.setState(ids[4], Freshness::frozen, 3.0);
  scene.setState(ids[5], Freshness::invalid, 3.0);
  const Tick tick = tickWith(scene.commit(Time{1}, {}));
  const std::vector<Marker> markers = shapeMarkers(tick);
  ASSERT_EQ(markers.size(), 6u * 3u + 1u) << "and none for the body without a pose";
  std::set<int> marker_ids;
  std::set<std::vector<float>> colors;
  for (const Marker& marker : markers) {
    marker_ids.insert(marker.id);
    colors.insert({marker.color.r, marker.color.g, marker.color.b});
  }
  EXPECT_EQ(marker_ids.size(), markers.size());
  EXPECT_EQ(colors.size(), 5u) << "link, obstacle, STALE, FROZEN, and one for LOST and INVALID";

  std::vector<std::string> texts;
  for (const Marker& marker : stateMarkers(tick)) {
    if (marker.action == Marker::ADD) texts.push_back(marker.text);
  }
  EXPECT_EQ(texts, (std::vector<std::string>{"obstacle/f: INVALID", "obstacle/e: FROZEN", "obstacle/d: LOST",
                                             "obstacle/c: STALE"}));
}

/// Two spheres that are 40 mm apart. Their boxes are less than 40 mm apart.
class PairMarkersOf : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::shared_ptr<NarrowPhase> narrow_phase = makeCoreNarrowPhase();
    for (const char* name : {"a", "b"}) {
      Body body = bodyOf(name, Shape::sphere(0.5));
      body.shapes[0].solid = narrow_phase->solidOf(body.shapes[0].shape);
      put(scene_, body, std::string(name) == "a" ? at(0) : at(1.04 * 0.6, 1.04 * 0.8));
    }
    tick_ = tickWith(scene_.commit(Time{1}, {}));
    ASSERT_EQ(tick_.snapshot->pairs().size(), 1u);
    distances_ = PairMeter(narrow_phase, MeterOptions()).measure(*tick_.snapshot);
  }
  static Eigen::Vector3d point(const Marker& marker, std::size_t i) {
    return {marker.points[i].x, marker.points[i].y, marker.points[i].z};
  }
  Scene scene_{SceneOptions()};
  Tick tick_;
  std::shared_ptr<const PairDistances> distances_;
};

TEST_F(PairMarkersOf, AMeasuredPairConnectTheNearestPointsOfTheShapes) {
  const std::vector<Marker> markers = pairMarkers(tick_, distances_.get());
  ASSERT_EQ(markers[0].points.size(), 2u);
  EXPECT_TRUE(point(markers[0], 0).isApprox(Eigen::Vector3d(0.3, 0.4, 0.0), 1e-6));
  EXPECT_NEAR((point(markers[0], 1) - point(markers[0], 0)).norm(), 0.04, 1e-6);
  EXPECT_EQ(markers[2].text, "obstacle/a to obstacle/b: 40 mm");
  EXPECT_EQ(markers[3].action, Marker::DELETE) << "there is one pair only";
}

TEST_F(PairMarkersOf, APairThatWasNotMeasuredSayThatTheDistanceIsABound) {
  const std::vector<Marker> markers = pairMarkers(tick_, nullptr);
  ASSERT_EQ(markers[0].points.size(), 2u);
  EXPECT_EQ(markers[2].text, "obstacle/a to obstacle/b: at least 0 mm") << "their boxes overlap";
  EXPECT_TRUE(point(markers[0], 0).isApprox(point(markers[0], 1)));
}

TEST(PairMarkers, HaveTextsThatDoNotCoverEachOther) {
  Scene scene{SceneOptions()};
  for (int i = 0; i < 6; ++i) put(scene, ball(std::to_string(i), 0.05), at(0.01 * i));
  const Tick tick = tickWith(scene.commit(Time{1}, {}));
  std::vector<Marker> texts;
  for (const Marker& marker : pairMarkers(tick, nullptr)) {
    if (marker.ns == "pair_names" && marker.action == Marker::ADD) texts.push_back(marker);
  }
  ASSERT_EQ(texts.size(), 8u) << "of 15 pairs";
  for (const Marker& a : texts) {
    for (const Marker& b : texts) {
      if (a.id == b.id) continue;
      EXPECT_GT(std::abs(a.pose.position.z - b.pose.position.z), a.scale.z);
    }
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
