// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Places UR5 and PR2 at random in the map of a real building. Compares candidate pairs and exact distances with a scan
// of all leaves of the map. Uses a fifth of the number of states in the environment variable HGRID_TEST_STATES.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/adapters/octomap.h"
#include "hgrid_proximity/distances/pair_meter.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

constexpr double kMargin = 0.1;  // [m]
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Octomap building(const std::string& folder) {
  ResourcePolicy policy;
  policy.file_roots = {folder};
  return readOctomapFile(openResource("file://" + folder + "/geb079.bt", policy));
}

/// A robot in the map of the building, and a list of all leaves for the scan.
class RobotInBuilding {
 public:
  RobotInBuilding(const std::string& robot, Octomap octomap) : octomap_(std::move(octomap)), scene_(options()) {
    MeshLoader loader(meshPolicy());
    urdf_ = realRobot(robot).urdf;
    model_ = readWith(loader, urdf_);
    std::vector<std::string> warnings;
    const auto matrix = std::make_shared<const LinkMatrix>(model_, LinkRules{}, warnings);
    links_ = addLinks(scene_, model_, matrix, narrow_phase_.get());
    Body map;
    map.name = "map/building";
    map.frame = "world";
    map.kind = BodyKind::map;
    map.mobility = Mobility::fixed;
    const BodyId id = scene_.add(map);
    scene_.place(id, Pose::Identity(), Time{1});
    scene_.setState(id, Freshness::fresh, 0.0);
    const auto grid = std::make_shared<StaticGrid>(octomap_.resolution, octomap_.occupied);
    scene_.setCells(id, makeMapCells(grid, *narrow_phase_));
    bounds_ = grid->bounds();
    for (const Voxel& voxel : octomap_.occupied) {
      low_.push_back(minCorner(voxel, octomap_.resolution));
      high_.push_back(maxCorner(voxel, octomap_.resolution));
    }
  }

  void drive(int states) {
    RandomStates random_states(model_, urdf_, 11);
    Random random(12);
    for (int state = 1; state <= states; ++state) {
      Pose world_from_root = Pose::Identity();
      for (int axis = 0; axis < 3; ++axis) {
        world_from_root.translation()[axis] = random.uniform(bounds_.min()[axis], bounds_.max()[axis]);
      }
      world_from_root.linear() =
          Eigen::AngleAxisd(random.uniform(-M_PI, M_PI), Eigen::Vector3d::UnitZ()).toRotationMatrix();
      const std::vector<Pose> root_from_links = random_states.next();
      for (const auto& [link, id] : links_) {
        scene_.place(id, world_from_root * root_from_links[link], Time{state});
        scene_.setState(id, Freshness::fresh, 0.0);
      }
      SCOPED_TRACE("state " + std::to_string(state));
      ASSERT_NO_FATAL_FAILURE(expectRight(*scene_.commit(Time{state}, {})));
    }
  }

  std::size_t near = 0, contacts = 0;

 private:
  static SceneOptions options() {
    SceneOptions options;
    options.margin = kMargin;
    return options;
  }

  double gapOf(const Aabb& box, std::size_t leaf) const {
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double gap = std::max(std::max(low_[leaf][axis] - static_cast<double>(box.max[axis]),
                                           static_cast<double>(box.min[axis]) - high_[leaf][axis]),
                                  0.0);
      sum += gap * gap;
    }
    return std::sqrt(sum);
  }

  double distanceOf(const Snapshot& snapshot, std::uint32_t body, std::uint32_t shape, std::size_t leaf) const {
    const BodyShape& measured = snapshot.structure().bodies[body].shapes[shape];
    const auto cube = narrow_phase_->block(high_[leaf] - low_[leaf]);
    const Pose world_from_cube(Eigen::Translation3d(0.5 * (low_[leaf] + high_[leaf])));
    const Pose world_from_shape = snapshot.poses()[body].world_from_body * measured.body_from_shape;
    return narrow_phase_
        ->measure({*measured.solid, world_from_shape, measured.padding}, {*cube, world_from_cube, 0.0}, kInfinity)
        .distance;
  }

  void expectRight(const Snapshot& snapshot) {
    const Structure& structure = snapshot.structure();
    const std::uint32_t map = structure.maps.at(0);
    for (std::uint32_t body = 0; body < structure.bodies.size(); ++body) {
      if (body == map) continue;
      SCOPED_TRACE(structure.bodies[body].name);
      double gap = kInfinity;
      std::vector<std::pair<std::uint32_t, std::size_t>> close;  // (shape, leaf) within the margin
      for (ProxyId proxy = structure.first_proxy[body]; proxy < structure.first_proxy[body + 1]; ++proxy) {
        for (std::size_t leaf = 0; leaf < low_.size(); ++leaf) {
          const double here = gapOf(snapshot.boxes()[proxy], leaf);
          gap = std::min(gap, here);
          if (here <= kMargin) close.emplace_back(proxy - structure.first_proxy[body], leaf);
        }
      }
      const auto key = std::minmax(map, body);
      const bool reported = std::any_of(snapshot.pairs().begin(), snapshot.pairs().end(), [&](const NearPair& pair) {
        return pair.first == key.first && pair.second == key.second;
      });
      if (std::abs(gap - kMargin) > 1e-9) {
        ASSERT_EQ(reported, gap < kMargin) << gap;
      }
      if (!reported) continue;
      ++near;
      const PairDistance found = measurePair(*narrow_phase_, snapshot, key.first, key.second, kMargin);
      const double distance = found.proximity.distance;
      contacts += distance == 0.0 ? 1 : 0;
      double least = kInfinity;
      for (const auto& [shape, leaf] : close) {  // leaves beyond the margin cannot be nearer
        if (least == 0.0 || gapOf(snapshot.boxes()[structure.first_proxy[body] + shape], leaf) > distance + 1e-9)
          continue;
        least = std::min(least, distanceOf(snapshot, body, shape, leaf));
      }
      if (std::isinf(distance)) {
        EXPECT_GT(least, kMargin - 1e-9);
      } else {
        EXPECT_NEAR(distance, least, 1e-8);
      }
    }
  }

  Octomap octomap_;
  std::shared_ptr<NarrowPhase> narrow_phase_ = makeCoreNarrowPhase();
  Scene scene_;
  std::string urdf_;
  RobotModel model_;
  std::vector<std::pair<std::uint32_t, BodyId>> links_;
  Eigen::AlignedBox3d bounds_;
  std::vector<Eigen::Vector3d> low_, high_;  // corners of the leaves
};

class RobotsInAMap : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Robots, RobotsInAMap, ::testing::Values("ur5", "pr2"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(RobotsInAMap, HaveThePairsAndDistancesOfAScanOfAllLeaves) {
  HGRID_NEEDS_SHARED_DATA();
  const std::string folder = std::filesystem::canonical(sharedData()).string() + "/octomap";
  if (!std::filesystem::exists(folder + "/geb079.bt")) GTEST_SKIP() << "no geb079.bt in " << folder;
  RobotInBuilding trial(GetParam(), building(folder));
  const int states = std::max(1, countFromEnvironment("HGRID_TEST_STATES", 1000) / 5);
  trial.drive(states);
  std::printf("  %s in geb079: %zu pairs with the map, %zu in contact\n", GetParam(), trial.near, trial.contacts);
  EXPECT_GE(trial.near, static_cast<std::size_t>(states)) << "the robot is rarely near the building";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
