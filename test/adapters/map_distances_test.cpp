// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares exact distances between bodies and maps with measurements of all cells.
#include <gtest/gtest.h>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/distances/pair_meter.h"
#include "hgrid_proximity/queries/query.h"
#include "test/support/maps.h"
#include "test/support/solids.h"

namespace hgrid {
namespace test {
namespace {

constexpr double kEdge = 0.1, kInfinity = std::numeric_limits<double>::infinity();

/// A world of two maps and of bodies with one to three solids. The name of one map comes after the names of the bodies.
class MapDistances : public ::testing::TestWithParam<unsigned> {
 protected:
  MapDistances() : random_(GetParam()) {
    for (const std::string name : {"map/room", "zone/cloud"}) {
      Body body = mapBody("room", Mobility::moving);
      body.name = name;
      ids_[name] = put(scene_, body, pose());
      fill(name);
    }
    for (int i = 0; i < 6; ++i) {
      Body body = obstacle(std::to_string(i));
      for (int shapes = random_.between(1, 3); shapes > 0; --shapes) {
        const auto kind = ShapeKind(random_.between(1, 7));
        BodyShape shape = shapeOf(randomSolid(random_, kind, {0.05, 0.5, 10.0}));
        shape.body_from_shape = randomPose(random_, 0.3);
        shape.padding = random_.chance(0.5) ? 0.02 : 0.0;
        shape.solid = narrow_phase_->solidOf(shape.shape);
        body.shapes.push_back(shape);
      }
      ids_[body.name] = put(scene_, body, pose());
    }
  }
  static SceneOptions options() {
    SceneOptions options;
    options.margin = 0.5;
    return options;
  }
  Pose pose() { return randomPose(random_, 1.5); }
  void fill(const std::string& name) {
    voxels_[name] = randomVoxels(random_, 150, 15);
    const auto grid = std::make_shared<StaticGrid>(kEdge, voxels_[name]);
    scene_.setCells(ids_[name], makeMapCells(grid, *narrow_phase_));
  }
  /// Returns the distances [m] of all cells of a map from a body, in ascending order.
  std::vector<double> distancesByHand(const Snapshot& snapshot, std::uint32_t map, std::uint32_t body) const {
    std::vector<double> distances;
    for (const Voxel& voxel : voxels_.at(snapshot.structure().bodies[map].name)) {
      const double edge = edgeOf(voxel, kEdge);
      const auto cube = narrow_phase_->solidOf(Shape::box({edge, edge, edge}));
      const Eigen::Vector3d middle = minCorner(voxel, kEdge) + Eigen::Vector3d::Constant(0.5 * edge);
      const Pose world_from_cube = snapshot.poses()[map].world_from_body * Eigen::Translation3d(middle);
      double least = kInfinity;
      for (const BodyShape& shape : snapshot.structure().bodies[body].shapes) {
        const Pose world_from_shape = snapshot.poses()[body].world_from_body * shape.body_from_shape;
        least = std::min(least, narrow_phase_
                                    ->measure({*shape.solid, world_from_shape, shape.padding},
                                              {*cube, world_from_cube, 0.0}, kInfinity)
                                    .distance);
      }
      distances.push_back(least);
    }
    std::sort(distances.begin(), distances.end());
    return distances;
  }

