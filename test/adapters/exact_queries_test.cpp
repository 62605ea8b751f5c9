// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares exact queries with measurements of all shapes of all bodies, and with answers that are known in advance.
#include <gtest/gtest.h>

#include <map>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/queries/query.h"
#include "test/support/scenes.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace {

using test::at;
using test::put;
using test::Random;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class ExactQueries : public ::testing::Test {
 protected:
  BodyId add(Body body, const Pose& pose) {
    for (BodyShape& shape : body.shapes) shape.solid = phase_->solidOf(shape.shape);
    return put(scene_, body, pose);
  }
  void fill(unsigned seed, int count) {
    Random random(seed);
    for (int i = 0; i < count; ++i) {
      add(test::randomBody(random, std::to_string(i)), test::randomPose(random, 2.0));
    }
    snapshot_ = scene_.commit(Time{1}, {});
  }
  QueryScope exactly(std::uint32_t limit = 0) const {
    QueryScope scope;
    scope.limit = limit;
    scope.exact = phase_.get();
    return scope;
  }
  /// Returns the least distance [m] between a solid and the shapes of a body.
  /// @param surely  leaves out open meshes that may or may not enclose the solid
  double distanceTo(const Solid& solid, const Pose& pose, double padding, std::uint32_t body,
                    bool surely = false) const {
    double least = kInfinity;
    for (const BodyShape& shape : snapshot_->structure().bodies[body].shapes) {
      const Pose world_from_shape = snapshot_->poses()[body].world_from_body * shape.body_from_shape;
      const Proximity found =
          phase_->measure({solid, pose, padding}, {*shape.solid, world_from_shape, shape.padding}, kInfinity);
      if (!(surely && found.status == Measure::containment_unknown)) least = std::min(least, found.distance);
    }
    return least;
  }
  double leastDistance(bool exact, bool from_body, std::uint32_t from, const Eigen::Vector3d& point,
                       std::uint32_t body) const {
    const Structure& structure = snapshot_->structure();
    double least = kInfinity;
    if (exact && !from_body) return distanceTo(*phase_->point(), at(point.x(), point.y(), point.z()), 0.0, body);
    if (exact) {
      for (const BodyShape& shape : structure.bodies[from].shapes) {
        const Pose pose = snapshot_->poses()[from].world_from_body * shape.body_from_shape;
        least = std::min(least, distanceTo(*shape.solid, pose, shape.padding, body));
      }
      return least;
    }
    for (ProxyId j = structure.first_proxy[body]; j < structure.first_proxy[body + 1]; ++j) {
      if (!from_body) least = std::min(least, distance(snapshot_->boxes()[j], point));
      for (ProxyId i = structure.first_proxy[from]; from_body && i < structure.first_proxy[from + 1]; ++i) {
        least = std::min(least, distance(snapshot_->boxes()[i], snapshot_->boxes()[j]));
      }
    }
    return least;
  }
  template <class DistanceTo>
  void expectHits(const QueryAnswer& answer, const DistanceTo& distanceTo, double limit) const {
    std::map<std::uint32_t, QueryHit> hits;
    for (const QueryHit& hit : answer.hits) ASSERT_TRUE(hits.emplace(hit.body, hit).second) << "a body is listed twice";
    for (std::uint32_t body = 0; body < snapshot_->structure().bodies.size(); ++body) {
      const double distance = distanceTo(body);
      SCOPED_TRACE(std::to_string(body) + " at " + std::to_string(distance));
      if (hits.count(body) == 0) {
        ASSERT_GT(distance, limit) << "a hit is missing";
        continue;
      }
      ASSERT_LE(distance, limit + 1e-7) << "a hit is too far away";
      ASSERT_NEAR(hits[body].center_distance, distance, 1e-6);
    }
  }

  std::shared_ptr<NarrowPhase> phase_ = makeCoreNarrowPhase();
  Scene scene_{SceneOptions{}};
  std::shared_ptr<const Snapshot> snapshot_;
};

TEST_F(ExactQueries, SpheresFindExactlyTheShapesTheyTouch) {
  fill(1, 60);
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    const Sphere sphere{test::randomVector(random, -3, 3), i % 5 == 0 ? 0.0 : random.uniform(0, 1)};
    const QueryAnswer answer = query(*snapshot_, sphere, exactly());
    expectHits(
        answer,
        [&](std::uint32_t body) {
          return distanceTo(*phase_->point(), at(sphere.center.x(), sphere.center.y(), sphere.center.z()), 0.0, body);
        },
        sphere.radius);
    EXPECT_LE(answer.total, query(*snapshot_, sphere, QueryScope{}).total) << "a query by boxes finds less";
  }
}

TEST_F(ExactQueries, SegmentsFindTheFirstTouchOnTheShape) {
  fill(3, 60);
  Random random(4);
  int met = 0;
  for (int i = 0; i < 200; ++i) {
    const Segment segment{test::randomVector(random, -3, 3), test::randomVector(random, -3, 3),
                          i % 2 == 0 ? 0.0 : random.uniform(0, 0.3)};
    const double length = (segment.to - segment.from).norm();
    const QueryAnswer answer = query(*snapshot_, segment, exactly());
    const auto ball = [&](double along, std::uint32_t body, bool surely) {
      const Eigen::Vector3d center = segment.from + along / length * (segment.to - segment.from);
      return distanceTo(*phase_->point(), at(center.x(), center.y(), center.z()), 0.0, body, surely);
    };
    for (const QueryHit& hit : answer.hits) {
      ++met;
      ASSERT_GE(hit.along, 0.0);
      ASSERT_LE(hit.along, length);
      for (int k = 0; k < 20 && hit.along > 0.0; ++k) {
        const double before = hit.along * k / 20.0 * (1.0 - 1e-9);
        ASSERT_GT(ball(before, hit.body, true), segment.radius - 1e-7) << "the segment touches the body earlier";
      }
      ASSERT_LE(ball(hit.along, hit.body, false), segment.radius + 1e-4) << "the segment does not touch the body there";
    }
  }
  EXPECT_GT(met, 100);
}

