// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <hgrid_proximity/Distances.h>
#include <hgrid_proximity/ExplainPair.h>
#include <hgrid_proximity/MeasureStatus.h>
#include <hgrid_proximity/QueryBox.h>
#include <hgrid_proximity/QueryNearest.h>
#include <hgrid_proximity/QueryShape.h>
#include <hgrid_proximity/SetAllowed.h>
#include <hgrid_proximity/ShapeKind.h>
#include <hgrid_proximity/UnknownReason.h>
#include <hgrid_proximity/Verdict.h>
#include <ros/service.h>
#include <ros/topic.h>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

using msg::Answer;
using msg::Distances;

/// A world with a sphere that follows the frame "rider", above a table whose top is at z = 0. It also has a box that is
/// rotated by 45 degrees. A post overlaps the AABB of this box, but not the box itself.
class DistancesNode : public ::testing::Test {
 protected:
  DistancesNode() : node_(setup()) {
    transforms_.stream("world", "rider", at(0.0, 0.0, 0.25));
    transforms_.fix({stamped("world", "turned", at(3.0, 0.0, 0.0, 0.78539816339744831))});
    node_.waitForComplete();
  }
  static NodeSetup setup() {
    NodeSetup setup;
    setup.params = dict(
        {{"world_frame", "world"},
         {"stale_after", 3600.0},
         {"lost_after", 3600.0},
         {"margin", 0.2},
         {"limits/min_size", 0.01},
         {"limits/max_size", 50.0},
         {"limits/allow_flat", true},
         {"limits/max_mesh_triangles", 4},
         {"distances", dict({{"max", 0.15}})},
         {"max_speed", list({dict({{"pattern", "obstacle/ball"}, {"speed", 0.5}})})},
         {"robots", list({dict({{"name", "none"}, {"description", "robot_description"}})})},
         {"accept_uncovered", list({waiver("none/*", "there is no robot")})},
         {"obstacles", list({box("table", xyz(0, 0, -0.5), xyz(2, 2, 1)), ball("ball", 0, 0, 0, 0.15, "rider"),
                             box("turned", xyz(0, 0, 0), xyz(1, 1, 1), "turned"), ball("post", 3.6, 0.6, 0, 0.05)})}});
    setup.beside["robot_description"] = urdf(link("world"));
    return setup;
  }
  Distances::ConstPtr next() {
    const auto message = ros::topic::waitForMessage<Distances>(node_.named("distances"), ros::Duration(20.0));
    if (!message) throw std::runtime_error("no message on ~distances within 20 s");
    return message;
  }
  template <class Service>
  typename Service::Response call(const std::string& name, typename Service::Request request) {
    typename Service::Response response;
    if (!ros::service::call(node_.named(name), request, response)) throw std::runtime_error(name + " does not answer");
    return response;
  }

  TransformSource transforms_;
  NodeUnderTest node_;
};

TEST_F(DistancesNode, SayHowFarShapesAreApart) {
  const auto message = next();
  EXPECT_TRUE(message->world.complete);
  EXPECT_EQ(message->header.frame_id, "world");
  ASSERT_EQ(message->names, std::vector<std::string>({"obstacle/ball", "obstacle/table"}));
  ASSERT_EQ(message->status.size(), 1u);
  EXPECT_EQ(message->status[0], msg::MeasureStatus::MEASURED);
  EXPECT_NEAR(message->distance[0], 0.1, 1e-9);
  EXPECT_NEAR(message->gap[0], 0.1, 1e-6);
  EXPECT_NEAR(message->lower_bound[0], message->distance[0], 1e-9);
  EXPECT_LE(message->lower_bound[0], message->distance[0]);
  EXPECT_EQ(message->measured[0], message->header.stamp);
  EXPECT_NEAR(message->point_on_first[0].z, 0.1, 1e-9);
  EXPECT_NEAR(message->point_on_second[0].z, 0.0, 1e-9);
  EXPECT_NEAR(message->normal[0].z, -1.0, 1e-9);
  EXPECT_TRUE(std::isnan(message->depth[0]));
  EXPECT_LE(message->no_contact_before[0], 0.1 / 0.5 + 1e-9) << "max_speed of the sphere is 0.5 m/s";
  EXPECT_GT(message->no_contact_before[0], 0.0);
  EXPECT_EQ(message->total, 1u);
  EXPECT_FALSE(message->truncated);
}

