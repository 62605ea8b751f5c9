// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares pairs, gaps and queries of maps with a scan of all cells. A map is a body whose boxes are its cells.
#include <gtest/gtest.h>

#include <cmath>

#include "hgrid_proximity/queries/query.h"
#include "test/support/maps.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace test {
namespace {

constexpr double kEdge = 0.1;

/// A world of bodies and maps that change at random. It keeps the voxels of the maps for the comparison.
class MapWorld {
 public:
  explicit MapWorld(unsigned seed) : random_(seed), scene_(options(seed)) {
    for (const char* name : {"room", "hall"}) {
      ids_[name] = put(scene_, mapBody(name, Mobility::moving), pose());
      fill(name);
    }
    for (int i = 0; i < 12; ++i) putRandom(scene_, random_, std::to_string(i));
  }
  static SceneOptions options(unsigned seed) {
    SceneOptions options;
    options.margin = 0.25;
    options.origin = seed % 2 == 0 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(1e4, -2e4, 5.0);
    return options;
  }
  std::shared_ptr<const Snapshot> step() {
    const int kind = random_.below(4);
    if (kind == 0) fill(random_.chance(0.5) ? "room" : "hall");
    if (kind == 1) scene_.place(ids_["room"], pose(), Time{++time_});
    if (kind == 2) scene_.setState(ids_["hall"], random_.chance(0.5) ? Freshness::stale : Freshness::fresh, 0.3);
    BodyId id;
    for (int moves = random_.below(5); moves > 0; --moves) {
      if (scene_.find("obstacle/" + std::to_string(random_.below(12)), id)) scene_.place(id, pose(), Time{++time_});
    }
    return scene_.commit(Time{++time_}, {});
  }
  const std::vector<Voxel>& voxelsOf(const std::string& body) const { return voxels_.at(body.substr(4)); }
  Random& random() { return random_; }

 private:
  Pose pose() {
    Pose pose = randomPose(random_, 2.0);
    if (random_.chance(0.5)) pose.linear().setIdentity();
    return pose;
  }
  void fill(const std::string& name) {
    voxels_[name] = randomVoxels(random_, random_.below(3) == 0 ? 0 : 200, 20);
    scene_.setCells(ids_[name], cellsOf(kEdge, voxels_[name]));
  }

  Random random_;
  Scene scene_;
  std::map<std::string, BodyId> ids_;
  std::map<std::string, std::vector<Voxel>> voxels_;
  std::int64_t time_ = 1;
};

/// Computes the gap [m] between a body and a map by a scan of all voxels.
double gapOf(const MapWorld& world, const Snapshot& snapshot, std::uint32_t map, std::uint32_t body) {
  const Structure& structure = snapshot.structure();
  double gap = std::numeric_limits<double>::infinity();
  for (ProxyId proxy = structure.first_proxy[body]; proxy < structure.first_proxy[body + 1]; ++proxy) {
    for (const Voxel& voxel : world.voxelsOf(structure.bodies[map].name)) {
      gap = std::min(gap, gapByHand(snapshot, map, voxel, kEdge, snapshot.boxes()[proxy]));
    }
  }
  return gap;
}

TEST(MapPairs, AreThoseOfAScanOfAllCellsWhateverMoves) {
  std::size_t near = 0, far = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    MapWorld world(seed);
    for (int tick = 0; tick < 25; ++tick) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", tick " + std::to_string(tick));
      const auto snapshot = world.step();
      const Structure& structure = snapshot->structure();
      std::map<std::pair<std::uint32_t, std::uint32_t>, NearPair> pairs;
      for (const NearPair& pair : snapshot->pairs()) {
        ASSERT_TRUE(pairs.emplace(std::make_pair(pair.first, pair.second), pair).second) << "the pair is listed twice";
      }
      for (const std::uint32_t map : structure.maps) {
        for (std::uint32_t body = 0; body < structure.bodies.size(); ++body) {
          const auto key = std::minmax(map, body);
          const auto found = pairs.find(key);
          if (structure.bodies[body].kind == BodyKind::map) {
            EXPECT_TRUE(found == pairs.end()) << "two maps must make no pair";
            continue;
          }
          if (structure.bodies[body].mobility == Mobility::fixed) {
            EXPECT_TRUE(found == pairs.end()) << "a map and a fixed obstacle must make no pair";
            continue;
          }
          const double gap = gapOf(world, *snapshot, map, body);
          const double margin = snapshot->marginOf(map, body) + snapshot->growthOf(map, body);
          ASSERT_NEAR(std::min(gap, 1e3), std::min(snapshot->gapOf(map, body), 1e3), 1e-4);
          if (found == pairs.end()) {
            ASSERT_GT(gap, margin - 1e-9) << "a pair is missing";
            ++far;
          } else {
            ++near;
            ASSERT_LE(gap, margin + 1e-4);
            ASSERT_NEAR(found->second.gap, gap, 1e-4);
            ASSERT_EQ(found->second.margin, margin);
          }
        }
      }
    }
  }
  EXPECT_GT(near, 500u);
  EXPECT_GT(far, 500u);
}

