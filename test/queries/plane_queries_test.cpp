// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Queries, distances and explanations in worlds with planes, compared with formulas in extended precision.
#include <gtest/gtest.h>

#include "hgrid_proximity/distances/pair_distance.h"
#include "hgrid_proximity/distances/pair_meter.h"
#include "hgrid_proximity/explain/explain.h"
#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/queries/query.h"
#include "test/support/plane_oracle.h"
#include "test/support/refusals.h"
#include "test/support/scenes.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace {

using test::at;
using test::Random;
using Wide = Eigen::Matrix<long double, 3, 1>;

/// A world with planes and balls around a point that may be far from the origin.
class PlaneWorld {
 public:
  explicit PlaneWorld(unsigned seed) : random(seed), narrow_phase(makeCoreNarrowPhase()) {
    if (random.chance(0.3)) center = test::randomVector(random, -9e5, 9e5);
    if (random.chance(0.5)) options.origin = center + test::randomVector(random, -5, 5);
    Scene scene(options);
    for (int i = random.between(1, 5); i > 0; --i) {
      Body body = test::planeBody("plane" + std::to_string(i));
      body.shapes.back().solid = narrow_phase->plane();
      if (random.chance(0.5)) body.shapes.back().padding = random.uniform(0, 0.5);
      test::put(scene, body, randomPose());
    }
    for (int i = 6; i > 0; --i) {
      Body body = test::ball("ball" + std::to_string(i), random.uniform(0.1, 0.5));
      body.shapes.back().solid = narrow_phase->solidOf(body.shapes.back().shape);
      test::put(scene, body, randomPose());
    }
    snapshot = scene.commit(Time{1}, {});
  }

  Pose randomPose() {
    Pose pose = test::randomPose(random, 3.0);
    pose.translation() += center;
    return pose;
  }
  Eigen::Vector3d randomPoint() { return center + test::randomVector(random, -4, 4); }

  /// Returns the signed distance [m] of a point [m, world] from the plane of a body.
  long double height(std::uint32_t body, const Eigen::Vector3d& point) const {
    const Pose& pose = snapshot->poses()[body].world_from_body;
    const Wide normal = pose.linear().col(2).cast<long double>();
    return normal.dot(point.cast<long double>() - pose.translation().cast<long double>()) -
           snapshot->structure().bodies[body].shapes[0].padding;
  }
  /// Returns the normal of the plane of a body.
  Eigen::Vector3d normal(std::uint32_t body) const { return snapshot->poses()[body].world_from_body.linear().col(2); }
  bool isPlane(std::uint32_t body) const { return snapshot->structure().hasPlane(body); }
  double tolerance() const { return 1e-14 * center.cwiseAbs().maxCoeff() + 1e-12; }

  Random random;
  std::shared_ptr<NarrowPhase> narrow_phase;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // [m, world]
  SceneOptions options;
  std::shared_ptr<const Snapshot> snapshot;
};

/// Returns the hit of a body; null if there is none.
const QueryHit* hitOf(const QueryAnswer& answer, std::uint32_t body) {
  for (const QueryHit& hit : answer.hits) {
    if (hit.body == body) return &hit;
  }
  return nullptr;
}

/// Expects that exactly the planes with a height of at most 0 are hits, with this signed distance.
/// @param slack  [m] a plane at most this far away may be a hit, too
void expectPlanes(const PlaneWorld& world, const QueryAnswer& answer, double slack,
                  const std::function<double(std::uint32_t)>& signed_distance) {
  for (std::uint32_t body = 0; body < world.snapshot->structure().bodies.size(); ++body) {
    if (!world.isPlane(body)) continue;
    const double expected = signed_distance(body);
    const QueryHit* hit = hitOf(answer, body);
    if (hit == nullptr) {
      ASSERT_GT(expected, -world.tolerance()) << world.snapshot->structure().bodies[body].name << " is missing";
      continue;
    }
    ASSERT_LE(expected, slack + world.tolerance()) << world.snapshot->structure().bodies[body].name;
    ASSERT_NEAR(hit->signed_distance, expected, world.tolerance());
    ASSERT_NEAR(hit->distance, std::max(0.0, expected), world.tolerance());
    if (expected < -world.tolerance()) {
      ASSERT_NEAR(hit->depth, -expected, world.tolerance());
    }
    ASSERT_TRUE(hit->point.allFinite());
    if (hit->status == Measure::not_measured) continue;
    ASSERT_EQ(hit->normal, world.normal(body));
    ASSERT_NEAR(double(world.height(body, hit->point)), 0.0, 4.0 * world.tolerance());
  }
}

