// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Requests of ~apply_obstacles, from the message to the snapshot of the next tick. The tests need no ROS master.
#include <fstream>

#include "test/node/support/settings.h"
#include "test/node/world/obstacle_world.h"

namespace hgrid {
namespace test {
namespace {

TEST_F(Obstacles, AreAddedMovedAndRemovedInTheNextTick) {
  EXPECT_EQ(placesIn(tick()), (Places{{"post", 3}}));
  apply({adding("part", 1), adding("lid", 2)});
  EXPECT_EQ(placesIn(tick()), (Places{{"lid", 2}, {"part", 1}, {"post", 3}}));
  apply({moving("part", 1.5), removing("lid"), moving("post", 4)});
  EXPECT_EQ(placesIn(tick()), (Places{{"part", 1.5}, {"post", 4}}));
  world_.reset();
  EXPECT_EQ(placesIn(tick()), (Places{{"post", 3}}));
}

TEST_F(Obstacles, ThatMoveStayTheSameBodies) {
  apply({adding("part", 1)});
  const Snapshot& before = tick();
  const BodyId id = before.structure().ids[indexOf(before, "obstacle/part")];
  apply({moving("part", 2)});
  const Snapshot& after = tick();
  EXPECT_EQ(after.structure().ids[indexOf(after, "obstacle/part")], id);
  EXPECT_EQ(bodyOf(after, "obstacle/part").frame_from_body.translation().x(), 2);
}

TEST_F(Obstacles, FollowTheirFrameOrStayWhereItWas) {
  msg::Obstacle then = adding("then", 0.5, 0.1, "cart");
  then.at_stamp = true;
  then.header.stamp.fromNSec(std::uint64_t(momentAt(time_).ros.count()));
  const double at = cart(time_) + 0.5;
  apply({adding("load", 0.5, 0.1, "/cart"), then});
  const Snapshot& first = tick();
  EXPECT_EQ(placesIn(first), (Places{{"load", cart(time_) + 0.5}, {"post", 3}, {"then", at}}));
  EXPECT_EQ(bodyOf(first, "obstacle/load").mobility, Mobility::moving);
  EXPECT_EQ(bodyOf(first, "obstacle/then").mobility, Mobility::fixed);
  tick();
  EXPECT_EQ(placesIn(*tick_->snapshot), (Places{{"load", cart(time_) + 0.5}, {"post", 3}, {"then", at}}));
  apply({moving("load", 1), moving("then", 0.25, "cart")});
  tick();
  EXPECT_EQ(placesIn(*tick_->snapshot), (Places{{"load", 1}, {"post", 3}, {"then", cart(time_) + 0.25}}));
}

TEST_F(Obstacles, OfTheFrameOfPosesFollowAFrameOfTheirOwn) {
  const auto follows = [&](const std::string& name) { return bodyOf(*tick_->snapshot, "obstacle/" + name).frame; };
  apply({adding("a", 0.5, 0.1, "~poses"), adding("b", 1)});
  tick();
  EXPECT_EQ(follows("a"), "~poses/a");
  EXPECT_EQ(bodyOf(*tick_->snapshot, "obstacle/a").mobility, Mobility::moving);
  EXPECT_FALSE(tick_->snapshot->complete()) << "it has no pose yet";
  apply({moving("b", 0, "~poses"), moving("a", 2)});
  tick();
  EXPECT_EQ(follows("a"), "world");
  EXPECT_EQ(follows("b"), "~poses/b");
}

TEST_F(Obstacles, StayAtTheNewestPlaceOfAFrameIfTheStampIsZero) {
  msg::Obstacle now = adding("now", 0.5, 0.1, "cart");
  now.at_stamp = true;
  const double at = cart(time_) + 0.5;
  apply({now});
  tick();
  EXPECT_EQ(placesIn(tick()), (Places{{"now", at}, {"post", 3}}));
}

TEST_F(Obstacles, AreRefusedAsAWholeWithTheIndexOfTheChange) {
  apply({adding("part", 1)});
  msg::Obstacle late = adding("x", 0, 0.1, "cart");
  late.at_stamp = true;
  late.header.stamp.fromNSec(std::uint64_t(momentAt(-5.0).ros.count()));  // when the cart was not known
  msg::Obstacle lost = adding("x", 0), group = adding("x", 0), none = adding("x", 0), thick = adding("x", 0);
  msg::Obstacle unknown = late;
  unknown.header.frame_id = "never_seen";
  lost.lifetime_end = 2;
  group.group = "a\nb";
  none.shapes.clear();
  thick.shapes[0].padding = -1.0;
  msg::Obstacle odd = removing("part");
  odd.operation = 9;
  const std::vector<std::pair<msg::Obstacle, Code>> wrong{
      {adding("part", 2), Code::dup_id},
      {moving("nobody", 1), Code::unknown_id},
      {removing("nobody"), Code::unknown_id},
      {adding("", 1), Code::bad_id},
      {adding("x", std::nan("")), Code::nonfinite},
      {adding("x", 2e6), Code::out_of_range},
      {adding("x", 1, -0.1), Code::bad_geometry},
      {late, Code::extrapolation},
      {unknown, Code::unknown_frame},
      {lost, Code::unsupported},
      {group, Code::bad_id},
      {none, Code::bad_geometry},
      {thick, Code::out_of_range},
      {odd, Code::unsupported},
  };
  for (const auto& [change, code] : wrong) {
    SCOPED_TRACE(change.name + " " + name(code));
    const std::vector<msg::Obstacle> changes{adding("new", 5), moving("part", 7), removing("post"), change};
    EXPECT_EQ(refused(changes), Refused(code, 3));
    EXPECT_EQ(placesIn(tick()), (Places{{"part", 1}, {"post", 3}}));
  }
}

TEST_F(Obstacles, AreReadFromFiles) {
  msg::Obstacle wedge = adding("wedge", 1), hull = adding("hull", 2);
  wedge.shapes[0] = msg::Shape();
  wedge.shapes[0].kind = msg::ShapeKind::MESH;
  wedge.shapes[0].resource = "package://parts/wedge.stl";
  wedge.shapes[0].scale.x = wedge.shapes[0].scale.y = wedge.shapes[0].scale.z = 0.5;
  hull.shapes[0] = wedge.shapes[0];
  hull.shapes[0].kind = msg::ShapeKind::HULL;
  hull.shapes[0].scale = geometry_msgs::Vector3();
  apply({wedge, hull});
  const Snapshot& snapshot = tick();
  const BodyShape& small = bodyOf(snapshot, "obstacle/wedge").shapes[0];
  EXPECT_EQ(small.resource, "package://parts/wedge.stl");
  EXPECT_EQ(small.scale, Eigen::Vector3d::Constant(0.5));
  EXPECT_NEAR(snapshot.boxes()[snapshot.structure().first_proxy[indexOf(snapshot, "obstacle/wedge")]].max[0], 1.5f,
              1e-5f);
  EXPECT_NEAR(snapshot.boxes()[snapshot.structure().first_proxy[indexOf(snapshot, "obstacle/hull")]].max[0], 3.0f,
              1e-5f);

  msg::Obstacle missing = wedge, sphere_from_file = wedge, two = wedge;
  missing.name = sphere_from_file.name = two.name = "x";
  missing.shapes[0].resource = "package://parts/none.stl";
  sphere_from_file.shapes[0].kind = msg::ShapeKind::SPHERE;
  two.shapes[0].mesh.vertices.resize(4);
  EXPECT_EQ(refused({missing}), Refused(Code::resource_missing, 0));
  EXPECT_EQ(refused({sphere_from_file}), Refused(Code::bad_geometry, 0));
  EXPECT_EQ(refused({two}), Refused(Code::bad_geometry, 0));
}

TEST_F(Obstacles, ThatAreEqualAndAtTheSamePlaceAreAccepted) {
  apply({adding("part", 1)});
  EXPECT_EQ(refused({adding("part", 1)}), std::nullopt);
  EXPECT_EQ(refused({adding("part", 1, 0.2)}), Refused(Code::dup_id, 0));
  apply({moving("part", 2)});
  EXPECT_EQ(refused({adding("part", 1)}), Refused(Code::dup_id, 0)) << "it is elsewhere now";
  EXPECT_EQ(refused({adding("part", 2)}), std::nullopt);
  msg::Obstacle other = adding("part", 1, 0.2);
  other.replace = true;
  EXPECT_EQ(refused({other}), std::nullopt);
  EXPECT_EQ(placesIn(tick()), (Places{{"part", 1}, {"post", 3}}));
}

TEST_F(Obstacles, OfACompleteSetReplaceTheOthersOfTheirOwner) {
  msg::Obstacle mine = adding("mine", 1), also = adding("also", 2);
  mine.owner = also.owner = "planner";
  apply({mine, also, adding("callers", 5)});
  apply({also}, "planner");
  EXPECT_EQ(placesIn(tick()), (Places{{"also", 2}, {"callers", 5}, {"post", 3}}));
  apply({}, "planner");
  EXPECT_EQ(placesIn(tick()), (Places{{"callers", 5}, {"post", 3}}));
}

TEST_F(Obstacles, EndWithTheirLifetimeUnlessTheyAreChanged) {
  msg::Obstacle brief = adding("brief", 1), renewed = adding("renewed", 2);
  brief.lifetime = renewed.lifetime = ros::Duration(0.3);
  apply({brief, renewed});
  tick();
  apply({renewed});
  tick();
  EXPECT_EQ(placesIn(tick()), (Places{{"post", 3}, {"renewed", 2}}));
  world_.forgetUnsaved();
  EXPECT_EQ(placesIn(tick()), (Places{{"post", 3}}));
  EXPECT_EQ(world_.obstacles().unsaved().names, std::set<std::string>{"obstacle/renewed"}) << "the end is stored, too";
}

TEST_F(Obstacles, BecomeLostAtTheEndOfTheirLifetimeIfThatWasRequested) {
  msg::Obstacle seen = adding("seen", 1), held = adding("held", 0.5, 0.1, "cart");
  seen.lifetime = held.lifetime = ros::Duration(0.3);
  seen.lifetime_end = held.lifetime_end = msg::LifetimeEnd::LOST;
  apply({seen, held});
  const auto stateOf = [&](const std::string& name) {
    return tick_->snapshot->poses()[indexOf(*tick_->snapshot, name)].state;
  };
  tick();
  tick();
  const double last = placesIn(*tick_->snapshot).at("held");
  EXPECT_EQ(stateOf("obstacle/seen"), Freshness::fresh);
  EXPECT_EQ(bodyOf(*tick_->snapshot, "obstacle/seen").mobility, Mobility::moving);
  EXPECT_TRUE(tick_->snapshot->complete());
  for (int i = 0; i < 8; ++i) tick();
  for (const char* name : {"obstacle/seen", "obstacle/held"}) EXPECT_EQ(stateOf(name), Freshness::lost);
  EXPECT_EQ(placesIn(*tick_->snapshot), (Places{{"held", last}, {"post", 3}, {"seen", 1}})) << "nobody moves them";
  EXPECT_FALSE(tick_->snapshot->complete());
  const std::uint32_t index = indexOf(*tick_->snapshot, "obstacle/seen");
  EXPECT_NEAR(tick_->snapshot->poses()[index].age, 7 * 0.125, 0.13);
  apply({seen, moving("held", 0.25, "cart")});  // seen again
  tick();
  for (const char* name : {"obstacle/seen", "obstacle/held"}) EXPECT_EQ(stateOf(name), Freshness::fresh);
  EXPECT_TRUE(tick_->snapshot->complete());
  EXPECT_EQ(placesIn(*tick_->snapshot).at("held"), cart(time_) + 0.25);
}

/// Returns a change that adds a plane at this height.
msg::Obstacle addingPlane(const std::string& name, double height) {
  msg::Obstacle change = adding(name, 0);
  change.pose.position.z = height;
  change.shapes[0].kind = msg::ShapeKind::PLANE;
  change.shapes[0].dimensions.clear();
  return change;
}

TEST_F(Obstacles, WithPlanesArePairedWithWhatIsNear) {
  apply({addingPlane("floor", -0.1), addingPlane("deep", -1.0)});
  const Snapshot& snapshot = tick();
  ASSERT_EQ(snapshot.pairs().size(), 2u) << "the links base and hand are spheres of 0.05 m at the height 0";
  const NearPair& pair = snapshot.pairs()[1];
  EXPECT_EQ(snapshot.structure().bodies[pair.first].name, "arm/hand");
  EXPECT_EQ(snapshot.structure().bodies[pair.second].name, "obstacle/floor");
  EXPECT_NEAR(pair.gap, 0.05, 1e-6);
  msg::Obstacle move = moving("floor", 0);
  move.pose.position.z = -0.5;
  apply({move});
  EXPECT_TRUE(tick().pairs().empty());
}

TEST_F(Obstacles, WithPlanesMustBeFixedInTheWorld) {
  msg::Obstacle follows = addingPlane("x", 0), declared = addingPlane("x", 0), lost = addingPlane("x", 0),
                long_plane = addingPlane("x", 0), placed = addingPlane("placed", 0);
  follows.header.frame_id = placed.header.frame_id = "cart";
  placed.at_stamp = true;  // placed once, so it is fixed
  declared.moving = true;
  lost.lifetime_end = msg::LifetimeEnd::LOST;
  long_plane.shapes[0].dimensions = {1.0};
  apply({placed});
  EXPECT_EQ(bodyOf(tick(), "obstacle/placed").mobility, Mobility::fixed);
  const std::vector<std::pair<msg::Obstacle, Code>> wrong{{follows, Code::unsupported},
                                                          {declared, Code::unsupported},
                                                          {lost, Code::unsupported},
                                                          {attaching("placed", "arm/tool", 0.5), Code::unsupported},
                                                          {moving("placed", 1, "cart"), Code::unsupported},
                                                          {long_plane, Code::bad_geometry}};
  for (const auto& [change, code] : wrong) {
    SCOPED_TRACE(change.name + " " + std::to_string(change.operation));
    EXPECT_EQ(refused({adding("new", 5), change}), Refused(code, 1));
  }
  EXPECT_EQ(placesIn(tick()).size(), 2u);
}

TEST_F(Obstacles, WithMorePlanesThanMaxPlanesAreRefused) {
  msg::Obstacle many = addingPlane("many", 0);
  many.shapes.resize(65, many.shapes[0]);
  EXPECT_THROW(apply({many}), Refusal);
  many.shapes.resize(64);
  apply({many});
  EXPECT_THROW(apply({addingPlane("one_more", 0)}), Refusal);
}

TEST_F(Obstacles, BeyondMaxBodiesAreRefused) {
  std::vector<msg::Obstacle> many;
  for (int i = 0; i < 19; ++i) many.push_back(adding("part" + std::to_string(i), i));
  apply(many);
  EXPECT_THROW(apply({adding("one_more", 0)}), Refusal);
  EXPECT_EQ(placesIn(tick()).size(), 20u);
  apply({removing("part3"), adding("one_more", 0)});
  EXPECT_EQ(placesIn(tick()).size(), 20u);
}

TEST_F(Obstacles, AreEqualIfTheyAreAtTheSamePlaceHoweverItIsGiven) {
  msg::Obstacle here = adding("part", 0.5, 0.1, "cart");
  here.at_stamp = true;  // stamp 0: where the cart is at present
  apply({here});
  tick();
  EXPECT_EQ(refused({here}), Refused(Code::dup_id, 0)) << "the cart has moved";
  here.header.stamp.fromNSec(std::uint64_t(momentAt(time_).ros.count()));
  here.name = "stamped";
  apply({here});
  tick();
  EXPECT_EQ(refused({here}), std::nullopt);
  for (int i = 0; i < 200; ++i) tick();
  EXPECT_EQ(refused({here}), std::nullopt) << "although the pose of the cart at that time is forgotten";
  apply({adding("named", 4, 0.1, "world")});
  msg::Obstacle unnamed = adding("named", 4);
  unnamed.owner = "planner";
  unnamed.link = "ADD does not read it";
  EXPECT_EQ(refused({unnamed}), std::nullopt);
  apply({}, "planner");
  EXPECT_EQ(placesIn(tick()).count("named"), 0u) << "the new owner is its owner";
}

TEST_F(Obstacles, WithTooMuchInThemAreRefused) {
  msg::Obstacle shapes = adding("x", 0), frame = adding("x", 0, 0.1, std::string(600, 'f')), owner = adding("x", 0),
                far = adding("x", 0);
  shapes.shapes.assign(1001, sphere(0.1));
  owner.owner = "a\nb";
  far.shapes[0].pose.position.x = 2e6;
  EXPECT_EQ(refused({shapes}), Refused(Code::limit, 0));
  EXPECT_EQ(refused({frame}), Refused(Code::bad_id, 0));
  EXPECT_EQ(refused({owner}), Refused(Code::bad_id, 0));
  EXPECT_EQ(refused({far}), Refused(Code::out_of_range, 0));
}

TEST(ObstacleChanges, WaitForTheClock) {
  Params params;
  params.world_frame = "world";
  Ledger ledger;
  World world(settingsOf(params), true, 1, ledger, makeCoreNarrowPhase());
  Moment before_clock;
  before_clock.steady = momentAt(0).steady;
  world.tick(before_clock);
  EXPECT_THROW(world.applyObstacles(ObstacleChanges{}, Time(0)), Refusal);
  world.tick(momentAt(1));
  world.applyObstacles(ObstacleChanges{}, momentAt(1).ros);
}

/// Claim: memory depends on the obstacles that are there, not on how many came and went.
TEST(ObstacleChanges, LeaveNothingBehind) {
  Params params;
  params.world_frame = "world";
  Ledger ledger;
  const auto phase = makeCoreNarrowPhase();
  World world(settingsOf(params), false, 1, ledger, phase);
  world.tick(momentAt(0));
  const auto resident = [] {
    std::ifstream file("/proc/self/statm");
    long size = 0, pages = 0;
    file >> size >> pages;
    return double(pages) * 4096.0;
  };
  double early = 0.0;
  constexpr std::size_t kRounds = 200, kNames = 500;
  for (std::size_t round = 0; round < kRounds; ++round) {
    for (const bool add : {true, false}) {
      msg::ApplyObstacles::Request request;
      for (std::size_t i = 0; i < kNames; ++i) {
        const std::string name = "part" + std::to_string(kNames * round + i);
        request.changes.push_back(add ? adding(name, double(i)) : removing(name));
      }
      const double time = 0.02 * double(2 * round + (add ? 1 : 2));
      world.applyObstacles(obstacleChangesOf(request, "/caller", params, *phase, nullptr), momentAt(time).ros);
      ASSERT_EQ(world.tick(momentAt(time))->snapshot->structure().bodies.size(), add ? kNames : 0u);
    }
    if (round == kRounds / 10) early = resident();
  }
  EXPECT_LT(resident(), 1.01 * early + 1e6);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
