// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <tuple>

#include "hgrid_proximity/partitions/partitions.h"
#include "test/support/buildings.h"
#include "test/support/maps.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::at;
using test::ball;
using test::namedPairs;
using test::put;
using test::Random;

SceneOptions withRooms() {
  SceneOptions options;
  options.building = test::twoRooms();
  return options;
}

/// Returns the rooms of a body, computed anew from all of its boxes; all rooms if the body is anywhere.
std::vector<std::uint32_t> roomsByHand(const Snapshot& snapshot, const Building& building, std::uint32_t body) {
  const Structure& structure = snapshot.structure();
  std::vector<std::uint32_t> all, of_box;
  for (std::uint32_t room = 0; room < building.rooms().size(); ++room) all.push_back(room);
  const double own = std::max(structure.margin[body], structure.pair_margins.largestOf(body));
  const double growth = snapshot.poses()[body].growth, share = own - 0.5 * structure.least_margin;
  std::set<std::uint32_t> rooms;
  for (ProxyId proxy = structure.first_proxy[body]; proxy < structure.first_proxy[body + 1]; ++proxy) {
    const Aabb& box = snapshot.boxes()[proxy];
    building.roomsOf(grown(box, growth), of_box);
    if (of_box.empty()) return all;
    rooms.insert(of_box.begin(), of_box.end());
    for (const Portal& door : building.portals()) {
      if (inDouble(grown(box, growth + share)).intersects(door.opening))
        rooms.insert(door.rooms.begin(), door.rooms.end());
    }
  }
  return {rooms.begin(), rooms.end()};
}

using PairList = std::vector<std::tuple<std::uint32_t, std::uint32_t, double, double>>;

PairList listed(const Snapshot& snapshot) {
  PairList pairs;
  for (const NearPair& pair : snapshot.pairs()) pairs.emplace_back(pair.first, pair.second, pair.gap, pair.margin);
  return pairs;
}

/// Adds, moves and removes bodies of two scenes alike. Most bodies are small and near the wall of test::twoRooms().
class TwinScenes {
 public:
  TwinScenes(const SceneOptions& first, const SceneOptions& second, unsigned seed)
      : first_(first), second_(second), random_(seed) {
    for (int i = 0; i < 40; ++i) add();
  }
  void change() {
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      if (!random_.chance(0.5)) continue;
      const Pose pose = place();
      const Freshness state = random_.chance(0.2) ? Freshness::stale : Freshness::fresh;
      const double age = state == Freshness::stale ? random_.uniform(0, 1) : 0.0;
      for (Scene* scene : {&first_, &second_}) {
        scene->place(ids_[i], pose, Time{++stamp_});
        scene->setState(ids_[i], state, age);
      }
    }
    if (!random_.chance(0.3)) return;
    for (Scene* scene : {&first_, &second_}) scene->remove(ids_.front());
    ids_.erase(ids_.begin());
    add();
  }
  std::shared_ptr<const Snapshot> commitFirst() { return first_.commit(Time{++stamp_}, {}); }
  std::shared_ptr<const Snapshot> commitSecond() { return second_.commit(Time{stamp_}, {}); }

 private:
  void add() {
    Body body = random_.chance(0.3) ? test::randomBody(random_, "b" + std::to_string(++number_))
                                    : ball("b" + std::to_string(++number_), random_.uniform(0.05, 0.2));
    if (random_.chance(0.1)) body.margin = 0.3;
    const BodyId id = first_.add(body);
    EXPECT_EQ(second_.add(body), id);
    ids_.push_back(id);
    const Pose pose = place();
    for (Scene* scene : {&first_, &second_}) scene->place(id, pose, Time{1});
  }
  Pose place() {
    Pose pose = test::randomPose(random_, 0.4);
    pose.translation().x() = random_.uniform(0.1, 0.4) * (random_.chance(0.5) ? 1.0 : -1.0);
    pose.translation().y() = random_.uniform(0.0, 2.5);
    return pose;
  }

  Scene first_, second_;
  Random random_;
  std::vector<BodyId> ids_;
  int number_ = 0;
  std::int64_t stamp_ = 1;
};

