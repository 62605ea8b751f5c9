// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares signed distances and penetration depths of queries that measure boxes and cells with simple formulas.
#include <gtest/gtest.h>

#include "hgrid_proximity/queries/query.h"
#include "test/support/maps.h"
#include "test/support/scenes.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace test {
namespace {

constexpr double kEdge = 0.1, kInfinity = std::numeric_limits<double>::infinity();

/// Returns the signed distance [m] of a point from a box; negative inside.
double signedByHand(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Eigen::Vector3d& point) {
  double outside = 0.0, inside = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    const double off = std::max({0.0, low[axis] - point[axis], point[axis] - high[axis]});
    outside += off * off;
    inside = std::min({inside, point[axis] - low[axis], high[axis] - point[axis]});
  }
  return outside > 0.0 ? std::sqrt(outside) : -inside;
}

void expectSigned(const QueryHit& hit, double expected) {
  ASSERT_NEAR(hit.signed_distance, expected, 1e-9);
  ASSERT_EQ(hit.distance, std::max(0.0, hit.signed_distance));
  if (hit.signed_distance > 0.0) {
    ASSERT_TRUE(std::isnan(hit.depth));
  } else {
    ASSERT_EQ(hit.depth, -hit.signed_distance);
    ASSERT_FALSE(std::signbit(hit.depth));
  }
}

std::shared_ptr<const Snapshot> randomSnapshot(unsigned seed) {
  Random random(seed);
  SceneOptions options;
  if (random.chance(0.5)) options.origin << 2, -1, 3;
  Scene scene(options);
  for (int i = 0; i < 30; ++i) putRandom(scene, random, "o" + std::to_string(i));
  return scene.commit(Time{1}, {});
}

const Aabb& boxOf(const Snapshot& snapshot, const QueryHit& hit) {
  return snapshot.boxes()[snapshot.structure().first_proxy[hit.body] + hit.shape];
}

TEST(SignedDistance, OfSpheresAndPointsIsThatOfTheCenterMinusTheRadius) {
  int inside = 0, apart = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const auto snapshot = randomSnapshot(seed);
    Random random(seed + 100);
    for (int i = 0; i < 40; ++i) {
      const Eigen::Vector3d point = randomVector(random, -4, 4);
      const double radius = i % 3 == 0 ? 0.0 : random.uniform(0, 1);
      QueryScope five;
      five.limit = 5;
      const QueryAnswer sphere = query(*snapshot, Sphere{point, radius}, {}), near = nearest(*snapshot, point, 0, five);
      for (const QueryAnswer* answer : {&sphere, &near}) {
        for (const QueryHit& hit : answer->hits) {
          const Eigen::AlignedBox3d box = inDouble(boxOf(*snapshot, hit));
          const double expected = signedByHand(box.min(), box.max(), point - snapshot->origin());
          expectSigned(hit, expected - (answer == &sphere ? radius : 0.0));
          if (::testing::Test::HasFatalFailure()) return;
          ++(expected < 0.0 ? inside : apart);
        }
      }
    }
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(apart, 100);
}

TEST(SignedDistance, OfSegmentsIsThatOfTheAxisMinusTheRadius) {
  int through = 0, beside = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const auto snapshot = randomSnapshot(seed);
    Random random(seed + 100);
    for (int i = 0; i < 40; ++i) {
      const Segment segment{randomVector(random, -4, 4), randomVector(random, -4, 4), random.uniform(0, 1)};
      for (const QueryHit& hit : query(*snapshot, segment, {}).hits) {
        const Eigen::Vector3d &origin = snapshot->origin(), from = segment.from - origin, to = segment.to - origin;
        const double least = double(approachOf(boxOf(*snapshot, hit), from, to, segment.radius).least);
        if (least > 0.0) {
          expectSigned(hit, least - segment.radius);
        } else {
          ASSERT_TRUE(std::isnan(hit.signed_distance) && std::isnan(hit.depth));
          ASSERT_EQ(hit.distance, 0.0);
        }
        if (::testing::Test::HasFatalFailure()) return;
        ++(least > 0.0 ? beside : through);
      }
    }
  }
  EXPECT_GT(through, 100);
  EXPECT_GT(beside, 100);
}

TEST(SignedDistance, BetweenBodiesIsNegativeWhereTheirBoxesOverlap) {
  int overlaps = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const auto snapshot = randomSnapshot(seed);
    const Structure& structure = snapshot->structure();
    QueryScope all;
    all.limit = 100;
    for (std::uint32_t from = 0; from < structure.bodies.size(); ++from) {
      for (const QueryHit& hit : nearest(*snapshot, from, 0.0, all).hits) {
        const Aabb& box = boxOf(*snapshot, hit);
        double least = kInfinity, depth = kInfinity;  // depth: penetration depth of the first overlapping shape
        for (ProxyId own = structure.first_proxy[from]; own < structure.first_proxy[from + 1]; ++own) {
          const Aabb& other = snapshot->boxes()[own];
          if (distance(other, box) == 0.0 && least > 0.0) {
            for (int axis = 0; axis < 3; ++axis) {
              depth =
                  std::min({depth, double(other.max[axis]) - box.min[axis], double(box.max[axis]) - other.min[axis]});
            }
          }
          least = std::min(least, distance(other, box));
        }
        expectSigned(hit, least > 0.0 ? least : -depth);
        if (::testing::Test::HasFatalFailure()) return;
        overlaps += least == 0.0;
      }
    }
  }
  EXPECT_GT(overlaps, 100);
}

TEST(SignedDistance, OfCellsIsThatOfTheCellThatIsNamed) {
  int inside = 0, beside = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    Scene scene{SceneOptions{}};
    const std::vector<Voxel> voxels = randomVoxels(random, 400, 10);
    const Pose world_from_map = randomPose(random, 1.0);
    scene.setCells(put(scene, mapBody("room"), world_from_map), cellsOf(kEdge, voxels));
    const auto snapshot = scene.commit(Time{1}, {});
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d in_map = randomVector(random, -1, 1);
      const double radius = random.uniform(0, 0.2);
      double least = kInfinity;
      for (const Voxel& voxel : voxels) {
        least = std::min(least, signedByHand(minCorner(voxel, kEdge), maxCorner(voxel, kEdge), in_map));
      }
      const QueryAnswer answer = query(*snapshot, Sphere{world_from_map * in_map, radius}, {});
      if (std::abs(least - radius) < 1e-6 || std::abs(least) < 1e-6) continue;
      ASSERT_EQ(answer.hits.empty(), least > radius);
      if (answer.hits.empty()) continue;
      expectSigned(answer.hits[0], least - radius);
      if (::testing::Test::HasFatalFailure()) return;
      ++(least < 0.0 ? inside : beside);
    }
  }
  EXPECT_GT(inside, 50);
  EXPECT_GT(beside, 50);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