TEST_F(DistancesNode, AreEmptyWhereNothingIsNearAndSayContactWhereThereIs) {
  transforms_.stream("world", "rider", at(0.0, 0.0, 5.0));
  node_.waitForPairs("the sphere far away", [](const msg::Pairs& pairs) { return pairs.total == 1; });
  EXPECT_EQ(next()->total, 0u);
  transforms_.stream("world", "rider", at(0.0, 0.0, 0.1));
  node_.waitForPairs("the sphere in the table",
                     [](const msg::Pairs& pairs) { return pairs.total == 2 && pairs.gap[0] == 0.0; });
  const auto message = next();
  ASSERT_EQ(message->status.size(), 1u);
  EXPECT_EQ(message->status[0], msg::MeasureStatus::CONTACT);
  EXPECT_EQ(message->distance[0], 0.0);
  EXPECT_NEAR(message->depth[0], 0.05, 1e-9);
  EXPECT_EQ(message->time_to_contact[0], 0.0);
}

TEST_F(DistancesNode, ExactQueriesMeetShapesNotTheirBoxes) {
  msg::QuerySphere::Request sphere;  // in a corner of the AABB of the rotated box, but outside the box
  sphere.center.x = 3.6;
  sphere.center.y = 0.6;
  sphere.radius = 0.1;
  sphere.exclude = {"obstacle/post"};
  EXPECT_EQ(node_.ask(sphere).answer.verdict, msg::Verdict::HIT);
  sphere.exact = true;
  EXPECT_EQ(node_.ask(sphere).answer.verdict, msg::Verdict::CLEAR);
  sphere.radius = 0.4;
  const Answer answer = node_.ask(sphere).answer;
  ASSERT_EQ(answer.hits.size(), 1u);
  EXPECT_EQ(answer.hits[0].status, msg::MeasureStatus::MEASURED);
  EXPECT_NEAR(answer.hits[0].center_distance, 0.6 * std::sqrt(2.0) - 0.5, 1e-9);
  EXPECT_NEAR(answer.hits[0].normal.x, std::sqrt(0.5), 1e-6);
  msg::QuerySegment::Request segment;
  segment.start.y = segment.end.y = 0.2;
  segment.end.x = 5.0;
  segment.exact = true;
  segment.include = {"obstacle/turned"};
  const Answer met = node_.ask(segment).answer;
  ASSERT_EQ(met.hits.size(), 1u);
  EXPECT_NEAR(met.hits[0].along, 3.0 - std::sqrt(0.5) + 0.2, 1e-6);
}

TEST_F(DistancesNode, BoxesAndNearestAnswer) {
  msg::QueryBox::Request box;
  box.pose.position.x = 3.6;
  box.pose.position.y = 0.6;
  box.size.x = box.size.y = box.size.z = 0.2;
  const auto by_boxes = call<msg::QueryBox>("query_box", box).answer;
  EXPECT_EQ(namesOf(by_boxes).size(), 2u) << by_boxes.summary;
  box.exact = true;
  EXPECT_EQ(namesOf(call<msg::QueryBox>("query_box", box).answer), std::vector<std::string>({"obstacle/post"}));
  box.size.x = -1.0;
  EXPECT_EQ(call<msg::QueryBox>("query_box", box).answer.code.name, "BAD_GEOMETRY");

  msg::QueryNearest::Request nearest;
  nearest.body = "obstacle/post";
  nearest.exact = true;
  nearest.limit = 2;
  const auto found = call<msg::QueryNearest>("query_nearest", nearest).answer;
  ASSERT_EQ(found.hits.size(), 2u);
  EXPECT_EQ(found.hits[0].name, "obstacle/turned");
  EXPECT_NEAR(found.hits[0].distance, 0.6 * std::sqrt(2.0) - 0.5 - 0.05, 1e-9);
  EXPECT_FALSE(std::isnan(found.hits[0].own_point.x));
  EXPECT_EQ(found.total, 2u);
  EXPECT_FALSE(found.truncated);
  nearest.body = "obstacle/nobody";
  EXPECT_EQ(call<msg::QueryNearest>("query_nearest", nearest).answer.code.name, "UNKNOWN_ID");
  nearest.body.clear();
  nearest.point.x = 100.0;
  nearest.max_distance = 1.0;
  EXPECT_EQ(call<msg::QueryNearest>("query_nearest", nearest).answer.verdict, msg::Verdict::CLEAR);
}