/// Claim: with each broad phase, rooms remove exactly the pairs of bodies without a common room, and change nothing of
/// the others.
TEST(SceneRooms, RemoveExactlyThePairsWithoutACommonRoom) {
  std::size_t kept = 0, removed = 0;
  for (const BroadPhaseType type : broadPhaseTypes()) {
    SCOPED_TRACE(name(type));
    SceneOptions plain;
    plain.margin = 0.2;
    plain.pair_margins = {{"obstacle/b7", "*", 0.25}};
    SceneOptions options = plain;
    options.building = test::twoRooms();
    options.broad_phase = [type](double edge, int threads) { return makeBroadPhase({type, edge, threads}); };
    TwinScenes scenes(options, plain, 5);
    for (int tick = 0; tick < 12; ++tick) {
      scenes.change();
      const auto with = scenes.commitFirst(), without = scenes.commitSecond();
      std::vector<std::vector<std::uint32_t>> rooms;
      for (std::uint32_t body = 0; body < with->poses().size(); ++body) {
        rooms.push_back(roomsByHand(*with, *options.building, body));
        ASSERT_EQ(with->rooms()->roomsOf(body), rooms.back()) << with->structure().bodies[body].name;
      }
      PairList expected;
      for (const auto& pair : listed(*without)) {
        const auto &a = rooms[std::get<0>(pair)], &b = rooms[std::get<1>(pair)];
        std::vector<std::uint32_t> common;
        std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
        if (!common.empty()) expected.push_back(pair);
        ++(common.empty() ? removed : kept);
      }
      ASSERT_EQ(listed(*with), expected);
      ASSERT_FALSE(without->rooms());
    }
  }
  EXPECT_GT(removed, 100u);
  EXPECT_GT(kept, 1000u);
}

/// A body at each side of the wall. Their boxes end in the wall and are 0.02 m apart.
class SceneRoomsAtTheWall : public ::testing::Test {
 protected:
  explicit SceneRoomsAtTheWall(const SceneOptions& options = withRooms())
      : scene_(options),
        west_(put(scene_, slow("west"), at(-0.21, 2))),
        east_(put(scene_, slow("east"), at(0.21, 2))) {}
  static Body slow(const std::string& name) {
    Body body = ball(name, 0.2);
    body.max_speed = 0.5;
    return body;
  }
  std::shared_ptr<const Snapshot> commit() { return scene_.commit(Time{++stamp_}, {}); }
  void moveBoth(double y) {
    scene_.place(west_, at(-0.21, y), Time{stamp_});
    scene_.place(east_, at(0.21, y), Time{stamp_});
  }
  static std::size_t numberOf(const Snapshot& snapshot, EventKind kind) {
    std::size_t count = 0;
    for (const PairEvent& event : snapshot.events()) count += event.kind == kind ? 1 : 0;
    return count;
  }

  Scene scene_;
  BodyId west_, east_;
  std::int64_t stamp_ = 1;
};

TEST_F(SceneRoomsAtTheWall, OnlyADoorMakesThemAPair) {
  EXPECT_EQ(commit()->pairs().size(), 0u);
  moveBoth(0.0);
  const auto in_door = commit();
  EXPECT_EQ(in_door->pairs().size(), 1u);
  EXPECT_EQ(numberOf(*in_door, EventKind::begin), 1u);
  moveBoth(1.5);
  const auto past_it = commit();
  EXPECT_EQ(past_it->pairs().size(), 0u);
  ASSERT_EQ(numberOf(*past_it, EventKind::end), 1u) << "although the gap is the same";
  EXPECT_EQ(past_it->events()[0].cause, EventCause::moved);
}

/// Claim: what may be in several places counts in all rooms that these are in.
TEST_F(SceneRoomsAtTheWall, AnOldPoseCountsInEachRoomThatTheBodyCanHaveReached) {
  scene_.setState(west_, Freshness::stale, 0.5);  // it may be up to x = 0.24
  EXPECT_EQ(commit()->pairs().size(), 0u);
  scene_.setState(west_, Freshness::stale, 0.6);
  const auto stale = commit();
  ASSERT_EQ(stale->pairs().size(), 1u);
  EXPECT_EQ(stale->rooms()->roomsOf(test::indexOf(*stale, "obstacle/west")).size(), 2u);
  scene_.setState(west_, Freshness::fresh, 0.0);
  EXPECT_EQ(commit()->pairs().size(), 0u);
}