TEST_F(ExactQueries, ARayMeetsABoxWhereItsFaceIs) {
  Body box = test::obstacle("box");
  box.shapes.push_back(test::shapeOf(Shape::box({1, 1, 1})));
  Pose turned = at(3.0);
  turned.linear() = Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  add(box, turned);
  snapshot_ = scene_.commit(Time{1}, {});
  const QueryAnswer answer = query(*snapshot_, Segment{{0, 0.1, 0.2}, {10, 0.1, 0.2}, 0.0}, exactly());
  ASSERT_EQ(answer.hits.size(), 1u);
  const double expected = 3.0 - std::sqrt(0.5) + 0.1;  // a vertical edge of the rotated box points at the ray
  EXPECT_NEAR(answer.hits[0].along, expected, 1e-6);
  EXPECT_LT((answer.hits[0].point - Eigen::Vector3d(expected, 0.1, 0.2)).norm(), 1e-6);
  EXPECT_LT((answer.hits[0].normal - Eigen::Vector3d(-std::sqrt(0.5), std::sqrt(0.5), 0.0)).norm(), 1e-3);
}

/// Claim: an exact segment never loses a touch, also if it points almost straight down.
TEST_F(ExactQueries, SegmentsInAllDirectionsTouchWhatIsAtTheirEnd) {
  Body ball = test::obstacle("ball");
  ball.shapes.push_back(test::shapeOf(Shape::sphere(0.1)));
  const BodyId id = add(ball, at(0.0));
  test::Random random(31);
  for (int i = 0; i < 2000; ++i) {
    const double tilt = random.logUniform(1e-9, 1e-3), turn = random.uniform(-3.2, 3.2),
                 length = random.chance(0.5) ? 1 : 100;
    const Eigen::Vector3d down(std::cos(turn) * std::sin(tilt), std::sin(turn) * std::sin(tilt), -std::cos(tilt));
    const Segment segment{Eigen::Vector3d::Zero(), length * down, 0.0};
    const Eigen::Vector3d aside = down.unitOrthogonal();
    // The end of the segment is 1e-6 of its length deep in the ball.
    Pose pose = at(0.0);
    pose.translation() = segment.to + (0.1 - 1e-6 * length) * (random.chance(0.5) ? down : aside);
    scene_.place(id, pose, Time{i + 1});
    snapshot_ = scene_.commit(Time{i + 1}, {});
    ASSERT_EQ(query(*snapshot_, segment, exactly()).hits.size(), 1u) << "tilted by " << tilt << " rad";
  }
}

TEST_F(ExactQueries, BoxesFindExactlyTheShapesTheyTouch) {
  fill(5, 60);
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    QueryBox box{test::randomPose(random, 3.0),
                 {random.uniform(0.01, 1), random.uniform(0.01, 1), random.uniform(0.01, 1)}};
    const auto solid = phase_->block(box.size);
    const QueryAnswer answer = query(*snapshot_, box, *phase_, exactly());
    std::map<std::uint32_t, bool> hits;
    for (const QueryHit& hit : answer.hits) hits[hit.body] = true;
    for (std::uint32_t body = 0; body < snapshot_->structure().bodies.size(); ++body) {
      const double distance = distanceTo(*solid, box.world_from_box, 0.0, body);
      if (hits.count(body) == 0) {
        ASSERT_GT(distance, 0.0) << "missing hit of body " << body;
      } else {
        ASSERT_LE(distance, 1e-7) << "hit is too far away: body " << body;
      }
    }
    const QueryAnswer by_boxes = query(*snapshot_, box, *phase_, QueryScope{});
    ASSERT_GE(by_boxes.total, answer.total);
  }
}

TEST_F(ExactQueries, NearestAreTheNearestOfAll) {
  fill(7, 80);
  Random random(8);
  for (const bool exact : {false, true}) {
    for (int i = 0; i < 100; ++i) {
      SCOPED_TRACE(std::to_string(exact) + ", query " + std::to_string(i));
      const Eigen::Vector3d point = test::randomVector(random, -4, 4);
      const auto k = static_cast<std::uint32_t>(random.between(1, 9));
      const double bound = i % 3 == 0 ? random.uniform(0.1, 1.0) : 0.0;
      QueryScope scope;
      scope.limit = k;
      if (exact) scope.exact = phase_.get();
      const bool from_body = i % 2 == 1;
      const auto from = static_cast<std::uint32_t>(random.between(0, 79));
      const QueryAnswer answer =
          from_body ? nearest(*snapshot_, from, bound, scope) : nearest(*snapshot_, point, bound, scope);
      std::vector<double> all;
      for (std::uint32_t body = 0; body < 80; ++body) {
        if (from_body && body == from) continue;
        all.push_back(leastDistance(exact, from_body, from, point, body));
      }
      std::sort(all.begin(), all.end());
      while (!all.empty() && bound > 0.0 && all.back() > bound) all.pop_back();
      ASSERT_EQ(answer.hits.size(), std::min<std::size_t>(k, all.size()));
      for (std::size_t n = 0; n < answer.hits.size(); ++n) ASSERT_NEAR(answer.hits[n].distance, all[n], 1e-6);
    }
  }
}

}  // namespace
}  // namespace hgrid
