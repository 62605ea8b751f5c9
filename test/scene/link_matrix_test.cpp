// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/scene/link_matrix.h"

#include <gtest/gtest.h>

#include "test/support/models.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace {

using test::addLink;
using test::matrixOf;
using test::Random;
using test::says;

/// base - shoulder - elbow - wrist, with geometry all along.
RobotModel arm() {
  RobotModel model;
  model.name = "arm";
  int parent = -1;
  for (const char* link : {"base", "shoulder", "elbow", "wrist"}) parent = addLink(model, link, parent);
  findRigidGroups(model);
  return model;
}

TEST(LinkMatrix, LinksJoinedByAJointMayTouchAndOthersMayNot) {
  const LinkMatrix matrix = matrixOf(arm());
  ASSERT_EQ(matrix.size(), 4u);
  for (std::uint32_t i = 0; i < 4; ++i) {
    for (std::uint32_t j = 0; j < 4; ++j) {
      const Origin expected = i == j ? Origin::self : i + 1 == j || j + 1 == i ? Origin::adjacent : Origin::none;
      EXPECT_EQ(matrix.origin(i, j), expected) << i << " " << j;
      EXPECT_EQ(matrix.allowed(i, j), expected != Origin::none);
    }
  }
}

TEST(LinkMatrix, LinksWithoutGeometryAreLookedThrough) {
  RobotModel model;
  const int a = addLink(model, "a", -1);
  const int empty = addLink(model, "empty", a, JointKind::revolute, false);
  const int second = addLink(model, "second", empty, JointKind::prismatic, false);
  const int b = addLink(model, "b", second), c = addLink(model, "c", empty), d = addLink(model, "d", b);
  findRigidGroups(model);
  const LinkMatrix matrix = matrixOf(model);
  const auto origin = [&](int i, int j) { return matrix.origin(std::uint32_t(i), std::uint32_t(j)); };
  EXPECT_EQ(origin(a, b), Origin::adjacent) << "through two of them";
  EXPECT_EQ(origin(a, c), Origin::adjacent);
  EXPECT_EQ(origin(b, c), Origin::adjacent) << "siblings below an empty link";
  EXPECT_EQ(origin(a, d), Origin::none) << "not through one that has geometry";
  EXPECT_EQ(origin(c, d), Origin::none);
}

TEST(LinkMatrix, GeometryThatCouldNotBeReadIsGeometry) {
  RobotModel model;
  const int a = addLink(model, "a", -1), broken = addLink(model, "broken", a), b = addLink(model, "b", broken);
  model.links[std::size_t(broken)].shapes.clear();
  findRigidGroups(model);
  EXPECT_EQ(matrixOf(model).origin(std::uint32_t(a), std::uint32_t(b)), Origin::none);
}

TEST(LinkMatrix, LinksThatMoveAsOneMayTouch) {
  RobotModel model;
  const int hand = addLink(model, "hand", -1);
  const int palm = addLink(model, "palm", hand, JointKind::fixed), tip = addLink(model, "tip", palm, JointKind::fixed);
  const int camera = addLink(model, "camera", hand, JointKind::fixed), finger = addLink(model, "finger", tip);
  findRigidGroups(model);
  const LinkMatrix matrix = matrixOf(model);
  const auto origin = [&](int i, int j) { return matrix.origin(std::uint32_t(i), std::uint32_t(j)); };
  EXPECT_EQ(origin(hand, tip), Origin::rigid);
  EXPECT_EQ(origin(camera, tip), Origin::rigid);
  EXPECT_TRUE(matrix.allowed(std::uint32_t(hand), std::uint32_t(palm)));
  EXPECT_EQ(origin(finger, tip), Origin::adjacent);
  EXPECT_EQ(origin(finger, camera), Origin::none);
}

TEST(LinkMatrix, SrdfTagsDoWhatTheySay) {
  LinkRules rules;
  rules.disabled = {{"base", "wrist", "Never"}};
  EXPECT_EQ(matrixOf(arm(), rules).origin(0, 3), Origin::srdf);
  EXPECT_EQ(matrixOf(arm(), rules).origin(3, 0), Origin::srdf) << "both orders";
  EXPECT_EQ(matrixOf(arm(), rules).origin(0, 2), Origin::none);

  rules = {};
  rules.disabled_default = {"elbow"};
  const LinkMatrix no_elbow = matrixOf(arm(), rules);
  for (const std::uint32_t other : {0u, 1u, 3u}) EXPECT_TRUE(no_elbow.allowed(2, other));
  EXPECT_EQ(no_elbow.origin(0, 2), Origin::srdf);
  EXPECT_EQ(no_elbow.origin(2, 2), Origin::self);
  EXPECT_EQ(no_elbow.origin(0, 3), Origin::none);

  rules = {};
  rules.enabled = {{"elbow", "wrist", ""}};
  EXPECT_EQ(matrixOf(arm(), rules).origin(2, 3), Origin::none);
  EXPECT_EQ(matrixOf(arm(), rules).origin(3, 2), Origin::none);
}