/// Claim: query_shape tests the shape itself, not its AABB. It refuses kinds of shapes that it cannot measure.
TEST_F(DistancesNode, QueryShapeTestsTheShapeAtItsPose) {
  msg::QueryShape::Request request;
  request.shape.kind = msg::ShapeKind::CYLINDER;
  request.shape.dimensions = {0.2, 0.1};
  request.shape.pose.position.x = 3.6;  // on the post, in a corner of the AABB of the rotated box
  request.shape.pose.position.y = 0.6;
  request.exact = true;
  EXPECT_EQ(namesOf(call<msg::QueryShape>("query_shape", request).answer), std::vector<std::string>({"obstacle/post"}));
  request.shape.padding = 0.4;
  EXPECT_EQ(namesOf(call<msg::QueryShape>("query_shape", request).answer).size(), 2u);
  request.shape.padding = 0.0;
  request.shape.pose.position.x = 30.0;
  EXPECT_EQ(call<msg::QueryShape>("query_shape", request).answer.verdict, msg::Verdict::CLEAR);

  request.shape.dimensions = {0.2};
  EXPECT_EQ(call<msg::QueryShape>("query_shape", request).answer.code.name, "BAD_GEOMETRY");
  request.shape.kind = msg::ShapeKind::PLANE;
  request.shape.dimensions.clear();
  EXPECT_EQ(call<msg::QueryShape>("query_shape", request).answer.code.name, "UNSUPPORTED");
  request.shape.kind = 200;
  EXPECT_EQ(call<msg::QueryShape>("query_shape", request).answer.code.name, "UNSUPPORTED");
}

/// Returns the request of a shape far from everything, so that the answer to a valid shape is CLEAR.
msg::QueryShape::Request shapeRequest(int kind, const std::vector<double>& dimensions) {
  msg::QueryShape::Request request;
  request.shape.kind = static_cast<std::uint8_t>(kind);
  request.shape.dimensions = dimensions;
  request.shape.pose.position.x = 300.0;
  return request;
}

/// Returns the request of a mesh that has this many triangles in a row.
msg::QueryShape::Request meshRequest(std::size_t triangles) {
  msg::QueryShape::Request request = shapeRequest(msg::ShapeKind::MESH, {});
  for (std::size_t i = 0; i <= triangles + 1; ++i) {
    request.shape.mesh.vertices.emplace_back();
    request.shape.mesh.vertices.back().x = 0.1 * static_cast<double>(i);
    request.shape.mesh.vertices.back().y = i % 2 == 0 ? 0.0 : 0.1;
  }
  request.shape.mesh.triangles.resize(triangles);
  for (std::uint32_t i = 0; i < triangles; ++i) request.shape.mesh.triangles[i].vertex_indices = {i, i + 1, i + 2};
  return request;
}

/// Claim: the shape of a query has the same limits as all other shapes: ~limits/min_size, ~limits/max_size, ~limits/allow_flat and
/// ~limits/max_mesh_triangles.
TEST_F(DistancesNode, QueryShapeKeepsTheLimitsOfAllShapes) {
  const auto answer = [&](const msg::QueryShape::Request& request) {
    return call<msg::QueryShape>("query_shape", request).answer;
  };
  const auto sphere = [&](double radius) { return answer(shapeRequest(msg::ShapeKind::SPHERE, {radius})); };
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL, 1e-320, 1e308, 0.009, 50.1}) {
    EXPECT_EQ(sphere(bad).code.name, "BAD_GEOMETRY") << bad;
    EXPECT_EQ(answer(shapeRequest(msg::ShapeKind::CYLINDER, {bad, 0.1})).code.name, "BAD_GEOMETRY") << bad;
  }
  EXPECT_TRUE(says(sphere(0.009).code.text, "radius is 0.009 m; it must be within 0.01 .. 50 m"));
  for (const double good : {0.01, 50.0}) EXPECT_EQ(sphere(good).verdict, msg::Verdict::CLEAR) << good;
  EXPECT_EQ(answer(shapeRequest(msg::ShapeKind::BOX, {1.0, 1.0, 0.0})).verdict, msg::Verdict::CLEAR) << "~limits/allow_flat";
  EXPECT_EQ(answer(shapeRequest(msg::ShapeKind::BOX, {1.0, 0.0, 0.0})).code.name, "BAD_GEOMETRY");
  EXPECT_EQ(answer(meshRequest(4)).verdict, msg::Verdict::CLEAR);
  const Answer refused = answer(meshRequest(5));
  EXPECT_EQ(refused.code.name, "LIMIT");
  EXPECT_TRUE(says(refused.code.text, "has 5 triangles and 7 vertices; at most 4 triangles (~limits/max_mesh_triangles)"));
  msg::QueryShape::Request far = meshRequest(1);
  far.shape.mesh.vertices[0].z = 51.0;
  EXPECT_EQ(answer(far).code.name, "OUT_OF_RANGE") << "a vertex beyond ~limits/max_size";
}