TEST(PlaneQueries, SphereHitsExactlyThePlanesItTouches) {
  int hits = 0;
  for (unsigned seed = 1; seed <= 1500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    PlaneWorld world(seed);
    QueryScope scope;
    if (seed % 2 == 0) scope.exact = world.narrow_phase.get();
    const Sphere sphere{world.randomPoint(), world.random.uniform(0, 2)};
    const QueryAnswer answer = query(*world.snapshot, sphere, scope);
    const double slack = 1e-9 * (sphere.center.norm() + sphere.radius);
    ASSERT_NO_FATAL_FAILURE(expectPlanes(world, answer, slack, [&](std::uint32_t body) {
      return double(world.height(body, sphere.center) - sphere.radius);
    }));
    for (const QueryHit& hit : answer.hits) hits += world.isPlane(hit.body);
    ASSERT_EQ(answer.verdict, answer.hits.empty() ? Verdict::clear : Verdict::hit);
  }
  EXPECT_GT(hits, 1000);
}

TEST(PlaneQueries, SegmentHitsExactlyThePlanesItTouchesAndSaysWhere) {
  for (unsigned seed = 1; seed <= 1500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    PlaneWorld world(seed);
    QueryScope scope;
    if (seed % 2 == 0) scope.exact = world.narrow_phase.get();
    Segment segment{world.randomPoint(), world.randomPoint(), world.random.uniform(0, 0.5)};
    if (seed % 10 == 0) segment.to = segment.from;
    const double length = (segment.to - segment.from).norm();
    const QueryAnswer answer = query(*world.snapshot, segment, scope);
    const double slack = 1e-9 * (segment.from.norm() + segment.radius + length);
    ASSERT_NO_FATAL_FAILURE(expectPlanes(world, answer, slack, [&](std::uint32_t body) {
      return double(std::min(world.height(body, segment.from), world.height(body, segment.to)) - segment.radius);
    }));
    for (const QueryHit& hit : answer.hits) {
      if (!world.isPlane(hit.body)) continue;
      ASSERT_GE(hit.along, 0.0);
      ASSERT_LE(hit.along, length);
      const Eigen::Vector3d at = length > 0.0
                                     ? Eigen::Vector3d(segment.from + hit.along / length * (segment.to - segment.from))
                                     : segment.from;
      const double height = double(world.height(hit.body, at)) - segment.radius;
      if (hit.along > 0.0) {
        ASSERT_NEAR(height, 0.0, slack + 1e-9);  // the sphere touches the plane there first
      } else {
        ASSERT_LE(height, slack + world.tolerance());
      }
    }
  }
}

