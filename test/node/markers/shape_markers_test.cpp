// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests the markers that draw the shapes of bodies.
#include "src/node/markers/shape_markers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "src/node/markers/box_markers.h"
#include "src/node/markers/marker_colors.h"
#include "test/node/support/marker_ticks.h"

namespace hgrid {
namespace test {
namespace {

using visualization_msgs::Marker;

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
  const Tick tick = tickOf(scene);
  return shapeMarkers(tick, nearPairs(tick, nullptr));
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
  const Tick tick = tickOf(scene);
  const std::vector<Marker> markers = shapeMarkers(tick, nearPairs(tick, nullptr));
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
  EXPECT_EQ(boxMarker(tick, scaleOf(tick)).points.size(), 24u) << "the plane has no box";
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

TEST(ShapeMarkers, HaveAnIdOfTheirOwnAndAColorForEachKind) {
  Scene scene{SceneOptions()};
  double x = 0.0;
  for (const BodyKind kind : {BodyKind::obstacle, BodyKind::link, BodyKind::track}) {
    Body body = bodyOf(std::to_string(static_cast<int>(kind)), Shape::capsule(0.2, 0.1));
    body.kind = kind;
    put(scene, body, at(x += 2.0));
  }
  scene.add(bodyOf("never_placed", Shape::sphere(0.1)));
  const Tick tick = tickOf(scene);
  const std::vector<Marker> markers = shapeMarkers(tick, nearPairs(tick, nullptr));
  ASSERT_EQ(markers.size(), 3u * 3u) << "and none for the body without a pose";
  std::set<int> marker_ids;
  std::set<std::vector<float>> colors;
  for (const Marker& marker : markers) {
    marker_ids.insert(marker.id);
    colors.insert(rgbOf(marker));
  }
  EXPECT_EQ(marker_ids.size(), markers.size());
  EXPECT_EQ(colors.size(), 3u) << "persons have a color of their own";
}

TEST(ShapeMarkers, AreGrayIfThePoseCannotBeTrusted) {
  for (const Freshness state :
       {Freshness::fresh, Freshness::late, Freshness::stale, Freshness::lost, Freshness::frozen, Freshness::invalid}) {
    SCOPED_TRACE(name(state));
    Scene scene{SceneOptions()};
    put(scene, ball("near"), at(0.9));  // an old pose is gray, also if the body is near another
    scene.setState(put(scene, ball("old"), at(0.0)), state, 0.1);
    const Tick tick = tickOf(scene);
    const std::vector<Marker> markers = shapeMarkers(tick, nearPairs(tick, nullptr));
    ASSERT_EQ(markers.size(), 2u);
    const bool is_gray = markers[1].color.r == markers[1].color.g && markers[1].color.g == markers[1].color.b;
    EXPECT_EQ(is_gray, state >= Freshness::stale);
    EXPECT_FALSE(markers[0].color.r == markers[0].color.g);
  }
}

/// Returns the color of the first of two balls whose surfaces are this far apart [m]. The margin is 0.1 m.
std::vector<float> colorAt(double distance, BodyKind kind) {
  Scene scene{SceneOptions()};
  put(scene, measuredBall("a", 0.5, kind), at(0.0));
  put(scene, measuredBall("b", 0.5), at(1.0 + distance));
  const Tick tick = tickOf(scene);
  return rgbOf(shapeMarkers(tick, nearPairs(tick, distancesOf(tick).get()))[kind == BodyKind::track ? 1 : 0]);
}

TEST(ShapeMarkers, AreYellowToOrangeIfTheBodyIsNearAnother) {
  for (const BodyKind kind : {BodyKind::obstacle, BodyKind::link, BodyKind::track}) {
    SCOPED_TRACE(static_cast<int>(kind));
    EXPECT_EQ(colorAt(0.3, kind), colorAt(0.11, kind)) << "not near";
    for (const double distance : {0.09, 0.05, 0.01}) {
      const std::vector<float> nearer = colorAt(distance - 0.01, kind), farther = colorAt(distance, kind);
      EXPECT_EQ(nearer[0], 1.0f);
      EXPECT_LT(nearer[2], 0.5f) << "yellow or orange";
      EXPECT_LT(nearer[1], farther[1]) << "the nearer, the less yellow";
    }
    const std_msgs::ColorRGBA contact = orange(1.0);
    EXPECT_EQ(colorAt(-0.01, kind), (std::vector<float>{contact.r, contact.g, contact.b}));
  }
}

TEST(ShapeMarkers, OfAPlaneAreNotTinted) {
  Scene near{SceneOptions()}, alone{SceneOptions()};
  for (Scene* scene : {&near, &alone}) put(*scene, planeBody("floor"), at(0.0));
  put(near, ball("ball"), at(0.0));
  const Tick near_tick = tickOf(near), alone_tick = tickOf(alone);
  ASSERT_EQ(near_tick.snapshot->pairs().size(), 1u);
  EXPECT_EQ(rgbOf(shapeMarkers(near_tick, nearPairs(near_tick, nullptr))[1]),
            rgbOf(shapeMarkers(alone_tick, nearPairs(alone_tick, nullptr))[0]));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
