// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares queries with a shape in any pose with measurements of all shapes of all bodies. Tests penetration depths.
#include <gtest/gtest.h>

#include <map>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/queries/query.h"
#include "test/support/maps.h"
#include "test/support/refusals.h"
#include "test/support/scenes.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class ShapeQueries : public ::testing::Test {
 protected:
  BodyId add(Body body, const Pose& pose) {
    for (BodyShape& shape : body.shapes) shape.solid = phase_->solidOf(shape.shape);
    return put(scene_, body, pose);
  }
  void fill(unsigned seed, int count) {
    Random random(seed);
    for (int i = 0; i < count; ++i) add(randomBody(random, std::to_string(i)), randomPose(random, 2.0));
    const BodyId map = put(scene_, mapBody("room"), randomPose(random, 1.0));
    voxels_ = randomVoxels(random, 100, 12);
    scene_.setCells(map, makeMapCells(std::make_shared<StaticGrid>(0.1, voxels_), *phase_));
    snapshot_ = scene_.commit(Time{1}, {});
  }
  QueryScope exactly() const {
    QueryScope scope;
    scope.exact = phase_.get();
    return scope;
  }
  Proximity measure(const QueryShape& asked, const Shape& shape, const Pose& pose, double padding) const {
    return phase_->measure({*phase_->solidOf(asked.shape), asked.world_from_shape, asked.padding},
                           {*phase_->solidOf(shape), pose, padding}, kInfinity);
  }
  /// Returns the least distance [m] to the shapes (`exact`) or to the boxes of a body. For a map, measures its cells.
  double distanceTo(const QueryShape& asked, std::uint32_t body, bool exact) const {
    const Structure& structure = snapshot_->structure();
    const Pose& world_from_body = snapshot_->poses()[body].world_from_body;
    double least = kInfinity;
    for (std::uint32_t i = 0; i < structure.bodies[body].shapes.size(); ++i) {
      const BodyShape& shape = structure.bodies[body].shapes[i];
      const Eigen::AlignedBox3d box = inDouble(snapshot_->boxes()[structure.first_proxy[body] + i]);
      const Pose world_from_box(Eigen::Translation3d(snapshot_->origin() + box.center()));
      const Proximity found = exact
                                  ? measure(asked, shape.shape, world_from_body * shape.body_from_shape, shape.padding)
                                  : measure(asked, Shape::box(box.sizes()), world_from_box, 0.0);
      least = std::min(least, found.distance);
    }
    if (!structure.isMap(body)) return least;
    for (const Voxel& voxel : voxels_) {
      const double edge = edgeOf(voxel, 0.1);
      const Pose world_from_cube =
          world_from_body * Eigen::Translation3d(minCorner(voxel, 0.1) + Eigen::Vector3d::Constant(0.5 * edge));
      least = std::min(least, measure(asked, Shape::box({edge, edge, edge}), world_from_cube, 0.0).distance);
    }
    return least;
  }

  std::shared_ptr<NarrowPhase> phase_ = makeCoreNarrowPhase();
  Scene scene_{SceneOptions{}};
  std::vector<Voxel> voxels_;
  std::shared_ptr<const Snapshot> snapshot_;
};

TEST_F(ShapeQueries, FindExactlyWhatTheShapeTouches) {
  fill(11, 40);
  Random random(12);
  std::size_t hits = 0;
  for (int i = 0; i < 140; ++i) {
    const auto kind = static_cast<ShapeKind>(1 + i % 7);
    SCOPED_TRACE(std::to_string(i) + ", a " + name(kind));
    const QueryShape asked{randomShape(random, kind, 1.0), randomPose(random, 2.0),
                           i % 2 ? random.uniform(0, 0.2) : 0.0};
    for (const bool exact : {false, true}) {
      const QueryAnswer answer = query(*snapshot_, asked, *phase_, exact ? exactly() : QueryScope{});
      std::map<std::uint32_t, QueryHit> found;
      for (const QueryHit& hit : answer.hits) ASSERT_TRUE(found.emplace(hit.body, hit).second) << "body listed twice";
      for (std::uint32_t body = 0; body < snapshot_->structure().bodies.size(); ++body) {
        const double boxes = distanceTo(asked, body, false), shapes = exact ? distanceTo(asked, body, true) : boxes;
        if (found.count(body) == 0) {
          ASSERT_GT(std::max(boxes, shapes), 0.0) << "missing hit of " << snapshot_->structure().bodies[body].name;
        } else {
          ASSERT_LE(std::max(boxes, shapes), 1e-7) << "too far away: " << snapshot_->structure().bodies[body].name;
          ASSERT_EQ(found[body].distance, 0.0);
          ++hits;
        }
      }
      ASSERT_EQ(answer.verdict, found.empty() ? Verdict::clear : Verdict::hit);
    }
  }
  EXPECT_GT(hits, 300u);
}