using Exact = Eigen::Matrix<long double, 3, 1>;

/// Returns the gap [m] between a cell that begins at the origin of its map, and the box around `box` in that map.
long double exactGap(const Pose& world_from_map, double edge, const Aabb& box) {
  const Eigen::Matrix<long double, 3, 3> turn = world_from_map.linear().cast<long double>().transpose();
  const Exact low = box.min.cast<long double>(), high = box.max.cast<long double>();
  const Exact center = turn * ((low + high) / 2 - world_from_map.translation().cast<long double>());
  const Exact half = turn.cwiseAbs() * ((high - low) / 2), zero = Exact::Zero();
  return (center - half - Exact::Constant(edge)).cwiseMax(-center - half).cwiseMax(zero).norm();
}

TEST(MapPairs, FarFromTheOriginNoGapIsRoundedUp) {
  Random random(11);
  for (const double far : {1.0, 1e3, 1e6}) {
    SCOPED_TRACE(far);
    Scene scene{SceneOptions{}};
    const BodyId room = put(scene, mapBody("room", Mobility::moving), at(0)), probe = put(scene, ball("ball"), at(0));
    scene.setCells(room, cellsOf(0.1, {{32768, 32768, 32768, 0}}));
    for (int i = 0; i < 300; ++i) {
      Pose map = Pose::Identity();
      const Eigen::Vector3d axis(random.uniform(-1, 1), random.uniform(-1, 1), 1.0);
      if (i % 2 == 0) map.linear() = Eigen::AngleAxisd(random.uniform(-3, 3), axis.normalized()).matrix();
      for (int k = 0; k < 3; ++k) map.translation()[k] = random.uniform(-0.99, 0.99) * far;
      scene.place(room, map, Time{1});
      scene.place(probe, at(map.translation().x() + 1.5, map.translation().y(), map.translation().z()), Time{1});
      const auto snapshot = scene.commit(Time{2}, {});
      const long double exact = exactGap(map, 0.1, snapshot->boxes()[0]);
      const double gap = snapshot->gapOf(0, 1);
      ASSERT_LE(gap, exact) << i;
      ASSERT_NEAR(gap, static_cast<double>(exact), 1e-13 * far + 1e-12);
    }
  }
}

TEST(MapPairs, BeginAndEndLikeAllOthers) {
  Scene scene{SceneOptions{}};  // margin 0.1 m, hysteresis 0.02 m
  const BodyId room = put(scene, mapBody("room"), at(0));
  const BodyId ball_id = put(scene, ball("ball", 0.5), at(2));
  scene.setCells(room, cellsOf(0.1, {{32768, 32768, 32768, 0}}));  // one cell from 0 to 0.1 m on each axis
  const auto told = [&](double x) {
    scene.place(ball_id, at(x), Time{1});
    const auto snapshot = scene.commit(Time{2}, {});
    std::string text;
    for (const PairEvent& event : snapshot->events()) text += event.kind == EventKind::begin ? "begin " : "end ";
    return text + std::to_string(snapshot->pairs().size());
  };
  EXPECT_EQ(told(2.0), "0");
  EXPECT_EQ(told(0.69), "begin 1");
  EXPECT_EQ(told(0.71), "0") << "a gap within the hysteresis must not end the pair";
  EXPECT_EQ(told(0.69), "1");
  EXPECT_EQ(told(0.73), "end 0");
  told(0.69);
  scene.setCells(room, cellsOf(0.1, {}));
  const auto emptied = scene.commit(Time{2}, {});
  ASSERT_EQ(emptied->events().size(), 1u) << "the cell was removed, so the pair must end";
  EXPECT_EQ(emptied->events()[0].kind, EventKind::end);
  EXPECT_TRUE(std::isnan(emptied->events()[0].gap)) << "without a cell there is no gap";
}