/// Claim: a rotation of four zeros in a request means no rotation. Any other value that is no rotation is refused.
TEST_F(DistancesNode, AShapeWithARotationOfFourZerosIsNotRotated) {
  msg::QueryShape::Request request = shapeRequest(msg::ShapeKind::BOX, {2.0, 0.1, 0.1});
  request.shape.pose.position.x = 2.6;  // reaches the post, which is at x = 3.6, only if it is not rotated
  request.shape.pose.position.y = 0.6;
  request.exact = true;
  request.include = {"obstacle/post"};
  EXPECT_EQ(call<msg::QueryShape>("query_shape", request).answer.verdict, msg::Verdict::HIT);
  request.shape.pose.orientation.w = 1.0;
  EXPECT_EQ(call<msg::QueryShape>("query_shape", request).answer.verdict, msg::Verdict::HIT);
  request.shape.pose.orientation.w = request.shape.pose.orientation.z = std::sqrt(0.5);
  EXPECT_EQ(call<msg::QueryShape>("query_shape", request).answer.verdict, msg::Verdict::CLEAR)
      << "rotated by 90 degrees";
  request.shape.pose.orientation.w = request.shape.pose.orientation.z = 1e-200;
  EXPECT_EQ(call<msg::QueryShape>("query_shape", request).answer.code.name, "BAD_ROTATION");
}

TEST_F(DistancesNode, AllowedPairsAreLeftOutOfAQueryOnRequest) {
  msg::QuerySphere::Request sphere;  // around the obstacle "ball", above the table
  sphere.center.z = 0.25;
  sphere.radius = 0.3;
  EXPECT_EQ(namesOf(node_.ask(sphere).answer), std::vector<std::string>({"obstacle/ball", "obstacle/table"}));
  sphere.respect_allowed = true;
  EXPECT_EQ(node_.ask(sphere).answer.code.name, "BAD_ID") << "respect_allowed needs as_body";
  sphere.as_body = "obstacle/nobody";
  EXPECT_EQ(node_.ask(sphere).answer.code.name, "UNKNOWN_ID");
  sphere.as_body = "obstacle/ball";
  EXPECT_EQ(namesOf(node_.ask(sphere).answer), std::vector<std::string>({"obstacle/table"}));
  msg::SetAllowed::Request allow;
  allow.rules.resize(1);
  allow.rules[0].first = "obstacle/ball";
  allow.rules[0].second = "obstacle/table";
  allow.rules[0].allowed = true;
  EXPECT_EQ(call<msg::SetAllowed>("set_allowed", allow).pairs_changed, 1u);
  EXPECT_EQ(node_.ask(sphere).answer.verdict, msg::Verdict::CLEAR);
}

TEST_F(DistancesNode, AQueryWithoutTimeIsUnknownAndANegativeTimeIsRefused) {
  msg::QuerySphere::Request sphere;
  sphere.center.z = 0.25;
  sphere.radius = 0.3;
  sphere.max_time = 1e-9;
  const Answer answer = node_.ask(sphere).answer;
  EXPECT_TRUE(answer.success);
  EXPECT_EQ(answer.verdict, msg::Verdict::UNKNOWN) << answer.summary;
  EXPECT_EQ(answer.unknown_because, msg::UnknownReason::BUDGET);
  sphere.max_time = 60.0;
  EXPECT_EQ(node_.ask(sphere).answer.verdict, msg::Verdict::HIT);
  sphere.max_time = -1.0;
  EXPECT_EQ(node_.ask(sphere).answer.code.name, "OUT_OF_RANGE");
}

TEST_F(DistancesNode, HitsSayHowDeepTheQueryIs) {
  msg::QuerySphere::Request sphere;  // the lowest point is 0.05 m below the top of the table
  sphere.center.x = -0.7;
  sphere.center.z = 0.25;
  sphere.radius = 0.3;
  sphere.include = {"obstacle/table"};
  for (const bool exact : {false, true}) {
    sphere.exact = exact;
    const Answer answer = node_.ask(sphere).answer;
    ASSERT_EQ(answer.hits.size(), 1u);
    EXPECT_EQ(answer.hits[0].distance, 0.0);
    EXPECT_NEAR(answer.hits[0].depth, 0.05, 1e-6);
    EXPECT_NEAR(answer.hits[0].signed_distance, -0.05, 1e-6);
    EXPECT_FALSE(answer.hits[0].carried);
  }
}

TEST_F(DistancesNode, ExplainPairMeasures) {
  msg::ExplainPair::Request request;
  request.first = "obstacle/table";
  request.second = "obstacle/ball";
  const auto answer = call<msg::ExplainPair>("explain_pair", request);
  EXPECT_TRUE(answer.success);
  EXPECT_TRUE(answer.reported);
  EXPECT_EQ(answer.narrow_status, msg::MeasureStatus::MEASURED);
  EXPECT_NEAR(answer.distance, 0.1, 1e-9);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