TEST_F(SceneRoomsAtTheWall, TheHorizonCountsEachRoomThatTheBodyCanReach) {
  for (const bool is_on : {true, false}) {
    scene_.tune({0.1, 0.02, 1.0, is_on ? 1.0 : 0.0});
    EXPECT_EQ(commit()->pairs().size(), is_on ? 1u : 0u);
  }
}

/// Claim: bodies on both sides of a door are a pair if the way through it is within their margin. Margins do not reach
/// through walls.
TEST_F(SceneRoomsAtTheWall, AMarginReachesThroughDoorsButNotThroughWalls) {
  for (const double margin : {0.6, 0.1, 0.6}) {
    scene_.tune({margin, 0.02, 1.0, 0.0});
    moveBoth(2.0);
    EXPECT_EQ(commit()->pairs().size(), 0u);
    moveBoth(0.9);  // 0.2 m beside the door
    EXPECT_EQ(commit()->pairs().size(), margin == 0.6 ? 1u : 0u);
    scene_.place(west_, at(-0.5, 0), Time{stamp_});  // 0.05 m in front of the door
    scene_.place(east_, at(0.5, 0), Time{stamp_});
    EXPECT_EQ(commit()->pairs().size(), margin == 0.6 ? 1u : 0u) << "their gap is 0.6 m";
  }
}

TEST_F(SceneRoomsAtTheWall, ABodyOfWhichABoxIsInNoRoomMakesPairsWithAll) {
  Body antenna = ball("antenna", 0.2);
  antenna.shapes.push_back(test::shapeOf(Shape::sphere(0.1)));
  antenna.shapes.back().body_from_shape = at(0, 0, 4.0);
  const BodyId id = put(scene_, antenna, at(-0.21, 2, 0));
  const auto inside = commit();
  EXPECT_EQ(namedPairs(*inside), (test::NamePairs{{"obstacle/antenna", "obstacle/west"}}));
  scene_.place(id, at(-0.21, 2, 0.35), Time{stamp_});  // one of its boxes is above the rooms
  const auto partly = commit();
  EXPECT_EQ(namedPairs(*partly),
            (test::NamePairs{{"obstacle/antenna", "obstacle/east"}, {"obstacle/antenna", "obstacle/west"}}));
  EXPECT_TRUE(partly->rooms()->isAnywhere(test::indexOf(*partly, "obstacle/antenna")));
}

TEST_F(SceneRoomsAtTheWall, PlanesAndMapsMakePairsWithAll) {
  Body wall = test::planeBody("wall");  // a plane in the east, whose solid side is the west
  wall.shapes.push_back(test::shapeOf(Shape::sphere(0.1)));
  wall.shapes.back().body_from_shape = at(0, 0, 1.0);
  Pose facing_east = at(0.5, 2);
  facing_east.rotate(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY()));
  put(scene_, wall, facing_east);
  const BodyId map = put(scene_, test::mapBody("cells", Mobility::moving), at(0.15, 2));
  scene_.setCells(map, test::cellsOf(0.5, {{Voxel::kOriginKey, Voxel::kOriginKey, Voxel::kOriginKey, 0}}));
  Body small = ball("small", 0.05);
  small.margin = 0.4;
  put(scene_, small, at(-0.25, 2));
  const auto snapshot = commit();
  EXPECT_FALSE(
      snapshot->areSeparate(test::indexOf(*snapshot, "obstacle/wall"), test::indexOf(*snapshot, "obstacle/west")));
  EXPECT_EQ(namedPairs(*snapshot), (test::NamePairs{{"map/cells", "obstacle/small"},
                                                    {"obstacle/small", "obstacle/wall"},
                                                    {"obstacle/small", "obstacle/west"},
                                                    {"map/cells", "obstacle/east"},
                                                    {"obstacle/east", "obstacle/wall"},
                                                    {"obstacle/wall", "obstacle/west"}}));
}

TEST_F(SceneRoomsAtTheWall, QueriesDoNotDependOnRooms) {
  std::vector<ProxyId> found;
  commit()->broadPhase().overlapping(Sphere{{0.0, 2.0, 0.0}, 0.1}, found);
  EXPECT_EQ(found.size(), 2u);
}

TEST(SceneRooms, AreInTheWorldFrameWhateverTheOrigin) {
  SceneOptions options = withRooms();
  options.origin = {100.0, -50.0, 3.0};
  Scene scene(options);
  for (const double y : {0.0, 2.0}) {
    const std::string number = std::to_string(int(y));
    put(scene, ball("west" + number, 0.2), at(-0.21, y));
    put(scene, ball("east" + number, 0.2), at(0.21, y));
  }
  EXPECT_EQ(namedPairs(*scene.commit(Time{1}, {})), (test::NamePairs{{"obstacle/east0", "obstacle/west0"}}));
}