TEST(MapPairs, WhatPassedTheOtherBetweenTwoTicksIsTold) {
  SceneOptions options;
  options.horizon = 0.001;
  for (const bool map_moves : {false, true}) {
    SCOPED_TRACE(map_moves ? "the map moves" : "the sphere moves");
    Scene scene(options);
    const BodyId room = put(scene, mapBody("room", Mobility::moving), at(0));
    const BodyId ball_id = put(scene, ball("ball", 0.1), at(3));
    scene.setCells(room, cellsOf(0.1, {{32768, 32768, 32768, 0}}));  // one cell from 0 to 0.1 m on each axis
    EXPECT_TRUE(scene.commit(Time{1}, {})->pairs().empty());
    scene.place(map_moves ? room : ball_id, at(map_moves ? 6 : -3), Time{2});
    const auto passing = scene.commit(Time{2}, {});
    ASSERT_EQ(passing->pairs().size(), 1u);
    EXPECT_EQ(passing->pairs()[0].flags & kHorizonFlag, kHorizonFlag);
    EXPECT_NEAR(passing->pairs()[0].gap, 2.9, 1e-6);
    EXPECT_TRUE(scene.commit(Time{3}, {})->pairs().empty());
    scene.place(room, at(6, 0.2), Time{4});  // apart from the map; in the next tick both move by the same distance
    scene.place(ball_id, at(3, 0.2), Time{4});
    scene.commit(Time{4}, {});
    scene.place(room, at(-6, 0.2), Time{5});
    scene.place(ball_id, at(-9, 0.2), Time{5});
    EXPECT_TRUE(scene.commit(Time{5}, {})->pairs().empty()) << "bodies that move together do not pass each other";
  }
}

TEST(MapPairs, OfAFixedBodyAndAFixedMapThereAreNone) {
  Scene scene{SceneOptions{}};
  const BodyId room = put(scene, mapBody("room"), at(0));
  scene.setCells(room, cellsOf(0.1, {{32768, 32768, 32768, 0}}));
  put(scene, ball("pillar", 0.5, Mobility::fixed), at(0));
  EXPECT_TRUE(scene.commit(Time{1}, {})->pairs().empty());
}

TEST(MapPairs, CellsAreForMapsWithoutShapes) {
  Scene scene{SceneOptions{}};
  const BodyId one = put(scene, ball("ball"), at(0)), room = put(scene, mapBody("room"), at(0));
  EXPECT_EQ(refusalOf([&] { scene.setCells(one, cellsOf(0.1, {})); }), Code::bad_geometry);
  EXPECT_EQ(refusalOf([&] { scene.setCells(room, nullptr); }), Code::bad_geometry);
  scene.remove(room);
  EXPECT_EQ(refusalOf([&] { scene.setCells(room, cellsOf(0.1, {})); }), Code::unknown_id);
}

/// Returns the distance [m] between a point in the world frame and a voxel of a map.
double distanceTo(const Snapshot& snapshot, std::uint32_t map, const Voxel& voxel, const Eigen::Vector3d& point) {
  const Eigen::Vector3d at = snapshot.poses()[map].world_from_body.inverse() * point;
  return (minCorner(voxel, kEdge) - at).cwiseMax(at - maxCorner(voxel, kEdge)).cwiseMax(Eigen::Vector3d::Zero()).norm();
}

TEST(MapQueries, OfBallsAndPointsAreThoseOfAScanOfAllCells) {
  std::size_t hits = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    MapWorld world(seed);
    const auto snapshot = world.step();
    for (int i = 0; i < 100; ++i) {
      Eigen::Vector3d point;
      for (int axis = 0; axis < 3; ++axis) point[axis] = world.random().uniform(-4.0, 4.0);
      const Sphere sphere{point, world.random().uniform(0.0, 1.0)};
      QueryScope scope;
      scope.include = {"map/*"};
      const QueryAnswer answer = query(*snapshot, sphere, scope), near = nearest(*snapshot, point, 0.0, scope);
      std::size_t expected = 0, all = 0;
      double nearest = std::numeric_limits<double>::infinity();
      for (const std::uint32_t map : snapshot->structure().maps) {
        double least = std::numeric_limits<double>::infinity();
        for (const Voxel& voxel : world.voxelsOf(snapshot->structure().bodies[map].name)) {
          least = std::min(least, distanceTo(*snapshot, map, voxel, point));
        }
        nearest = std::min(nearest, least);
        all += std::isfinite(least);
        if (least > sphere.radius) continue;
        ++expected;
        const auto hit =
            std::find_if(answer.hits.begin(), answer.hits.end(), [&](const QueryHit& one) { return one.body == map; });
        ASSERT_NE(hit, answer.hits.end());
        EXPECT_NEAR(hit->center_distance, least, 1e-9);
        EXPECT_EQ(hit->distance, 0.0);
        EXPECT_NEAR((hit->point - point).norm(), least, 1e-9);
        EXPECT_GE(hit->cell_edge, kEdge);
      }
      hits += expected;
      EXPECT_EQ(answer.total, expected);
      ASSERT_EQ(near.hits.size(), std::min<std::size_t>(all, 1));
      if (all > 0) {
        EXPECT_NEAR(near.hits.front().distance, nearest, 1e-9);
      }
    }
  }
  EXPECT_GT(hits, 100u);
}