TEST_F(ShapeQueries, OfABoxOrASphereAnswerAsTheQueriesForThem) {
  fill(13, 40);
  Random random(14);
  const auto bodies = [](const QueryAnswer& answer) {
    std::vector<std::uint32_t> found;
    for (const QueryHit& hit : answer.hits) found.push_back(hit.body);
    std::sort(found.begin(), found.end());
    return found;
  };
  for (int i = 0; i < 100; ++i) {
    const Pose pose = randomPose(random, 2.0);
    const Eigen::Vector3d size = randomVector(random, 0.01, 1.0);
    const double radius = random.uniform(0.01, 1.0);
    for (const QueryScope& scope : {QueryScope{}, exactly()}) {
      const QueryAnswer box = query(*snapshot_, QueryBox{pose, size}, *phase_, scope);
      ASSERT_EQ(bodies(query(*snapshot_, QueryShape{Shape::box(size), pose}, *phase_, scope)), bodies(box));
      const QueryAnswer sphere = query(*snapshot_, Sphere{pose.translation(), radius}, scope);
      ASSERT_EQ(bodies(query(*snapshot_, QueryShape{Shape::sphere(radius), pose}, *phase_, scope)), bodies(sphere));
      const QueryShape padded{Shape::sphere(0.5 * radius), pose, 0.5 * radius};
      ASSERT_EQ(bodies(query(*snapshot_, padded, *phase_, scope)), bodies(sphere));
    }
  }
}

TEST_F(ShapeQueries, ALostBodyMayHaveComeAsFarAsItsSpeedAllows) {
  Body body = ball("a", 0.5);
  body.max_speed = 1.0;
  const BodyId id = add(body, at(0));
  scene_.setState(id, Freshness::lost, 2.0);
  snapshot_ = scene_.commit(Time{1}, {});
  const auto verdict = [&](double x) {
    return query(*snapshot_, QueryShape{Shape::cylinder(1.0, 0.5), at(x)}, *phase_, exactly()).verdict;
  };
  EXPECT_EQ(verdict(0.9), Verdict::hit);
  EXPECT_EQ(verdict(2.9), Verdict::unknown);
  EXPECT_EQ(verdict(3.1), Verdict::clear);
}

TEST_F(ShapeQueries, AGapThatHasABoundHidesNothingBeyondIt) {
  const SourceGap gap{"cloud/front", "cloud/front", "LOST cloud/front", Sphere{{0, 0, 0}, 2.0}};
  snapshot_ = scene_.commit(Time{1}, {gap});
  const auto verdict = [&](double x) {
    return query(*snapshot_, QueryShape{Shape::cylinder(1.0, 0.5), at(x)}, *phase_, {}).verdict;
  };
  EXPECT_EQ(verdict(2.49), Verdict::unknown);
  EXPECT_EQ(verdict(2.51), Verdict::clear);
}

