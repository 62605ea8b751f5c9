// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/pairs/pair_filter.h"

#include <gtest/gtest.h>

#include "test/support/models.h"

namespace hgrid {
namespace {

using test::addLink;

Body bodyOf(const std::string& name, BodyKind kind, Mobility mobility = Mobility::moving) {
  Body body;
  body.name = name;
  body.kind = kind;
  body.mobility = mobility;
  return body;
}

std::shared_ptr<const LinkMatrix> armMatrix() {
  RobotModel model;
  const int base = addLink(model, "base", -1), arm = addLink(model, "arm", base);
  addLink(model, "hand", arm);
  findRigidGroups(model);
  return std::make_shared<const LinkMatrix>(test::matrixOf(model));
}

enum Index : std::uint32_t { base, arm, hand, other_base, other_hand, box, crate, shelf, room, raft, cloud, person };

/// Returns the bodies of two equal robots, of moving and fixed obstacles, of a fixed and a moving map, and of a cloud.
std::vector<Body> cell() {
  const auto matrix = armMatrix();
  std::vector<Body> bodies;
  for (const char* robot : {"left", "right"}) {
    for (std::uint32_t link : {0u, 1u, 2u}) {
      if (link == 1 && robot == std::string("right")) continue;
      bodies.push_back(bodyOf(std::string(robot) + "/" + std::to_string(link), BodyKind::link));
      bodies.back().robot = robot;
      bodies.back().link = link;
      bodies.back().links = matrix;
    }
  }
  bodies.push_back(bodyOf("obstacle/box", BodyKind::obstacle));
  bodies.push_back(bodyOf("obstacle/crate", BodyKind::obstacle, Mobility::fixed));
  bodies.push_back(bodyOf("obstacle/shelf", BodyKind::obstacle, Mobility::fixed));
  bodies.push_back(bodyOf("map/room", BodyKind::map, Mobility::fixed));
  bodies.push_back(bodyOf("map/raft", BodyKind::map));
  bodies.push_back(bodyOf("cloud/front", BodyKind::cloud));
  bodies.push_back(bodyOf("track/people/1", BodyKind::track));
  return bodies;
}

/// Returns the origin of the decision about a pair. Checks that the origin does not depend on the order of the bodies.
Origin originOf(const PairFilter& filter, std::uint32_t a, std::uint32_t b) {
  EXPECT_EQ(filter.origin(a, b), filter.origin(b, a)) << a << " " << b;
  EXPECT_EQ(filter.allowed(a, b), filter.origin(a, b) != Origin::none);
  return filter.origin(a, b);
}

TEST(PairFilter, ByDefaultEveryKindOfPairIsReportedButFixedWithFixed) {
  const PairFilter filter(cell(), {}, {});
  EXPECT_EQ(originOf(filter, base, hand), Origin::none);
  EXPECT_EQ(originOf(filter, base, arm), Origin::adjacent);
  EXPECT_EQ(originOf(filter, base, other_base), Origin::none);
  EXPECT_EQ(originOf(filter, hand, other_hand), Origin::none)
      << "the matrix of a robot was applied to links of two robots";
  EXPECT_EQ(originOf(filter, arm, other_base), Origin::none)
      << "links 1 and 0 of two different robots are not adjacent";
  for (const std::uint32_t other : {box, crate, shelf, room, raft, cloud, person})
    EXPECT_EQ(originOf(filter, hand, other), Origin::none);
  for (const std::uint32_t other : {box, crate, room, raft, cloud})
    EXPECT_EQ(originOf(filter, person, other), Origin::none);
  EXPECT_EQ(originOf(filter, box, crate), Origin::none);
  EXPECT_EQ(originOf(filter, box, room), Origin::none);
  EXPECT_EQ(originOf(filter, box, raft), Origin::none);
  EXPECT_EQ(originOf(filter, box, cloud), Origin::none);
  EXPECT_EQ(originOf(filter, raft, cloud), Origin::kind);
  EXPECT_EQ(originOf(filter, crate, raft), Origin::kind) << "the cells of a moving map show the fixed obstacles too";
  EXPECT_EQ(originOf(filter, crate, shelf), Origin::kind);
  EXPECT_EQ(originOf(filter, crate, room), Origin::kind);
  for (std::uint32_t i = 0; i < 12; ++i) EXPECT_EQ(originOf(filter, i, i), Origin::self);
}

TEST(PairFilter, EachKindCanBeSwitchedOffAlone) {
  struct Case {
    bool PairKinds::*kind;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> gone;
  };
  const Case cases[] = {{&PairKinds::self, {{base, hand}, {other_base, other_hand}, {base, arm}}},
                        {&PairKinds::robot_robot, {{base, other_base}, {hand, other_hand}}},
                        {&PairKinds::robot_obstacle, {{hand, box}, {hand, crate}, {hand, person}}},
                        {&PairKinds::robot_map, {{hand, room}, {base, raft}, {hand, cloud}}},
                        {&PairKinds::moving_obstacle,
                         {{box, crate}, {box, room}, {box, raft}, {box, cloud}, {person, crate}, {person, room}}}};
  const PairFilter all(cell(), {}, {});
  for (const Case& one : cases) {
    PairKinds kinds;
    kinds.*(one.kind) = false;
    const PairFilter filter(cell(), kinds, {});
    std::size_t changed = 0;
    for (const auto& pair : one.gone) EXPECT_EQ(originOf(filter, pair.first, pair.second), Origin::kind);
    for (const Case& other : cases) {
      for (const auto& pair : other.gone)
        changed += originOf(filter, pair.first, pair.second) != originOf(all, pair.first, pair.second);
    }
    EXPECT_EQ(changed, one.gone.size()) << "a kind switches off pairs of another kind";
  }
}

TEST(PairFilter, TwoFixedBodiesMakeNoPairWhateverTheyAre) {
  std::vector<Body> bodies = cell();
  bodies[base].mobility = Mobility::fixed;  // the base of the robot is mounted on the floor
  bodies[other_base].mobility = Mobility::fixed;
  const PairFilter filter(bodies, {}, {});
  for (const std::uint32_t other : {other_base, crate, shelf, room})
    EXPECT_EQ(originOf(filter, base, other), Origin::kind);
  EXPECT_EQ(originOf(filter, base, box), Origin::none);
  EXPECT_EQ(originOf(filter, hand, crate), Origin::none);
}

TEST(PairFilter, PatternsHoldInBothOrdersAndForNothingElse) {
  const PairFilter filter(cell(), {},
                          {{"left/2", "obstacle/*", "it grips them"}, {"*/0", "map/r*om", "it stands on it"}});
  EXPECT_EQ(originOf(filter, hand, box), Origin::parameter);
  EXPECT_EQ(originOf(filter, hand, shelf), Origin::parameter);
  EXPECT_EQ(originOf(filter, base, room), Origin::parameter);
  EXPECT_EQ(originOf(filter, other_base, room), Origin::parameter);
  EXPECT_EQ(originOf(filter, base, raft), Origin::none);
  EXPECT_EQ(originOf(filter, other_hand, box), Origin::none);
  EXPECT_EQ(originOf(filter, hand, room), Origin::none);
  EXPECT_EQ(originOf(filter, base, other_base), Origin::none)
      << "both bodies match the first glob, but neither matches the second";
  EXPECT_EQ(originOf(filter, box, crate), Origin::none)
      << "both bodies match the second glob, but neither matches the first";
  EXPECT_EQ(originOf(filter, base, box), Origin::none)
      << "the first glob of one rule was combined with the second glob of another rule";
}

TEST(PairFilter, TheFirstReasonThatHoldsIsTold) {
  PairKinds kinds;
  kinds.robot_robot = false;
  const PairFilter filter(cell(), kinds, {{"*", "*", "everything"}});
  EXPECT_EQ(originOf(filter, base, base), Origin::self);
  EXPECT_EQ(originOf(filter, base, other_base), Origin::kind);
  EXPECT_EQ(originOf(filter, base, arm), Origin::parameter) << "a rule must take precedence over the robot model";
  EXPECT_EQ(originOf(filter, base, hand), Origin::parameter);
}

TEST(PairFilter, HundredsOfPatternsAreAllRead) {
  for (const int count : {1, 63, 64, 65, 128, 200}) {
    for (const int at : {0, count / 2, count - 1}) {
      std::vector<PairRule> patterns(std::size_t(count), {"nobody*", "no one", ""});
      patterns[std::size_t(at)] = {"obstacle/crate*", "left/2", ""};
      const PairFilter filter(cell(), {}, patterns);
      EXPECT_EQ(originOf(filter, hand, crate), Origin::parameter) << at << " of " << count;
      EXPECT_EQ(originOf(filter, hand, shelf), Origin::none) << at << " of " << count;
    }
  }
}

TEST(PairFilter, KeepsTheMatricesThatItAsks) {
  auto bodies = std::make_unique<std::vector<Body>>(cell());
  const std::weak_ptr<const LinkMatrix> matrix = bodies->front().links;
  const PairFilter filter(*bodies, {}, {});
  bodies.reset();
  EXPECT_FALSE(matrix.expired());
  EXPECT_EQ(originOf(filter, base, arm), Origin::adjacent);
}

}  // namespace
}  // namespace hgrid