TEST(MapQueries, OfSegmentsTellWhatIsMetFirst) {
  Scene scene{SceneOptions{}};
  const BodyId room = scene.add(mapBody("room"));
  Pose turned = Pose::Identity();
  turned.linear() = Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  scene.place(room, turned, Time{1});
  scene.setState(room, Freshness::fresh, 0.0);
  // In the map, the cell is at x 5 .. 6 m, y 0 .. 1 m. In the world, it is at y 5 .. 6 m, x -1 .. 0 m.
  scene.setCells(room, cellsOf(1.0, {{32773, 32768, 32768, 0}}));
  const auto snapshot = scene.commit(Time{1}, {});
  QueryScope scope;
  QueryAnswer answer = query(*snapshot, Segment{{-0.5, 0, 0.5}, {-0.5, 10, 0.5}, 0.0}, scope);
  ASSERT_EQ(answer.hits.size(), 1u);
  EXPECT_NEAR(answer.hits[0].along, 5.0, 1e-9);
  EXPECT_TRUE(answer.hits[0].point.isApprox(Eigen::Vector3d(-0.5, 5.0, 0.5), 1e-9));
  answer = query(*snapshot, Segment{{0.25, 0, 0.5}, {0.25, 10, 0.5}, 0.5}, scope);
  ASSERT_EQ(answer.hits.size(), 1u);
  EXPECT_NEAR(answer.hits[0].along, 5.0 - std::sqrt(0.25 - 0.0625), 1e-9);
  EXPECT_EQ(query(*snapshot, Segment{{0.25, 0, 0.5}, {0.25, 10, 0.5}, 0.0}, scope).verdict, Verdict::clear);
}

TEST(MapQueries, AStaleMapIsNeverClearWhereItMayBe) {
  SceneOptions options;
  options.growth_cap = 1.0;
  Scene scene{options};
  const BodyId room = put(scene, mapBody("room", Mobility::moving), at(0));
  scene.setCells(room, cellsOf(1.0, {{32768, 32768, 32768, 0}}));
  scene.setState(room, Freshness::stale, 0.5);  // the map may have moved by 0.5 m
  const auto snapshot = scene.commit(Time{1}, {});
  const auto verdict = [&](double x) { return query(*snapshot, Sphere{{x, 0.5, 0.5}, 0.1}, {}).verdict; };
  EXPECT_EQ(verdict(1.05), Verdict::hit);
  EXPECT_EQ(verdict(1.5), Verdict::unknown);
  EXPECT_EQ(verdict(1.7), Verdict::clear);
  EXPECT_EQ(query(*snapshot, Segment{{1.5, -5, 0.5}, {1.5, 5, 0.5}, 0.0}, {}).verdict, Verdict::unknown);
  EXPECT_EQ(nearest(*snapshot, {1.5, 0.5, 0.5}, 0.3, {}).verdict, Verdict::unknown);
}

TEST(MapQueries, NearestToAStaleBodyIsNeverClearWhereThatMayBe) {
  SceneOptions options;
  options.growth_cap = 1.0;
  Scene scene{options};
  Body tool = ball("tool", 0.1);
  tool.max_speed = 1.0;
  const BodyId asking = put(scene, tool, at(0));
  put(scene, ball("post", 0.1, Mobility::fixed), at(1));                                          // 0.8 m from the tool
  scene.setCells(put(scene, mapBody("room"), at(-5)), cellsOf(1.0, {{32771, 32768, 32768, 0}}));  // x is -2 .. -1 m
  const auto because = [&](const std::string& what, double limit) {
    QueryScope scope;
    scope.include = {what};
    const auto snapshot = scene.commit(Time{1}, {});
    return nearest(*snapshot, snapshot->structure().find("obstacle/tool"), limit, scope).because;
  };
  EXPECT_EQ(because("obstacle/*", 0.5), Unknown::no);
  EXPECT_EQ(because("map/*", 0.5), Unknown::no);
  scene.setState(asking, Freshness::stale, 0.4);  // the tool may have moved by 0.4 m
  EXPECT_EQ(because("obstacle/*", 0.5), Unknown::stale_body);
  EXPECT_EQ(because("map/*", 0.6), Unknown::stale_body);
  EXPECT_EQ(because("obstacle/*", 0.3), Unknown::no);
  EXPECT_EQ(because("map/*", 0.3), Unknown::no);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
