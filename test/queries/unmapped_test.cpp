// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// With SceneOptions::report_unmapped, queries answer CLEAR only where a map knows that space is free.
#include <gtest/gtest.h>

#include "hgrid_proximity/queries/query.h"
#include "test/support/maps.h"

namespace hgrid {
namespace test {
namespace {

constexpr double kEdge = 0.1;

std::shared_ptr<const MapCells> knowing(const std::vector<Voxel>& unknown, const Eigen::AlignedBox3d& extent) {
  auto cells = std::make_shared<MapCells>();
  cells->grid = std::make_shared<StaticGrid>(kEdge, std::vector<Voxel>{});
  cells->unmapped = std::make_shared<UnmappedSpace>(UnmappedSpace{StaticGrid(kEdge, unknown), extent});
  return cells;
}
Eigen::AlignedBox3d cube(double half) { return {Eigen::Vector3d::Constant(-half), Eigen::Vector3d::Constant(half)}; }
SceneOptions reporting() {
  SceneOptions options;
  options.report_unmapped = true;
  return options;
}

/// Returns the distance [m] between a sphere and all space that the map does not know, by a scan of all voxels. It is
/// negative if the sphere overlaps this space.
double clearance(const std::vector<Voxel>& unknown, const Eigen::AlignedBox3d& extent, const Eigen::Vector3d& at,
                 double radius) {
  double least = std::min((at - extent.min()).minCoeff(), (extent.max() - at).minCoeff());
  for (const Voxel& voxel : unknown) {
    const Eigen::Vector3d off = (minCorner(voxel, kEdge) - at).cwiseMax(at - maxCorner(voxel, kEdge));
    least = std::min(least, off.cwiseMax(Eigen::Vector3d::Zero()).norm());
  }
  return least - radius;
}

TEST(Unmapped, ClearIsSaidExactlyOfWhatTheMapKnowsToBeFree) {
  std::size_t clear = 0, unknown_space = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    Random random(seed);
    const std::vector<Voxel> unknown = randomVoxels(random, 60, 20);
    const Eigen::AlignedBox3d extent = cube(random.uniform(1.0, 2.0));
    Scene scene(reporting());
    const Pose world_from_map = randomPose(random, 5.0);
    scene.setCells(put(scene, mapBody("room"), world_from_map), knowing(unknown, extent));
    const auto snapshot = scene.commit(Time{1}, {});
    const auto check = [&](double room, const QueryAnswer& answer, const char* what) {
      if (std::abs(room) < 1e-3) return;  // too close to decide, because the reference for segments samples only points
      SCOPED_TRACE("seed " + std::to_string(seed) + ", " + what + ", " + std::to_string(room) + " m of room");
      ASSERT_EQ(answer.verdict, room > 0.0 ? Verdict::clear : Verdict::unknown);
      ASSERT_EQ(answer.because, room > 0.0 ? Unknown::no : Unknown::unmapped);
      ++(room > 0.0 ? clear : unknown_space);
    };
    for (int i = 0; i < 60; ++i) {
      const auto point = [&] { return randomPose(random, 2.0).translation().eval(); };
      const Eigen::Vector3d from = point(), to = from + 0.3 * point();
      const double radius = random.chance(0.3) ? 0.0 : random.uniform(0.0, 0.3);
      const double room = clearance(unknown, extent, from, radius);
      check(room, query(*snapshot, Sphere{world_from_map * from, radius}, {}), "sphere");
      if (radius > 0.0) check(room, nearest(*snapshot, world_from_map * from, radius, {}), "nearest");
      double along = room;
      for (int step = 1; step <= 1000; ++step) {
        along = std::min(along, clearance(unknown, extent, from + 1e-3 * step * (to - from), radius));
      }
      check(along, query(*snapshot, Segment{world_from_map * from, world_from_map * to, radius}, {}), "segment");
    }
  }
  EXPECT_GT(clear, 300u);
  EXPECT_GT(unknown_space, 300u);
}

TEST(Unmapped, WhatTouchesTheUnknownIsNotClear) {
  Scene scene(reporting());
  // The unknown cell extends from 1 m to 1.1 m along x.
  scene.setCells(put(scene, mapBody("room"), at(0)), knowing({{32778, 32768, 32768, 0}}, cube(2.0)));
  const auto snapshot = scene.commit(Time{1}, {});
  const auto verdict = [&](double x, double radius) {
    return query(*snapshot, Sphere{{x, 0.05, 0.05}, radius}, {}).verdict;
  };
  EXPECT_EQ(verdict(0.5, 0.4999), Verdict::clear);
  EXPECT_EQ(verdict(0.5, 0.5), Verdict::unknown);
  EXPECT_EQ(verdict(-1.5, 0.4999), Verdict::clear);
  EXPECT_EQ(verdict(-1.5, 0.5), Verdict::unknown) << "the sphere reaches beyond the extent of the map";
}

TEST(Unmapped, AHitStaysAHit) {
  Scene scene(reporting());
  put(scene, ball("post", 0.5), at(0));
  EXPECT_EQ(query(*scene.commit(Time{1}, {}), Sphere{{0, 0, 0}, 0.1}, {}).verdict, Verdict::hit);
}

TEST(Unmapped, OfSeveralMapsOneMustKnowAll) {
  Scene scene(reporting());
  scene.setCells(put(scene, mapBody("west"), at(-1)), knowing({}, cube(1.0)));
  scene.setCells(put(scene, mapBody("east"), at(1)), knowing({}, cube(1.0)));
  const auto snapshot = scene.commit(Time{1}, {});
  const auto asked = [&](double x, const QueryScope& scope) { return query(*snapshot, Sphere{{x, 0, 0}, 0.5}, scope); };
  EXPECT_EQ(asked(-1.0, {}).verdict, Verdict::clear);
  EXPECT_EQ(asked(1.0, {}).verdict, Verdict::clear);
  EXPECT_EQ(asked(0.0, {}).because, Unknown::unmapped) << "each map knows only one half of the sphere";
  QueryScope scope;
  scope.include = {"map/west"};
  EXPECT_EQ(asked(1.0, scope).because, Unknown::unmapped) << "the map that knows this space is not in the scope";
  scope.include = {"obstacle/*"};
  EXPECT_EQ(asked(5.0, scope).verdict, Verdict::clear) << "the scope contains no map";
  scope = {};
  scope.exclude = {"map/*"};
  EXPECT_EQ(asked(5.0, scope).verdict, Verdict::clear) << "the scope contains no map";
}

TEST(Unmapped, WithoutAMapNothingIsKnown) {
  Scene scene(reporting());
  EXPECT_EQ(query(*scene.commit(Time{1}, {}), Sphere{{0, 0, 0}, 0.1}, {}).because, Unknown::unmapped);
  const BodyId cloud = put(scene, mapBody("cloud"), at(0));
  scene.setCells(cloud, cellsOf(kEdge, {}));
  EXPECT_EQ(query(*scene.commit(Time{2}, {}), Sphere{{0, 0, 0}, 0.1}, {}).because, Unknown::unmapped)
      << "the only map knows no free space";
}

TEST(Unmapped, ACloudIsNoMap) {
  Scene scene(reporting());
  Body cloud = mapBody("x");
  cloud.name = "cloud/x";
  cloud.kind = BodyKind::cloud;
  scene.setCells(put(scene, cloud, at(0)), cellsOf(kEdge, {}));
  const auto snapshot = scene.commit(Time{1}, {});
  QueryScope scope;
  scope.exclude = {"cloud/*"};
  EXPECT_EQ(query(*snapshot, Sphere{{0, 0, 0}, 0.1}, scope).because, Unknown::unmapped);
  EXPECT_EQ(query(*snapshot, Sphere{{0, 0, 0}, 0.1}, {}).because, Unknown::unmapped);
}

TEST(Unmapped, IsNotAskedUnlessMapsAreToReport) {
  Scene scene{SceneOptions{}};
  scene.setCells(put(scene, mapBody("room"), at(0)), knowing({}, cube(1.0)));
  EXPECT_EQ(query(*scene.commit(Time{1}, {}), Sphere{{5, 0, 0}, 0.1}, {}).verdict, Verdict::clear);
}

TEST(Unmapped, AStaleMapKnowsLess) {
  Scene scene(reporting());
  const BodyId room = put(scene, mapBody("room", Mobility::moving), at(0));  // the map moves with at most 1 m/s
  scene.setCells(room, knowing({}, cube(1.0)));
  const auto because = [&] { return query(*scene.commit(Time{1}, {}), Sphere{{0.5, 0, 0}, 0.2}, {}).because; };
  EXPECT_EQ(because(), Unknown::no);
  scene.setState(room, Freshness::stale, 0.4);
  EXPECT_EQ(because(), Unknown::unmapped);
}

TEST(Unmapped, NearestToABodyLooksAroundAllOfIt) {
  Scene scene(reporting());
  // The unknown cell extends from 1 m to 1.1 m along x.
  scene.setCells(put(scene, mapBody("room"), at(0)), knowing({{32778, 32768, 32768, 0}}, cube(2.0)));
  put(scene, ball("tool", 0.25), at(0));
  const auto snapshot = scene.commit(Time{1}, {});
  const auto because = [&](double limit) {
    return nearest(*snapshot, snapshot->structure().find("obstacle/tool"), limit, {}).because;
  };
  EXPECT_EQ(because(0.7), Unknown::no);
  EXPECT_EQ(because(0.8), Unknown::unmapped);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