TEST(PlaneQueries, BoxesAndShapesHitExactlyThePlanesTheyTouch) {
  for (unsigned seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    PlaneWorld world(seed);
    QueryScope scope;
    if (seed % 2 == 0) scope.exact = world.narrow_phase.get();
    const QueryBox box{world.randomPose(), test::randomVector(world.random, 0.1, 2.0)};
    const auto heightOfBox = [&](std::uint32_t body) {
      long double least = std::numeric_limits<long double>::infinity();
      for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3d sign(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
        const Eigen::Vector3d point = box.world_from_box * Eigen::Vector3d(sign.cwiseProduct(box.size));
        least = std::min(least, world.height(body, point));
      }
      return double(least);
    };
    const double slack = 1e-9 * (box.world_from_box.translation().norm() + 4.0) + 1e-9;
    const QueryAnswer of_box = query(*world.snapshot, box, *world.narrow_phase, scope);
    const QueryAnswer of_shape =
        query(*world.snapshot, QueryShape{Shape::box(box.size), box.world_from_box, 0.25}, *world.narrow_phase, scope);
    for (std::uint32_t body = 0; body < world.snapshot->structure().bodies.size(); ++body) {
      if (!world.isPlane(body)) continue;
      for (const double padding : {0.0, 0.25}) {
        const double expected = heightOfBox(body) - padding;
        const QueryHit* hit = hitOf(padding > 0.0 ? of_shape : of_box, body);
        ASSERT_TRUE(hit != nullptr || expected > -world.tolerance());
        if (hit == nullptr) continue;
        ASSERT_LE(expected, slack);
        ASSERT_EQ(hit->distance, 0.0);
        ASSERT_NEAR(hit->signed_distance, expected, slack);
        ASSERT_NEAR(hit->center_distance, std::max(0.0, double(world.height(body, box.world_from_box.translation()))),
                    world.tolerance());
      }
    }
  }
}

TEST(PlaneQueries, NearestToAPointOrBodyFindsThePlaneIfItIsNearest) {
  int planes = 0;
  for (unsigned seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    PlaneWorld world(seed);
    QueryScope scope;
    scope.limit = 20;
    scope.exact = world.narrow_phase.get();
    const Eigen::Vector3d point = world.randomPoint();
    const QueryAnswer answer = nearest(*world.snapshot, point, 0.0, scope);
    ASSERT_EQ(answer.hits.size(), world.snapshot->structure().bodies.size());
    ASSERT_NO_FATAL_FAILURE(
        expectPlanes(world, answer, 1e9, [&](std::uint32_t body) { return double(world.height(body, point)); }));
    for (std::size_t i = 1; i < answer.hits.size(); ++i) {
      ASSERT_LE(answer.hits[i - 1].distance, answer.hits[i].distance);
    }
    planes += world.isPlane(answer.hits[0].body);
    scope.limit = 1;
    ASSERT_EQ(nearest(*world.snapshot, point, 0.0, scope).hits[0].body, answer.hits[0].body);

    const std::uint32_t ball = world.snapshot->structure().find("obstacle/ball1");
    for (const bool exact : {true, false}) {
      scope.limit = 20;
      scope.exact = exact ? world.narrow_phase.get() : nullptr;
      const QueryAnswer from_ball = nearest(*world.snapshot, ball, 0.0, scope);
      ASSERT_EQ(from_ball.hits.size() + 1, world.snapshot->structure().bodies.size());
      for (const QueryHit& hit : from_ball.hits) {
        if (!world.isPlane(hit.body)) continue;
        const Pose& pose = world.snapshot->poses()[ball].world_from_body;
        const double radius = world.snapshot->structure().bodies[ball].shapes[0].shape.dimensions()[0];
        const double of_ball = double(world.height(hit.body, pose.translation())) - radius;
        if (exact) {
          ASSERT_NEAR(hit.signed_distance, of_ball, world.tolerance());
        } else {
          const double of_box = world.snapshot->gapOf(ball, hit.body);
          ASSERT_NEAR(hit.distance, of_box, 1e-12 + 1e-13 * world.center.norm());
          ASSERT_LE(hit.signed_distance, of_ball + world.tolerance());
        }
        ASSERT_NEAR((hit.own_point - hit.point).dot(world.normal(hit.body)), exact ? hit.signed_distance : hit.distance,
                    8.0 * world.tolerance());
      }
    }
  }
  EXPECT_GT(planes, 300);
}

