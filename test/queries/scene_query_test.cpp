// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include "hgrid_proximity/queries/query.h"
#include "test/support/maps.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace {

using test::Random;
using test::refusalOf;

struct Oracle {
  long double distance = std::numeric_limits<long double>::infinity();  ///< [m] from the query's center or axis
  long double first = std::numeric_limits<long double>::infinity();     ///< [m] along the axis to the first touch
};

/// Returns the distance of a body's nearest box from an axis. Also returns where a sphere that moves along the axis
/// first touches a box of the body.
Oracle oracleOf(const Snapshot& snapshot, std::uint32_t body, const Segment& axis) {
  const Eigen::Vector3d a = axis.from - snapshot.origin(), b = axis.to - snapshot.origin();
  Oracle oracle;
  for (auto k = snapshot.structure().first_proxy[body]; k < snapshot.structure().first_proxy[body + 1]; ++k) {
    const test::Approach approach = test::approachOf(snapshot.boxes()[k], a, b, axis.radius);
    oracle.distance = std::min(oracle.distance, approach.least);
    oracle.first = std::min(oracle.first, approach.first);
  }
  return oracle;
}

/// Checks that an answer has the hits that the oracle finds, one per body, with correct distances.
void expectRightHits(const Snapshot& snapshot, const Segment& axis, const QueryAnswer& answer, bool along) {
  const double slack =
      test::promisedSlack(axis.from - snapshot.origin(), axis.to - snapshot.origin(), axis.radius) + 1e-12;
  std::map<std::uint32_t, QueryHit> hits;
  for (const QueryHit& hit : answer.hits) ASSERT_TRUE(hits.emplace(hit.body, hit).second) << "a body is hit twice";
  ASSERT_EQ(answer.total, hits.size());
  for (std::uint32_t i = 0; i < snapshot.structure().bodies.size(); ++i) {
    const bool placed = snapshot.poses()[i].state != Freshness::unplaced;
    const Oracle oracle = oracleOf(snapshot, i, axis);
    SCOPED_TRACE(snapshot.structure().bodies[i].name + " at " + std::to_string(double(oracle.distance)));
    if (hits.count(i) == 0) {
      ASSERT_TRUE(!placed || oracle.distance > axis.radius) << "the body is missing in the answer";
      continue;
    }
    ASSERT_TRUE(placed);
    ASSERT_LE(oracle.distance, axis.radius + slack) << "the body is a hit, but it does not touch the query";
    const QueryHit& hit = hits[i];
    const Aabb& box = snapshot.boxes()[snapshot.structure().first_proxy[i] + hit.shape];
    const Eigen::Vector3d point = hit.point - snapshot.origin();
    for (int k = 0; k < 3; ++k) {
      ASSERT_GE(point[k], box.min[k] - slack);
      ASSERT_LE(point[k], box.max[k] + slack);
    }
    ASSERT_NEAR(hit.distance, std::max(0.0, hit.center_distance - axis.radius), slack);
    if (along) {
      ASSERT_GE(hit.along, 0.0);
      ASSERT_LE(hit.along, (axis.to - axis.from).norm() + slack);
      if (oracle.distance <= axis.radius) {
        ASSERT_LE(hit.along, double(oracle.first) + 1e-6);
      }
    } else {
      ASSERT_TRUE(std::isnan(hit.along));
      ASSERT_NEAR(hit.center_distance, double(oracle.distance), slack) << "the hit is not the nearest shape";
      ASSERT_NEAR((hit.point - axis.from).norm(), hit.center_distance, slack);
    }
  }
}

void expectInOrder(const QueryAnswer& answer, bool along) {
  for (std::size_t h = 1; h < answer.hits.size(); ++h) {
    const QueryHit &a = answer.hits[h - 1], &b = answer.hits[h];  // indices of bodies are in the order of their names
    if (along) {
      ASSERT_TRUE(std::make_pair(a.along, a.body) < std::make_pair(b.along, b.body));
    } else {
      ASSERT_TRUE(std::make_tuple(a.distance, a.center_distance, a.body) <
                  std::make_tuple(b.distance, b.center_distance, b.body));
    }
  }
}