TEST_F(ShapeQueries, RefuseInvalidQueries) {
  snapshot_ = scene_.commit(Time{1}, {});
  const Shape shape = Shape::sphere(1.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [&](const QueryShape& asked) {
    return refusalOf([&] { query(*snapshot_, asked, *phase_, {}); });
  };
  EXPECT_EQ(refused({shape, at(nan), 0.0}), Code::nonfinite);
  EXPECT_EQ(refused({shape, at(2e10), 0.0}), Code::out_of_range);
  EXPECT_EQ(refused({shape, at(0), -1.0}), Code::bad_geometry);
  EXPECT_EQ(refused({shape, at(0), nan}), Code::bad_geometry);
  EXPECT_EQ(refused({shape, at(0), 1.0}), Code::ok);
}

TEST_F(ShapeQueries, OfBoxesHaveTheDepthOfTheBoxOrCellThatIsNamed) {
  fill(15, 40);
  Random random(16);
  std::size_t deep = 0;
  for (int i = 0; i < 200; ++i) {
    const QueryBox box{randomPose(random, 2.0), randomVector(random, 0.1, 1.0)};
    for (const QueryHit& hit : query(*snapshot_, box, *phase_, {}).hits) {
      ASSERT_EQ(hit.depth, std::abs(hit.signed_distance));
      ASSERT_LE(hit.signed_distance, 0.0);
      ASSERT_EQ(hit.distance, 0.0);
      if (hit.depth < 1e-4 || snapshot_->structure().isMap(hit.body)) continue;
      const ProxyId proxy = snapshot_->structure().first_proxy[hit.body] + hit.shape;
      const Eigen::AlignedBox3d target = inDouble(snapshot_->boxes()[proxy]);
      const auto separates = [&](const Eigen::Vector3d& move) {
        QueryShape moved{Shape::box(box.size), box.world_from_box};
        moved.world_from_shape.translation() += move;
        return measure(moved, Shape::box(target.sizes()), Pose(Eigen::Translation3d(target.center())), 0.0).distance >
               0;
      };
      for (int k = 0; k < 20; ++k) {
        ASSERT_FALSE(separates(0.999 * hit.depth * randomVector(random, -1, 1).normalized()))
            << "a move shorter than the depth separates the boxes";
      }
      const auto first = phase_->block(box.size), second = phase_->block(target.sizes());
      const Pose of_target(Eigen::Translation3d(target.center()));
      const Contact contact = phase_->measureContact({*first, box.world_from_box, 0.0}, {*second, of_target, 0.0});
      ASSERT_NEAR(hit.depth, contact.depth, 1e-9);
      ASSERT_NEAR(hit.depth, contact.depth_at_least, 1e-9);
      ++deep;
    }
  }
  EXPECT_GT(deep, 100u);
}

TEST_F(ShapeQueries, ExactDepthsAreThoseOfTheShapes) {
  add(ball("a", 0.5), at(0));
  Body box = obstacle("b");
  box.shapes.push_back(shapeOf(Shape::box({1.0, 2.0, 3.0})));
  add(box, at(10));
  snapshot_ = scene_.commit(Time{1}, {});
  const auto hit = [&](const QueryAnswer& answer) { return answer.hits.empty() ? QueryHit{} : answer.hits.front(); };
  QueryHit found = hit(query(*snapshot_, Sphere{{0.6, 0.3, 0.0}, 0.4}, exactly()));
  EXPECT_NEAR(found.signed_distance, std::hypot(0.6, 0.3) - 0.9, 1e-9);
  EXPECT_NEAR(found.depth, 0.9 - std::hypot(0.6, 0.3), 1e-9);
  found = hit(query(*snapshot_, Sphere{{0.1, 0.0, 0.0}, 0.2}, exactly()));
  EXPECT_NEAR(found.depth, 0.6, 1e-9) << "the center of the sphere is inside the shape";
  found = hit(query(*snapshot_, Segment{{0.6, -9, 0}, {0.6, 9, 0}, 0.2}, exactly()));
  EXPECT_NEAR(found.depth, 0.1, 1e-9);
  found = hit(nearest(*snapshot_, Eigen::Vector3d(2.0, 0, 0), 0.0, exactly()));
  EXPECT_NEAR(found.signed_distance, 1.5, 1e-9);
  EXPECT_TRUE(std::isnan(found.depth));
  found = hit(query(*snapshot_, QueryShape{Shape::sphere(0.5), at(10.9)}, *phase_, exactly()));
  EXPECT_NEAR(found.depth, 0.1, 1e-9);
  EXPECT_NEAR(found.signed_distance, -0.1, 1e-9);
  EXPECT_EQ(found.distance, 0.0);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