TEST(LinkMatrix, AnExplicitDisableBeatsAnEnableBeatsTheDefaults) {
  RobotModel model = arm();
  model.links[1].joint_kind = JointKind::fixed;  // base and shoulder are one
  findRigidGroups(model);
  LinkRules rules;
  rules.disabled_default = {"wrist"};
  rules.enabled = {{"wrist", "base", ""}, {"base", "shoulder", ""}, {"elbow", "wrist", ""}, {"base", "elbow", ""}};
  rules.disabled = {{"elbow", "base", ""}};
  const LinkMatrix matrix = matrixOf(model, rules);
  EXPECT_EQ(matrix.origin(0, 3), Origin::none) << "enable beats the default of the wrist";
  EXPECT_EQ(matrix.origin(0, 1), Origin::none) << "enable beats the rigid group";
  EXPECT_EQ(matrix.origin(2, 3), Origin::none) << "enable beats adjacency";
  EXPECT_EQ(matrix.origin(1, 3), Origin::srdf) << "the default holds for the others";
  EXPECT_EQ(matrix.origin(0, 2), Origin::srdf) << "disable beats enable";
}

TEST(LinkMatrix, KeepsWhatTheSrdfSaysOfAPairAndWhy) {
  LinkRules rules;
  rules.disabled_default = {"wrist"};
  rules.enabled = {{"wrist", "base", "watch it"}, {"base", "elbow", "before"}};
  rules.disabled = {{"elbow", "base", "Never"}, {"base", "elbow", "Never, really"}, {"elbow", "elbow", ""}};
  const LinkMatrix matrix = matrixOf(arm(), rules);
  for (const bool swapped : {false, true}) {
    const auto tag = [&](std::uint32_t i, std::uint32_t j) { return swapped ? matrix.tag(j, i) : matrix.tag(i, j); };
    ASSERT_NE(tag(0, 2), nullptr);
    EXPECT_TRUE(tag(0, 2)->disabled);
    EXPECT_EQ(tag(0, 2)->reason, "Never, really") << "of the last one";
    ASSERT_NE(tag(0, 3), nullptr);
    EXPECT_FALSE(tag(0, 3)->disabled);
    EXPECT_EQ(tag(0, 3)->reason, "watch it");
    EXPECT_EQ(tag(1, 3), nullptr) << "a default is of no pair";
    EXPECT_EQ(tag(0, 1), nullptr);
    EXPECT_EQ(tag(2, 2), nullptr);
  }
}

TEST(LinkMatrix, ALinkNeverMeetsItself) {
  LinkRules rules;
  rules.enabled = {{"base", "base", ""}};
  rules.disabled = {{"wrist", "wrist", ""}};
  const LinkMatrix matrix = matrixOf(arm(), rules);
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(matrix.origin(i, i), Origin::self);
}

TEST(LinkMatrix, RulesForUnknownLinksWarnAndDoNothing) {
  LinkRules rules;
  rules.disabled = {{"base", "tail", ""}, {"horn", "wrist", ""}};
  rules.disabled_default = {"wing\n"};
  rules.enabled = {{"elbow", "fin", ""}};
  std::vector<std::string> warnings;
  const LinkMatrix matrix(arm(), rules, warnings);
  const LinkMatrix plain = matrixOf(arm());
  for (std::uint32_t i = 0; i < 4; ++i) {
    for (std::uint32_t j = 0; j < 4; ++j) EXPECT_EQ(matrix.origin(i, j), plain.origin(i, j));
  }
  ASSERT_EQ(warnings.size(), 4u);
  std::string all;
  for (const std::string& warning : warnings) all += warning + "|";
  for (const char* word : {"tail", "horn", "wing\\x0a", "fin"}) EXPECT_TRUE(says(all, word));
}

/// Whether a walk from link to link over joints, with nothing but empty links between, leads from one to another.
bool joined(const RobotModel& model, int from, int to, int came_from = -1) {
  for (int next = 0; next < int(model.links.size()); ++next) {
    const bool neighbours =
        model.links[std::size_t(next)].parent == from || model.links[std::size_t(from)].parent == next;
    if (!neighbours || next == came_from) continue;
    if (next == to) return true;
    if (!model.links[std::size_t(next)].has_collision && joined(model, next, to, from)) return true;
  }
  return false;
}

TEST(LinkMatrix, IsRightAndSymmetricForAnyTree) {
  int adjacent = 0, free = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const RobotModel model = test::randomModel(random, random.between(1, 20));
    const LinkMatrix matrix = matrixOf(model);
    for (int i = 0; i < int(model.links.size()); ++i) {
      for (int j = 0; j < int(model.links.size()); ++j) {
        const auto a = std::uint32_t(i), b = std::uint32_t(j);
        ASSERT_EQ(matrix.origin(a, b), matrix.origin(b, a));
        if (i == j || !model.links[a].has_collision || !model.links[b].has_collision) continue;
        const bool rigid = model.links[a].rigid_group == model.links[b].rigid_group;
        ASSERT_EQ(matrix.allowed(a, b), rigid || joined(model, i, j)) << i << " " << j;
        (matrix.allowed(a, b) ? adjacent : free)++;
      }
    }
  }
  EXPECT_GT(adjacent, 1000);
  EXPECT_GT(free, 1000);
}

}  // namespace
}  // namespace hgrid