/// Claim: a body that gets its first pose where another body of the same form is has the same rooms.
TEST_F(SceneRoomsAtTheWall, ABodyIsInItsRoomsFromItsFirstPoseOn) {
  const BodyId late = scene_.add(slow("a"));  // the first body by name, so that it takes the place of "east" in lists
  EXPECT_EQ(commit()->pairs().size(), 0u);
  scene_.place(late, at(0.21, 2), Time{stamp_});
  const auto snapshot = commit();
  EXPECT_EQ(snapshot->rooms()->roomsOf(test::indexOf(*snapshot, "obstacle/a")), std::vector<std::uint32_t>({1}));
  EXPECT_EQ(namedPairs(*snapshot), (test::NamePairs{{"obstacle/a", "obstacle/east"}}));
}

/// Claim: a pair that only truncation keeps from the list ends when its bodies no longer have a room in common.
TEST(SceneRooms, EndPairsThatTruncationHides) {
  SceneOptions options = withRooms();
  options.max_pairs = 1;
  Scene scene(options);
  const BodyId west = put(scene, ball("west", 0.2), at(-0.21, 0)), east = put(scene, ball("east", 0.2), at(0.21, 0));
  const BodyId third = put(scene, ball("third", 0.2), at(-5, 0)), fifth = put(scene, ball("fifth", 0.2), at(-6, 0));
  put(scene, ball("fourth", 0.2), at(-4, 0));
  EXPECT_EQ(namedPairs(*scene.commit(Time{1}, {})), (test::NamePairs{{"obstacle/east", "obstacle/west"}}));
  for (const BodyId id : {third, fifth}) scene.place(id, at(-4, 0), Time{2});
  const auto cut = scene.commit(Time{2}, {});
  EXPECT_EQ(namedPairs(*cut), (test::NamePairs{{"obstacle/fifth", "obstacle/fourth"}}));
  for (const PairEvent& event : cut->events()) EXPECT_EQ(event.kind, EventKind::begin);
  scene.place(west, at(-0.21, 2), Time{3});
  scene.place(east, at(0.21, 2), Time{3});
  const auto apart = scene.commit(Time{3}, {});
  EXPECT_TRUE(apart->truncated());
  ASSERT_GE(apart->events().size(), 1u);
  EXPECT_EQ(apart->events()[0].kind, EventKind::end);
}

TEST(BodyRooms, HoldAnyNumberOfRooms) {
  for (const std::uint32_t count : {1u, 63u, 64u, 65u, 130u}) {
    SCOPED_TRACE(count);
    std::vector<Room> rooms;
    for (std::uint32_t i = 0; i < count; ++i) {
      rooms.push_back(Room::ofBox(std::to_string(i), test::block(2.0 * i, 0, 0, 2.0 * i + 1, 1, 1)));
    }
    BodyRooms bodies(std::make_shared<const Building>(rooms, std::vector<Portal>{}), 4);
    EXPECT_FALSE(bodies.areSeparate(0, 1)) << "both are anywhere";
    bodies.set(0, {0});
    bodies.set(1, {count - 1});
    EXPECT_EQ(bodies.areSeparate(0, 1), count > 1);
    EXPECT_FALSE(bodies.areSeparate(1, 2)) << "body 2 is anywhere";
    EXPECT_TRUE(bodies.isAnywhere(2));
    EXPECT_FALSE(bodies.isAnywhere(1));
    EXPECT_EQ(bodies.roomsOf(1), std::vector<std::uint32_t>({count - 1}));
    EXPECT_EQ(bodies.roomsOf(2).size(), count);
    EXPECT_TRUE(bodies.has(1, {count - 1}));
    EXPECT_FALSE(bodies.has(1, {}));
    EXPECT_TRUE(bodies.has(2, {}));
    bodies.set(3, bodies.roomsOf(2));
    EXPECT_FALSE(bodies.isAnywhere(3)) << "it is in all rooms, but not outside of them";
    bodies.set(0, {});
    EXPECT_FALSE(bodies.areSeparate(0, 1));
  }
}

}  // namespace
}  // namespace hgrid
