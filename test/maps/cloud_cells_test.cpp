// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares the cells of a cloud with a simple model. The model stores cells of a lattice that covers the whole world.
#include "hgrid_proximity/maps/cloud_cells.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "test/support/maps.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace test {
namespace {

using Keys = std::array<std::int64_t, 3>;
constexpr std::size_t kPlenty = 1000000;

Time at(double seconds) { return Time(static_cast<std::int64_t>(seconds * 1e9)); }

/// Returns the keys of the cells on the lattice of the world.
std::vector<Keys> latticeOf(const CloudCells& cloud) {
  std::vector<Keys> all;
  for (const Voxel& voxel : cloud.cells()) {
    const Eigen::Vector3d low = cloud.corner() + minCorner(voxel, cloud.edge());
    Keys keys;
    for (int axis = 0; axis < 3; ++axis) keys[axis] = std::llround(low[axis] / cloud.edge());
    all.push_back(keys);
  }
  std::sort(all.begin(), all.end());
  return all;
}

TEST(CloudCells, AreThoseOfTheModelWhateverIsSeenAndWhereverTheSensorGoes) {
  std::size_t jumps = 0, forgotten = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const double edge = std::pow(10.0, random.uniform(-2.0, 0.0));
    CloudCells cloud(edge, at(1.0), kPlenty);
    std::map<Keys, double> model;  // [s] time at which each cell was last seen
    Eigen::Vector3d sensor = Eigen::Vector3d(1e5, -3e4, 10.0) * random.below(2);
    double now = 100.0;
    for (int step = 0; step < 60; ++step) {
      now += random.uniform(0.0, 0.5);
      if (random.chance(0.1)) sensor.x() += edge * random.uniform(-2.5, 2.5) * CloudCells::kReach;
      for (int axis = 0; axis < 3; ++axis) sensor[axis] += random.uniform(-1.0, 1.0);
      const Eigen::Vector3d before = cloud.corner();
      const std::size_t lost = cloud.follow(sensor);
      jumps += cloud.corner() != before;
      std::size_t gone = 0;
      for (auto one = model.begin(); one != model.end();) {  // removes the cells whose keys are out of range
        bool in_reach = true;
        for (int axis = 0; axis < 3; ++axis) {
          const std::int64_t key = one->first[axis] - std::llround(cloud.corner()[axis] / edge) + Voxel::kOriginKey;
          in_reach = in_reach && key >= 0 && key <= 0xffff;
        }
        gone += !in_reach;
        one = in_reach ? std::next(one) : model.erase(one);
      }
      EXPECT_EQ(lost, gone);

      std::vector<Eigen::Vector3d> points;
      for (int i = random.below(50); i > 0; --i) {
        Eigen::Vector3d point = sensor + randomPose(random, 40.0 * edge).translation();
        if (random.chance(0.3)) point = edge * (point / edge).array().round().matrix();  // on the border of a cell
        if (!points.empty() && random.chance(0.3)) point = points.back();
        points.push_back(point);
      }
      std::size_t left_out = 0;
      const std::vector<Voxel> cells = cloud.cellsOf(points, sensor, left_out);
      EXPECT_EQ(left_out, 0u);
      const double stamp = now - random.uniform(0.0, 0.3);
      cloud.see(cells, at(stamp));
      for (const Eigen::Vector3d& point : points) {
        Keys keys;
        for (int axis = 0; axis < 3; ++axis) keys[axis] = std::llround(std::floor(point[axis] * (1.0 / edge)));
        double& seen = model.emplace(keys, stamp).first->second;
        seen = std::max(seen, stamp);
      }
      cloud.forget(at(now));
      for (auto one = model.begin(); one != model.end();) {
        const bool old = at(now) - at(one->second) > at(1.0);
        forgotten += old;
        one = old ? model.erase(one) : std::next(one);
      }
      std::vector<Keys> expected;
      for (const auto& one : model) expected.push_back(one.first);
      ASSERT_EQ(latticeOf(cloud), expected);
      StaticGrid(edge, cloud.cells());  // throws if the cells are not disjoint or not sorted
    }
  }
  EXPECT_GT(jumps, 20u);
  EXPECT_GT(forgotten, 1000u);
}

TEST(CloudCells, PointsOutOfReachAreCounted) {
  CloudCells cloud(0.1, at(1.0), kPlenty);
  const double reach = 0.1 * CloudCells::kReach;
  const std::vector<Eigen::Vector3d> points{
      {0, 0, 0}, {reach - 0.05, 0, 0}, {reach + 0.05, 0, 0}, {0, -1e9, 0}, {0, 0, 1e300}};
  std::size_t left_out = 0;
  EXPECT_EQ(cloud.cellsOf(points, {0, 0, 0}, left_out).size(), 2u);
  EXPECT_EQ(left_out, 3u);
}

TEST(CloudCells, OneTooManyIsRefusedAndChangesNothing) {
  CloudCells cloud(0.1, at(1.0), 2);
  const auto see = [&](const std::vector<Eigen::Vector3d>& points) {
    std::size_t left_out = 0;
    cloud.see(cloud.cellsOf(points, {0, 0, 0}, left_out), at(1.0));
  };
  see({{0, 0, 0}, {1, 0, 0}});
  EXPECT_EQ(refusalOf([&] { see({{0, 0, 0}, {2, 0, 0}}); }), Code::limit);
  EXPECT_EQ(cloud.size(), 2u);
  see({{1, 0, 0}});
  EXPECT_EQ(cloud.size(), 2u) << "a known cell must not be counted again";
}

TEST(CloudCells, WhatIsSeenAgainStays) {
  CloudCells cloud(0.1, at(1.0), kPlenty);
  std::size_t left_out = 0;
  const std::vector<Voxel> one = cloud.cellsOf({{0, 0, 0}}, {0, 0, 0}, left_out);
  cloud.see(one, at(1.0));
  cloud.see(one, at(1.5));
  cloud.see(one, at(1.2));  // an older message that arrives late must not shorten the lifetime
  EXPECT_EQ(cloud.forget(at(2.5)), 0u) << "the age of the cell equals its lifetime, but does not exceed it";
  EXPECT_EQ(cloud.forget(at(2.6)), 1u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