TEST(PlaneQueries, NearestWithALimitLeavesOutFartherPlanes) {
  Scene scene(SceneOptions{});
  test::put(scene, test::planeBody("floor"), at(0));
  test::put(scene, test::ball("ball"), at(0, 0, 3));
  const auto snapshot = scene.commit(Time{1}, {});
  EXPECT_EQ(nearest(*snapshot, Eigen::Vector3d(9, 9, 2), 1.9, {}).verdict, Verdict::clear);
  EXPECT_EQ(nearest(*snapshot, Eigen::Vector3d(9, 9, 2), 2.1, {}).verdict, Verdict::hit);
  const std::uint32_t ball = snapshot->structure().find("obstacle/ball");
  EXPECT_EQ(nearest(*snapshot, ball, 2.4, {}).verdict, Verdict::clear);
  EXPECT_EQ(nearest(*snapshot, ball, 2.6, {}).verdict, Verdict::hit);
}

TEST(PlaneQueries, StaleAskingBodyCountsAPlaneOnlyIfItCanReachIt) {
  const auto phase = makeCoreNarrowPhase();
  Scene scene(SceneOptions{});
  Body floor = test::planeBody("floor");
  floor.shapes.back().solid = phase->plane();
  test::put(scene, floor, at(0));
  Body ball = test::ball("ball");
  ball.max_speed = 1.0;
  ball.shapes.back().solid = phase->solidOf(ball.shapes.back().shape);
  const BodyId id = test::put(scene, ball, at(0, 0, 3));
  scene.setState(id, Freshness::stale, 1.0);
  const auto snapshot = scene.commit(Time{1}, {});
  const std::uint32_t asking = snapshot->structure().find("obstacle/ball");
  for (const NarrowPhase* exact :
       {static_cast<const NarrowPhase*>(nullptr), static_cast<const NarrowPhase*>(phase.get())}) {
    QueryScope scope;
    scope.exact = exact;
    EXPECT_EQ(nearest(*snapshot, asking, 1.0, scope).verdict, Verdict::clear);
    EXPECT_EQ(nearest(*snapshot, asking, 2.0, scope).verdict, Verdict::unknown);
    EXPECT_EQ(nearest(*snapshot, asking, 2.6, scope).verdict, Verdict::hit);
  }
}

TEST(PlaneQueries, DeadlineThatHasPassedExaminesNoPlane) {
  PlaneWorld world(3);
  QueryScope scope;
  scope.deadline = std::chrono::steady_clock::now() - std::chrono::seconds(1);
  const QueryAnswer answer = query(*world.snapshot, Sphere{world.center, 100.0}, scope);
  EXPECT_FALSE(answer.examined_all);
  EXPECT_EQ(answer.total, 0u);
  EXPECT_EQ(answer.because, Unknown::budget);
}

TEST(PlaneQueries, PlanesAsQuestionsAreRefused) {
  PlaneWorld world(4);
  std::string sentence;
  EXPECT_EQ(test::refusalOf(
                [&] {
                  query(*world.snapshot, QueryShape{Shape::plane(), Pose::Identity(), 0.0}, *world.narrow_phase, {});
                },
                &sentence),
            Code::unsupported);
  EXPECT_TRUE(test::says(sentence, "plane"));
  const std::uint32_t plane = world.snapshot->structure().find("obstacle/plane1");
  EXPECT_EQ(test::refusalOf([&] { nearest(*world.snapshot, plane, 0.0, {}); }, &sentence), Code::unsupported);
  EXPECT_TRUE(test::says(sentence, "obstacle/plane1"));
}