  Random random_;
  std::shared_ptr<NarrowPhase> narrow_phase_ = makeCoreNarrowPhase();
  Scene scene_{options()};
  std::map<std::string, BodyId> ids_;
  std::map<std::string, std::vector<Voxel>> voxels_;
};

INSTANTIATE_TEST_SUITE_P(Worlds, MapDistances, ::testing::Range(1u, 9u));

TEST_P(MapDistances, OfPairsAreThoseOfTheNearestCells) {
  const auto snapshot = scene_.commit(Time{1}, {});
  const Structure& structure = snapshot->structure();
  for (const std::uint32_t map : structure.maps) {
    for (std::uint32_t body = 0; body < structure.bodies.size(); ++body) {
      if (structure.bodies[body].kind == BodyKind::map) continue;
      SCOPED_TRACE(structure.bodies[map].name + " and " + structure.bodies[body].name);
      const std::vector<double> expected = distancesByHand(*snapshot, map, body);
      const auto [first, second] = std::minmax(map, body);
      const PairDistance found = measurePair(*narrow_phase_, *snapshot, first, second, kInfinity);
      ASSERT_NEAR(found.proximity.distance, expected.front(), 1e-8);
      EXPECT_EQ(isContact(found.proximity.status), expected.front() == 0.0);
      ASSERT_EQ(found.cells.size(), kNearCells);
      for (std::size_t i = 0; i < kNearCells; ++i) EXPECT_NEAR(found.cells[i].distance, expected[i], 1e-8);
      if (expected.front() > 0.0) {  // the map can be the first or the second body of the pair
        const Eigen::Vector3d way = found.proximity.on_second - found.proximity.on_first;
        EXPECT_NEAR(way.norm(), expected.front(), 1e-6);
        const Eigen::Vector3d on_map = first == map ? found.proximity.on_first : found.proximity.on_second;
        const Eigen::Vector3d off = (snapshot->poses()[map].world_from_body.inverse() * on_map) -
                                    snapshot->poses()[map].world_from_body.inverse() * found.cells.front().center;
        EXPECT_LE(off.cwiseAbs().maxCoeff(), 0.5 * found.cells.front().edge + 1e-6) << "the point is not on the cell";
      }
      const PairDistance bounded = measurePair(*narrow_phase_, *snapshot, first, second, 0.1);
      EXPECT_EQ(std::isinf(bounded.proximity.distance), expected.front() > 0.1);
      const auto contacts = contactsOf(*narrow_phase_, *snapshot, first, second, 1000);
      EXPECT_EQ(contacts.empty(), expected.front() > 0.0);
    }
  }
}

TEST_P(MapDistances, FromTickToTickEqualNewMeasurements) {
  constexpr double kReport = 0.1;  // [m] so small that many pairs are known to be farther apart
  PairMeter meter(narrow_phase_, {kReport, 0.0, 1});
  std::size_t measured = 0;
  for (int tick = 1; tick <= 40; ++tick) {
    SCOPED_TRACE("tick " + std::to_string(tick));
    const int change = random_.below(6);
    if (change == 0) fill("map/room");
    if (change == 1) scene_.place(ids_["zone/cloud"], pose(), Time{tick});
    if (change > 1) {  // moves a body by a small step
      const std::string name = change == 2 ? "map/room" : "obstacle/" + std::to_string(random_.below(6));
      const Pose step = randomPose(random_, 0.01);
      Pose moved = scene_.poseOf(ids_[name]).world_from_body;
      moved.translation() += step.translation();
      const Eigen::AngleAxisd turn(random_.uniform(-0.05, 0.05), step.linear().col(0));
      moved.linear() = Eigen::Quaterniond(moved.linear() * turn).normalized().toRotationMatrix();
      scene_.place(ids_[name], moved, Time{tick});
    }
    const auto snapshot = scene_.commit(Time{tick}, {});
    const auto distances = meter.measure(*snapshot);
    std::map<std::pair<std::uint32_t, std::uint32_t>, const PairDistance*> told;
    for (const PairDistance& pair : distances->pairs) told[{pair.first, pair.second}] = &pair;
    for (const NearPair& pair : snapshot->pairs()) {
      const PairDistance anew = measurePair(*narrow_phase_, *snapshot, pair.first, pair.second, kInfinity);
      const auto found = told.find({pair.first, pair.second});
      ASSERT_EQ(found != told.end(), anew.proximity.distance <= kReport);
      if (found == told.end()) continue;
      ASSERT_NEAR(found->second->proximity.distance, anew.proximity.distance, 1e-8);
      ASSERT_EQ(found->second->cells.empty(), anew.cells.empty());
      ++measured;
    }
  }
  EXPECT_GT(measured, 40u);
}

// A bar rotates about the origin of the map and comes nearer to a cell, although the position of the bar stays the
// same.
TEST(MapDistancesOfABar, ThatTurnsTowardsACellAreMeasuredAgain) {
  const std::shared_ptr<NarrowPhase> narrow_phase = makeCoreNarrowPhase();
  SceneOptions options;
  options.margin = 0.5;
  Scene scene(options);
  Body zone = mapBody("zone"), bar = obstacle("bar");
  zone.name = "zone/cells";  // this name comes after the name of the bar
  BodyShape shape = shapeOf(Shape::box({2.0, 0.1, 0.1}));
  shape.solid = narrow_phase->solidOf(shape.shape);
  bar.shapes.push_back(shape);
  const BodyId id = put(scene, bar, at(0));  // turn() rotates the bar until its AABB contains the cell
  const auto grid = std::make_shared<StaticGrid>(0.01, std::vector<Voxel>{{32768 + 54, 32768 + 79, 32768, 0}});
  scene.setCells(put(scene, zone, at(0)), makeMapCells(grid, *narrow_phase));  // cell and bar are 0.12 m apart
  PairMeter meter(narrow_phase, {0.1, 0.0, 1});
  const auto turn = [&](double angle) {
    Pose turned = Pose::Identity();
    turned.linear() = Eigen::AngleAxisd(0.25 * M_PI + angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    scene.place(id, turned, Time{2});
    return meter.measure(*scene.commit(Time{2}, {}));
  };
  EXPECT_TRUE(turn(0.0)->pairs.empty());
  EXPECT_TRUE(turn(1e-6)->pairs.empty())
      << "the meter searches farther than it reports, so a small move needs no new search";
  const auto distances = turn(0.05);
  ASSERT_EQ(distances->pairs.size(), 1u);
  EXPECT_NEAR(distances->pairs.front().proximity.distance, 0.073, 0.002);
}

TEST_P(MapDistances, OfExactQueriesAreThoseOfTheNearestCells) {
  const auto snapshot = scene_.commit(Time{1}, {});
  QueryScope scope;
  scope.include = {"map/room", "zone/cloud"};
  scope.exact = narrow_phase_.get();
  scope.limit = 2;
  for (std::uint32_t body = 0; body < snapshot->structure().bodies.size(); ++body) {
    if (snapshot->structure().bodies[body].kind == BodyKind::map) continue;
    const QueryAnswer answer = nearest(*snapshot, body, 0.0, scope);
    ASSERT_EQ(answer.hits.size(), 2u);
    for (const QueryHit& hit : answer.hits) {
      EXPECT_NEAR(hit.distance, distancesByHand(*snapshot, hit.body, body).front(), 1e-8);
    }
  }
  for (int i = 0; i < 50; ++i) {
    const QueryBox box{pose(), {random_.uniform(0.0, 1.0), random_.uniform(0.0, 1.0), random_.uniform(0.0, 1.0)}};
    const QueryAnswer answer = query(*snapshot, box, *narrow_phase_, scope);
    const auto core = narrow_phase_->block(box.size);
    for (const std::uint32_t map : snapshot->structure().maps) {
      bool met = false;
      for (const Voxel& voxel : voxels_.at(snapshot->structure().bodies[map].name)) {
        const double edge = edgeOf(voxel, kEdge);
        const auto cube = narrow_phase_->solidOf(Shape::box({edge, edge, edge}));
        const Eigen::Vector3d middle = minCorner(voxel, kEdge) + Eigen::Vector3d::Constant(0.5 * edge);
        const Pose world_from_cube = snapshot->poses()[map].world_from_body * Eigen::Translation3d(middle);
        met = met || isContact(narrow_phase_
                                   ->measure({*core, box.world_from_box, 0.0}, {*cube, world_from_cube, 0.0}, kInfinity)
                                   .status);
      }
      const bool said =
          std::any_of(answer.hits.begin(), answer.hits.end(), [&](const QueryHit& hit) { return hit.body == map; });
      EXPECT_EQ(said, met);
    }
  }
}

// A box query must be CLEAR exactly if the box is inside the extent of the map and touches no unknown cell.
TEST(UnmappedBoxes, AreThoseOfAScanOfAllUnknownCells) {
  const auto narrow_phase = makeCoreNarrowPhase();
  std::size_t clear = 0, unknown_space = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    Random random(seed);
    const std::vector<Voxel> unknown = randomVoxels(random, 60, 20);
    const double half = random.uniform(1.0, 2.0);
    const Eigen::AlignedBox3d extent(Eigen::Vector3d::Constant(-half), Eigen::Vector3d::Constant(half));
    SceneOptions options;
    options.report_unmapped = true;
    Scene scene(options);
    const Pose world_from_map = randomPose(random, 5.0);
    const auto space = std::make_shared<UnmappedSpace>(UnmappedSpace{StaticGrid(kEdge, unknown), extent});
    const auto none = std::make_shared<StaticGrid>(kEdge, std::vector<Voxel>{});
    scene.setCells(put(scene, mapBody("room"), world_from_map), makeMapCells(none, *narrow_phase, space));
    const auto snapshot = scene.commit(Time{1}, {});
    for (int i = 0; i < 100; ++i) {
      const Pose map_from_box = randomPose(random, 1.5);
      const QueryBox box{world_from_map * map_from_box, Eigen::Vector3d(random.uniform(0.0, 0.6), 0.2, 0.1)};
      double room = kInfinity;  // [m] distance of the box from unknown space; <= 0 if they touch
      for (int corner = 0; corner < 8; ++corner) {
        Eigen::Vector3d at = 0.5 * box.size;
        for (int axis = 0; axis < 3; ++axis) at[axis] *= corner >> axis & 1 ? 1.0 : -1.0;
        at = map_from_box * at;
        room = std::min({room, (at - extent.min()).minCoeff(), (extent.max() - at).minCoeff()});
      }
      const auto solid = narrow_phase->solidOf(Shape::box(box.size.cwiseMax(1e-3)));
      for (const Voxel& voxel : unknown) {
        const double edge = edgeOf(voxel, kEdge);
        const auto cube = narrow_phase->solidOf(Shape::box({edge, edge, edge}));
        const Pose world_from_cube =
            world_from_map * Eigen::Translation3d(minCorner(voxel, kEdge) + Eigen::Vector3d::Constant(0.5 * edge));
        room = std::min(
            room, narrow_phase->measure({*solid, box.world_from_box, 0.0}, {*cube, world_from_cube, 0.0}, kInfinity)
                      .distance);
      }
      if (std::abs(room) < 1e-3 && room != 0.0) continue;
      const QueryAnswer answer = query(*snapshot, box, *narrow_phase, {});
      ASSERT_EQ(answer.because, room > 0.0 ? Unknown::no : Unknown::unmapped) << "seed " << seed << ", " << room;
      ASSERT_EQ(answer.verdict, room > 0.0 ? Verdict::clear : Verdict::unknown);
      ++(room > 0.0 ? clear : unknown_space);
    }
  }
  EXPECT_GT(clear, 100u);
  EXPECT_GT(unknown_space, 100u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
