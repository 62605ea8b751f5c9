// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>
#include <hgrid_proximity/LifetimeEnd.h>
#include <hgrid_proximity/ShapeKind.h>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "src/node/messages/obstacle_messages.h"
#include "src/node/params/params.h"
#include "src/node/world/world.h"
#include "test/node/support/claims.h"
#include "test/node/support/settings.h"
#include "test/node/support/values.h"

namespace hgrid {
namespace test {
namespace {

namespace msg = ::hgrid_proximity;

constexpr Time kNow = std::chrono::seconds(1000);

Value numbers(std::initializer_list<double> values) {
  Value value;
  value.setSize(static_cast<int>(values.size()));
  int i = 0;
  for (const double number : values) value[i++] = number;
  return value;
}

Value triple(int a, int b, int c) { return list({Value(a), Value(b), Value(c)}); }

Value corners() { return list({xyz(0, 0, 0), xyz(1, 0, 0), xyz(0, 1, 0), xyz(0, 0, 1)}); }

Value faces() { return list({triple(0, 2, 1), triple(0, 1, 3), triple(1, 2, 3), triple(2, 0, 3)}); }

/// Returns an obstacle that has all fields of ~obstacles.
Value rich() {
  const Value hull = dict({{"type", "hull"}, {"vertices", corners()}, {"padding", 0.01}});
  const Value mesh = dict({{"type", "mesh"},
                           {"vertices", corners()},
                           {"triangles", faces()},
                           {"pose", dict({{"xyz", xyz(0, 0, 2)}, {"quaternion", numbers({0.0, 0.6, 0.0, 0.8})}})}});
  const Value pose = dict({{"xyz", xyz(1, 2, 3)}, {"quaternion", numbers({0.0, 0.0, 0.6, 0.8})}});
  return dict({{"name", "part"},
               {"frame", "/belt"},
               {"pose", pose},
               {"shapes", list({hull, mesh})},
               {"moving", true},
               {"margin", 0.3},
               {"max_speed", 1.5},
               {"lifetime", 2.5},
               {"lost_at_end", true},
               {"owner", "/planner"},
               {"group", "set"}});
}

/// Returns the same obstacle as a request of ~apply_obstacles.
msg::Obstacle richRequest() {
  msg::Obstacle request;
  request.name = "part";
  request.header.frame_id = "belt";
  request.pose.position.x = 1;
  request.pose.position.y = 2;
  request.pose.position.z = 3;
  request.pose.orientation.z = 0.6;
  request.pose.orientation.w = 0.8;
  msg::Shape shape;
  shape.pose.orientation.w = 1.0;
  shape.mesh.vertices.resize(4);
  shape.mesh.vertices[1].x = shape.mesh.vertices[2].y = shape.mesh.vertices[3].z = 1.0;
  shape.kind = msg::ShapeKind::HULL;
  shape.padding = 0.01;
  request.shapes.push_back(shape);
  shape.kind = msg::ShapeKind::MESH;
  shape.padding = 0.0;
  shape.pose.position.z = 2.0;
  shape.pose.orientation.y = 0.6;
  shape.pose.orientation.w = 0.8;
  const std::uint32_t triangles[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  shape.mesh.triangles.resize(4);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) shape.mesh.triangles[i].vertex_indices[k] = triangles[i][k];
  }
  request.shapes.push_back(shape);
  request.moving = true;
  request.margin = 0.3;
  request.max_speed = 1.5;
  request.lifetime = ros::Duration(2.5);
  request.lifetime_end = msg::LifetimeEnd::LOST;
  request.owner = "/planner";
  request.group = "set";
  return request;
}

Params paramsWith(const Value& obstacles) {
  // The padding of the parameters applies where the obstacle asks for less.
  const Value padding = list({dict({{"pattern", "obstacle/*"}, {"padding", 0.005}})});
  return readParams(dict({{"world_frame", "world"}, {"obstacles", obstacles}, {"padding", padding}}));
}

Moment arrival() {
  Moment now;
  now.ros = kNow;
  return now;
}

std::string refusalOfObstacle(const Value& obstacle) {
  try {
    paramsWith(list({obstacle}));
    return {};
  } catch (const std::invalid_argument& refusal) {
    return refusal.what();
  }
}

TEST(ObstacleParams, GiveTheSameObstacleAsARequest) {
  const std::shared_ptr<NarrowPhase> phase = makeCoreNarrowPhase();
  Ledger ledger;
  const Params with_obstacle = paramsWith(list({rich()})), without = paramsWith(list());
  World configured(settingsOf(with_obstacle), false, 1, ledger, phase),
      requested(settingsOf(without), false, 1, ledger, phase);
  msg::ApplyObstacles::Request request;
  request.changes = {richRequest()};
  const auto no_files = [](const std::string&, const Eigen::Vector3d&) -> std::shared_ptr<const TriangleMesh> {
    throw Refusal(Code::resource_missing, "no files");
  };
  configured.tick(arrival());
  requested.tick(arrival());
  requested.applyObstacles(obstacleChangesOf(request, "/caller", without, *phase, no_files), kNow);
  requested.tick(arrival());
  const auto &here = configured.obstacles().all(), &there = requested.obstacles().all();
  ASSERT_EQ(here.size(), 1u);
  ASSERT_EQ(there.size(), 1u);
  const PlacedObstacle &a = here.begin()->second, &b = there.begin()->second;
  EXPECT_TRUE(isSame(*a.what, *b.what));
  EXPECT_TRUE(isAtSamePlace(a, b));
  EXPECT_EQ(a.what->body.shapes[0].padding, 0.01);
  EXPECT_EQ(a.what->body.shapes[1].padding, 0.005);
  EXPECT_EQ(a.owner, "/planner");
  EXPECT_EQ(a.what->body.group, "set");
  EXPECT_EQ(a.ends, kNow + std::chrono::milliseconds(2500));
  EXPECT_EQ(a.ends, b.ends);
  EXPECT_TRUE(a.what->lost_at_end);
  // The request is therefore a repetition of the configured obstacle.
  EXPECT_NO_THROW(configured.applyObstacles(obstacleChangesOf(request, "/caller", without, *phase, no_files), kNow));
}

TEST(ObstacleParams, ConfiguredObstaclesEnd) {
  const std::shared_ptr<NarrowPhase> phase = makeCoreNarrowPhase();
  Ledger ledger;
  const Params params = paramsWith(
      list({with(ball("brief", 0, 0, 0, 1), {{"lifetime", 0.5}}),
            with(ball("seen", 5, 0, 0, 1), {{"lifetime", 0.5}, {"lost_at_end", true}}), ball("post", 9, 0, 0, 1)}));
  World world(settingsOf(params), false, 1, ledger, phase);
  Moment now = arrival();
  world.tick(now);
  EXPECT_EQ(world.obstacles().all().size(), 3u);
  now.ros += std::chrono::seconds(1);
  now.steady += std::chrono::seconds(1);
  world.tick(now);
  ASSERT_EQ(world.obstacles().all().size(), 2u);
  EXPECT_TRUE(world.obstacles().all().at("obstacle/seen").lost);
}

TEST(ObstacleParams, AQuaternionGivesTheSamePoseAsAngles) {
  const double half = std::sqrt(0.5);
  const auto posed = [](const Value& pose) {
    return paramsWith(list({with(ball("o", 0, 0, 0, 1), {{"pose", pose}})})).obstacles[0].body.frame_from_body;
  };
  const Pose angles = posed(dict({{"rpy", xyz(0, 0, M_PI / 2)}, {"xyz", xyz(1, 2, 3)}}));
  const Pose numbers_given = posed(dict({{"quaternion", numbers({0, 0, half, half})}, {"xyz", xyz(1, 2, 3)}}));
  EXPECT_TRUE(angles.isApprox(numbers_given, 1e-12));
}

TEST(ObstacleParams, APlaneHasOnlyAPoseAndPadding) {
  const Value plane = dict({{"type", "plane"}, {"pose", dict({{"xyz", xyz(0, 0, -0.5)}})}, {"padding", 0.1}});
  const Params params = paramsWith(list({dict({{"name", "floor"}, {"shapes", list({plane})}})}));
  ASSERT_EQ(params.obstacles.size(), 1u);
  const BodyShape& shape = params.obstacles[0].body.shapes.at(0);
  EXPECT_EQ(shape.shape.kind(), ShapeKind::plane);
  EXPECT_EQ(shape.padding, 0.1);
  EXPECT_EQ(shape.body_from_shape.translation().z(), -0.5);
  const Value sized = dict({{"type", "plane"}, {"size", xyz(1, 1, 1)}});
  EXPECT_TRUE(says(refusalOfObstacle(dict({{"name", "o"}, {"shapes", list({sized})}})),
                   "~obstacles[0]/shapes[0]/size is not a field"));
}

TEST(ObstacleParams, WhatIsWrongIsNamed) {
  const auto shaped = [](const Value& shape) {
    return refusalOfObstacle(dict({{"name", "o"}, {"shapes", list({shape})}}));
  };
  const Value sphere = ball("o", 0, 0, 0, 1);
  const auto posed = [&](const Value& pose) { return refusalOfObstacle(with(sphere, {{"pose", pose}})); };
  const std::pair<std::string, const char*> cases[] = {
      {shaped(dict({{"type", "hull"}})), "~obstacles[0]/shapes[0] has no 'vertices'; it must have one"},
      {shaped(dict({{"type", "mesh"}, {"vertices", corners()}})), "shapes[0] has no 'triangles'; it must have one"},
      {shaped(dict({{"type", "mesh"}, {"vertices", corners()}, {"triangles", list({triple(0, 1, 4)})}})),
       "~obstacles[0]/shapes[0]/triangles[0][2] is 4; it must be within 0 .. 3"},
      {shaped(dict({{"type", "mesh"}, {"vertices", corners()}, {"triangles", list({numbers({1, 2})})}})),
       "~obstacles[0]/shapes[0]/triangles[0] must be a list of 3 indices of vertices"},
      {shaped(dict({{"type", "hull"}, {"vertices", list({xyz(0, 0, std::nan(""))})}})),
       "~obstacles[0]/shapes[0] is not a valid shape: "},
      {shaped(dict({{"type", "sphere"}, {"radius", 1.0}, {"padding", -0.1}})),
       "~obstacles[0]/shapes[0]/padding is -0.1 m; it must be within 0 .. 1000 m"},
      {posed(dict({{"quaternion", numbers({0, 0, 0, 0})}})), "~obstacles[0]/pose/quaternion is not a rotation: "},
      {posed(dict({{"quaternion", numbers({0, 0, 1})}})),
       "~obstacles[0]/pose/quaternion has 3 elements; it must have 4: x, y, z, w"},
      {posed(dict({{"quaternion", numbers({0, 0, std::nan(""), 1})}})), "~obstacles[0]/pose/quaternion[2] is nan"},
      {posed(dict({{"quaternion", numbers({0, 0, 0, 1})}, {"rpy", xyz(0, 0, 0)}})),
       "~obstacles[0]/pose has rpy and quaternion; it must have only one of them"},
      {refusalOfObstacle(with(sphere, {{"moving", 1}})),
       "~obstacles[0]/moving is an integer; it must be true or false"},
      {refusalOfObstacle(with(sphere, {{"margin", -1.0}})),
       "~obstacles[0]/margin is -1 m; it must be within 0 .. 1000 m"},
      {refusalOfObstacle(with(sphere, {{"max_speed", -1.0}})), "~obstacles[0]/max_speed is -1 m/s; it must be within"},
      {refusalOfObstacle(with(sphere, {{"lifetime", -1.0}})), "~obstacles[0]/lifetime is -1 s; it must be within"},
      {refusalOfObstacle(with(sphere, {{"lost_at_end", "yes"}})),
       "~obstacles[0]/lost_at_end is a string ('yes'); it must be"},
      {refusalOfObstacle(with(sphere, {{"owner", "a\nb"}})), "~obstacles[0]/owner is 'a\\x0ab'; it must be UTF-8"},
  };
  for (const auto& [message, sentence] : cases) EXPECT_TRUE(says(message, sentence));
  EXPECT_EQ(refusalOfObstacle(rich()), "");
  // As a rule for what may touch it, this name would be a glob over other obstacles.
  const Value attached = dict({{"link", "arm/hand"}});
  const Value held = dict({{"name", "o*"}, {"shapes", list({dict({{"type", "sphere"}, {"radius", 1.0}})})}});
  EXPECT_TRUE(says(refusalOfObstacle(with(held, {{"attached", attached}})),
                   "~obstacles[0] is attached, but its name 'o*' contains *"));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