TEST(PlaneDistances, AreThoseOfTheShapesAndAreKeptWhileNothingMoves) {
  int measured = 0, contacts = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    PlaneWorld world(seed);
    PairMeter meter(world.narrow_phase, {});
    for (int round = 0; round < 2; ++round) {
      const auto distances = meter.measure(*world.snapshot);
      for (const PairDistance& pair : distances->pairs) {
        const bool first = world.isPlane(pair.first);
        if (!first && !world.isPlane(pair.second)) continue;
        const std::uint32_t plane = first ? pair.first : pair.second, ball = first ? pair.second : pair.first;
        const double radius = world.snapshot->structure().bodies[ball].shapes[0].shape.dimensions()[0];
        const double height =
            double(world.height(plane, world.snapshot->poses()[ball].world_from_body.translation())) - radius;
        ASSERT_NEAR(pair.proximity.distance, std::max(0.0, height), world.tolerance());
        ASSERT_LE(pair.gap, pair.proximity.distance + world.tolerance());
        ASSERT_EQ(pair.measured, world.snapshot->stamp());
        ++measured;
        if (height > -world.tolerance()) continue;
        ASSERT_EQ(contactsOf(*world.narrow_phase, *world.snapshot, pair.first, pair.second, 10).size(), 1u);
        ++contacts;
      }
    }
  }
  EXPECT_GT(measured, 1000);
  EXPECT_GT(contacts, 500);
}

TEST(PlaneDistances, LowerBoundFollowsAMovingBody) {
  const auto phase = makeCoreNarrowPhase();
  SceneOptions options;
  options.margin = 1.0;
  Scene scene(options);
  Body floor = test::planeBody("floor");
  floor.shapes.back().solid = phase->plane();
  test::put(scene, floor, at(0));
  for (const char* name : {"a_ball", "z_ball"}) {  // before and after the floor
    Body ball = test::ball(name);
    ball.speed_bound = 2.0;
    ball.shapes.back().solid = phase->solidOf(ball.shapes.back().shape);
    const BodyId id = test::put(scene, ball, at(0, 0, 1.25));
    MeterOptions meter_options;
    meter_options.report_distance = 0.5;  // the pair is farther apart
    PairMeter meter(phase, meter_options);
    EXPECT_TRUE(meter.measure(*scene.commit(Time{1}, {}))->pairs.empty());
    scene.place(id, at(0, 0, 0.75), Time{2});
    const auto near = meter.measure(*scene.commit(Time{2}, {}));
    ASSERT_EQ(near->pairs.size(), 1u);
    EXPECT_NEAR(near->pairs[0].proximity.distance, 0.25, 1e-12);
    EXPECT_NEAR(near->pairs[0].no_contact_before, 0.125, 1e-9) << "the plane is fixed, so only the ball moves";
    scene.remove(id);
  }
}

TEST(PlaneExplanations, SayWhyAPairIsReportedOrNot) {
  SceneOptions options;
  options.margin = 0.1;
  Scene scene(options);
  test::put(scene, test::planeBody("floor"), at(0));
  test::put(scene, test::planeBody("wall"), at(1));
  test::put(scene, test::ball("near"), at(0, 0, 0.55));
  test::put(scene, test::ball("far"), at(0, 0, 2.5));
  const auto snapshot = scene.commit(Time{1}, {});
  const Explanation near = explain(*snapshot, "obstacle/floor", "obstacle/near", nullptr);
  EXPECT_TRUE(near.reported);
  EXPECT_NEAR(near.gap, 0.05, 1e-6);
  const Explanation far = explain(*snapshot, "obstacle/far", "obstacle/floor", nullptr);
  EXPECT_FALSE(far.reported);
  EXPECT_NEAR(far.gap, 2.0, 1e-6);
  EXPECT_TRUE(test::says(far.text, "their boxes are 2 m apart, more than the margin of 0.1 m"));
  const Explanation planes = explain(*snapshot, "obstacle/floor", "obstacle/wall", nullptr);
  EXPECT_FALSE(planes.reported);
  EXPECT_TRUE(std::isnan(planes.gap));
  EXPECT_TRUE(test::says(planes.text, "both are fixed in the world"));
  EXPECT_EQ(planes.text.find("has no"), std::string::npos) << planes.text;
}

}  // namespace
}  // namespace hgrid