std::shared_ptr<const Snapshot> randomSnapshot(unsigned seed) {
  Random random(seed);
  SceneOptions options;
  if (random.chance(0.5)) options.origin << 2, -1, random.uniform(-5, 5);
  options.margin = random.uniform(0, 1);
  Scene scene(options);
  for (int i = 0; i < 40; ++i) {
    const BodyId id = test::putRandom(scene, random, "o" + std::to_string(i), 4.0);
    if (random.chance(0.2)) scene.setState(id, Freshness::lost, 1.0);
  }
  scene.add(test::ball("unplaced", 5.0));
  return scene.commit(Time{1}, {});
}

TEST(SceneQuery, SpheresAndSegmentsFindWhatBruteForceFinds) {
  std::size_t hits = 0;
  for (unsigned seed = 1; seed <= 150; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto snapshot = randomSnapshot(seed);
    Random random(seed + 5000);
    for (int i = 0; i < 20; ++i) {
      Segment axis;
      for (int k = 0; k < 3; ++k) axis.from[k] = random.uniform(-5, 5), axis.to[k] = random.uniform(-5, 5);
      axis.radius = random.chance(0.3) ? 0.0 : random.uniform(0, 2);
      const QueryAnswer segment = query(*snapshot, axis, {});
      ASSERT_NO_FATAL_FAILURE(expectRightHits(*snapshot, axis, segment, true));
      ASSERT_NO_FATAL_FAILURE(expectInOrder(segment, true));
      axis.to = axis.from;
      const QueryAnswer sphere = query(*snapshot, Sphere{axis.from, axis.radius}, {});
      ASSERT_NO_FATAL_FAILURE(expectRightHits(*snapshot, axis, sphere, false));
      ASSERT_NO_FATAL_FAILURE(expectInOrder(sphere, false));
      for (const QueryAnswer& answer : {segment, sphere}) {
        ASSERT_EQ(answer.verdict, answer.total > 0 ? Verdict::hit : Verdict::unknown);
        ASSERT_EQ(answer.reason.empty(), answer.total > 0);
      }
      hits += segment.total + sphere.total;
    }
  }
  EXPECT_GT(hits, 5000u);
}

TEST(SceneQuery, ALimitKeepsTheFirstAndTellsTheTotal) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto snapshot = randomSnapshot(seed);
    const Segment axis{{-5, 0, 0}, {5, 0, 0}, 2.0};
    const Sphere sphere{{0, 0, 0}, 3.0};
    const QueryAnswer all[] = {query(*snapshot, sphere, {}), query(*snapshot, axis, {})};
    ASSERT_GT(all[0].total, 3u);
    for (const std::uint32_t limit : {1u, 2u, std::uint32_t(all[0].total), 1000u}) {
      QueryScope scope;
      scope.limit = limit;
      const QueryAnswer some[] = {query(*snapshot, sphere, scope), query(*snapshot, axis, scope)};
      for (int kind = 0; kind < 2; ++kind) {
        ASSERT_EQ(some[kind].total, all[kind].total);
        ASSERT_EQ(some[kind].verdict, all[kind].verdict);
        ASSERT_EQ(some[kind].hits.size(), std::min<std::size_t>(limit, all[kind].total));
        for (std::size_t h = 0; h < some[kind].hits.size(); ++h)
          ASSERT_EQ(some[kind].hits[h].body, all[kind].hits[h].body);
      }
    }
  }
}

TEST(SceneQuery, IncludeAndExcludeChooseByName) {
  Scene scene{SceneOptions{}};
  for (const char* name : {"cup", "cap", "can", "dog"}) test::put(scene, test::ball(name), test::at(0));
  const auto snapshot = scene.commit(Time{1}, {});
  const auto found = [&](const QueryScope& scope) {
    std::string names;
    const QueryAnswer sphere = query(*snapshot, Sphere{{0, 0, 0}, 1}, scope);
    const QueryAnswer ray = query(*snapshot, Segment{{-1, 0, 0}, {1, 0, 0}, 0}, scope);
    EXPECT_EQ(sphere.total, ray.total);
    EXPECT_EQ(sphere.verdict, sphere.total > 0 ? Verdict::hit : Verdict::clear);
    for (const QueryHit& hit : sphere.hits) names += snapshot->structure().bodies[hit.body].name.substr(9) + " ";
    return names;
  };
  EXPECT_EQ(found({{}, {}, 0}), "can cap cup dog ") << "equally near bodies must be sorted by name";
  EXPECT_EQ(found({{"obstacle/c*"}, {}, 0}), "can cap cup ");
  EXPECT_EQ(found({{"obstacle/c*p", "*dog"}, {}, 0}), "cap cup dog ");
  EXPECT_EQ(found({{}, {"*/ca*"}, 0}), "cup dog ");
  EXPECT_EQ(found({{"obstacle/c*"}, {"*cup", "*can"}, 0}), "cap ") << "exclude must take precedence over include";
  EXPECT_EQ(found({{"cup"}, {}, 0}), "") << "a glob must match the whole name";
  EXPECT_EQ(found({{"*"}, {"*"}, 0}), "");
}

TEST(SceneQuery, PaddingCountsMarginsAndTheFilterDoNot) {
  SceneOptions options;
  options.margin = 5.0;
  options.allowed_pairs = {{"*", "*", "everything may touch"}};
  options.pair_kinds.moving_obstacle = false;
  Scene scene(options);
  Body padded = test::ball("padded", 0.5);
  padded.shapes[0].padding = 0.25;
  padded.margin = 9.0;
  test::put(scene, padded, test::at(0));
  const auto snapshot = scene.commit(Time{1}, {});
  EXPECT_EQ(query(*snapshot, Sphere{{1.0, 0, 0}, 0.2501}, {}).verdict, Verdict::hit);
  EXPECT_EQ(query(*snapshot, Sphere{{1.0, 0, 0}, 0.2499}, {}).verdict, Verdict::clear);
  EXPECT_EQ(query(*snapshot, Segment{{1.0, -9, 0}, {1.0, 9, 0}, 0.2501}, {}).verdict, Verdict::hit);
  EXPECT_EQ(query(*snapshot, Segment{{1.0, -9, 0}, {1.0, 9, 0}, 0.2499}, {}).verdict, Verdict::clear);
}

TEST(SceneQuery, ABodyOfManyShapesIsHitOnceAtTheNearest) {
  Scene scene{SceneOptions{}};
  Body body = test::obstacle("row");
  for (const double x : {4.0, 0.0, 2.0}) {
    body.shapes.push_back(test::shapeOf(Shape::sphere(0.5)));
    body.shapes.back().body_from_shape.translation().x() = x;
  }
  test::put(scene, body, test::at(10));
  const auto snapshot = scene.commit(Time{1}, {});
  const QueryAnswer sphere = query(*snapshot, Sphere{{12.25, 0, 1}, 5.0}, {});
  ASSERT_EQ(sphere.total, 1u);
  EXPECT_EQ(sphere.hits[0].shape, 2u);
  EXPECT_EQ(sphere.hits[0].distance, 0.0);
  EXPECT_NEAR(sphere.hits[0].center_distance, 0.5, 1e-6);
  EXPECT_NEAR(sphere.hits[0].point.z(), 0.5, 1e-6) << "the point must be in the world frame";
  const QueryAnswer there = query(*snapshot, Segment{{0, 0, 0}, {20, 0, 0}, 0}, {}),
                    back = query(*snapshot, Segment{{20, 0, 0}, {0, 0, 0}, 0}, {});
  ASSERT_EQ(there.total, 1u);
  EXPECT_EQ(there.hits[0].shape, 1u) << "the hit must be the shape that the segment touches first";
  EXPECT_NEAR(there.hits[0].along, 9.5, 1e-6);
  ASSERT_EQ(back.total, 1u);
  EXPECT_EQ(back.hits[0].shape, 0u);
  EXPECT_NEAR(back.hits[0].along, 5.5, 1e-6);
}

/// Claim: far from the origin of the world, where the conversion into the frame of the map is rounded, no cell is lost.
TEST(SceneQuery, SegmentsThatEndInACellOfAMapAreHitsFarAway) {
  Random random(1);
  int touches = 0;
  for (int i = 0; i < 2000; ++i) {
    Pose world_from_map = test::randomPose(random, 1.0);
    world_from_map.translation() *= 1e6;
    Scene scene{SceneOptions{}};
    scene.setCells(test::put(scene, test::mapBody("room"), world_from_map),
                   test::cellsOf(0.1, {{Voxel::kOriginKey, Voxel::kOriginKey, Voxel::kOriginKey, 0}}));
    const Eigen::Vector3d end(random.uniform(0.0, 4e-10), 0.03, 0.06);  // the cell begins at x = 0
    const Segment segment{world_from_map * Eigen::Vector3d(-0.5, 0.04, 0.05), world_from_map * end, 0.0};
    using Exact = Eigen::Matrix<long double, 3, 1>;
    const Exact off = segment.to.cast<long double>() - world_from_map.translation().cast<long double>();
    const Eigen::Matrix<long double, 3, 3> rotation = world_from_map.linear().cast<long double>();
    if (Exact(rotation.inverse() * off).x() < 1e-12L) continue;  // rounding has moved the end out of the cell
    ++touches;
    EXPECT_EQ(query(*scene.commit(Time{1}, {}), segment, {}).verdict, Verdict::hit) << "segment " << i;
  }
  EXPECT_GT(touches, 1000);
}

TEST(SceneQuery, RefusesWhatIsNoQuestion) {
  Scene scene{SceneOptions{}};
  test::put(scene, test::ball("a"), test::at(0));
  const auto snapshot = scene.commit(Time{1}, {});
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const auto sphere = [&](const Eigen::Vector3d& center, double radius) {
    return refusalOf([&] { query(*snapshot, Sphere{center, radius}, {}); });
  };
  const auto segment = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius) {
    return refusalOf([&] { query(*snapshot, Segment{from, to, radius}, {}); });
  };
  for (int k = 0; k < 3; ++k) {
    for (const double bad : {nan, infinity, -infinity}) {
      Eigen::Vector3d point = Eigen::Vector3d::Zero();
      point[k] = bad;
      EXPECT_EQ(sphere(point, 1), Code::nonfinite);
      EXPECT_EQ(segment(point, {0, 0, 0}, 1), Code::nonfinite);
      EXPECT_EQ(segment({0, 0, 0}, point, 1), Code::nonfinite);
    }
    Eigen::Vector3d far = Eigen::Vector3d::Zero();
    far[k] = std::nextafter(kQueryReach, 1e300);
    EXPECT_EQ(sphere(far, 1), Code::out_of_range);
    EXPECT_EQ(segment({0, 0, 0}, far, 1), Code::out_of_range);
    far[k] = -kQueryReach;
    EXPECT_EQ(sphere(far, 1), Code::ok);
    EXPECT_EQ(segment({0, 0, 0}, far, 1), Code::ok);
  }
  for (const double bad : {-1.0, -1e-300}) {
    EXPECT_EQ(sphere({0, 0, 0}, bad), Code::bad_geometry);
    EXPECT_EQ(segment({0, 0, 0}, {1, 1, 1}, bad), Code::bad_geometry);
  }
  for (const double bad : {nan, infinity}) {  // the code may be nonfinite or bad_geometry
    const Code code = sphere({0, 0, 0}, bad);
    EXPECT_TRUE(code == Code::nonfinite || code == Code::bad_geometry) << name(code);
    EXPECT_EQ(segment({0, 0, 0}, {1, 1, 1}, bad), code);
  }
  EXPECT_EQ(sphere({0, 0, 0}, 1e11), Code::out_of_range);
  EXPECT_EQ(sphere({0, 0, 0}, 0.0), Code::ok) << "a sphere of radius 0 is a valid query";
  EXPECT_EQ(segment({0, 0, 0}, {0, 0, 0}, 0.0), Code::ok);
}

TEST(SceneQuery, QuestionsLargerThanTheWorldFindAll) {
  const auto snapshot = randomSnapshot(3);
  EXPECT_EQ(query(*snapshot, Sphere{{0, 0, 0}, 1e9}, {}).total, 40u);
  EXPECT_EQ(query(*snapshot, Segment{{-1e9, 0, 0}, {1e9, 0, 0}, 1e3}, {}).total, 40u);
}

}  // namespace
}  // namespace hgrid
