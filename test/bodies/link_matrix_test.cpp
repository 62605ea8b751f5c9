// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/bodies/link_matrix.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "test/support/models.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace {

using test::addLink;
using test::matrixOf;
using test::Random;
using test::says;

/// Returns the chain base - shoulder - elbow - wrist. All its links have geometry.
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

/// Returns the names of all pairs of links with geometry whose pair has this origin.
std::set<std::pair<std::string, std::string>> pairsOf(const RobotModel& model, Origin origin) {
  const LinkMatrix matrix = matrixOf(model);
  std::set<std::pair<std::string, std::string>> pairs;
  for (std::uint32_t i = 0; i < model.links.size(); ++i) {
    for (std::uint32_t j = 0; j < i; ++j) {
      if (!model.links[i].has_collision || !model.links[j].has_collision || matrix.origin(i, j) != origin) continue;
      pairs.insert(std::minmax(model.links[i].name, model.links[j].name));
    }
  }
  return pairs;
}

TEST(LinkMatrix, AHumanoidWithShapesOnLeafLinksHasOnlyThePairsOfItsOneJointsOff) {
  const std::set<std::pair<std::string, std::string>> adjacent = {{"pelvis_shape", "torso_shape"},
                                                                  {"left_upper_arm_shape", "torso_shape"},
                                                                  {"right_upper_arm_shape", "torso_shape"},
                                                                  {"left_forearm_shape", "left_upper_arm_shape"},
                                                                  {"right_forearm_shape", "right_upper_arm_shape"},
                                                                  {"left_forearm_shape", "left_hand_shape"},
                                                                  {"right_forearm_shape", "right_hand_shape"}};
  const RobotModel model = test::humanoid();
  EXPECT_EQ(pairsOf(model, Origin::adjacent), adjacent);
  EXPECT_EQ(pairsOf(model, Origin::none).size(), 36u - adjacent.size()) << "9 links with geometry make 36 pairs";
}

/// Returns two links a and b, and a chain of links without geometry between them. Joint i of the chain is
/// offsets[i] [m] away from the joint before it.
RobotModel chain(const std::vector<double>& offsets) {
  RobotModel model;
  int link = addLink(model, "empty", addLink(model, "a", -1), JointKind::revolute, false);
  model.links.back().parent_from_joint.translation().z() = 0.5;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const bool is_last = i + 1 == offsets.size();
    link = addLink(model, is_last ? "b" : "empty" + std::to_string(i), link, JointKind::revolute, is_last);
    model.links.back().parent_from_joint.translation().x() = offsets[i];
  }
  findRigidGroups(model);
  return model;
}

TEST(LinkMatrix, SeveralJointsInOnePlaceAreOneJointAndOthersAreNot) {
  const auto ends = [](const std::vector<double>& offsets) {
    const RobotModel model = chain(offsets);
    return matrixOf(model).origin(0, std::uint32_t(model.links.size() - 1));
  };
  EXPECT_EQ(ends({0.0}), Origin::adjacent) << "a universal joint written as two joints";
  EXPECT_EQ(ends({0.0, 0.0}), Origin::adjacent) << "a spherical joint written as three joints";
  EXPECT_EQ(ends({0.01}), Origin::adjacent) << "joints 1 cm apart still count as one joint";
  EXPECT_EQ(ends({0.01, -0.01, 0.01}), Origin::adjacent) << "each joint must be compared with the one before";
  EXPECT_EQ(ends({0.0101}), Origin::none);
  EXPECT_EQ(ends({0.0, 0.0101}), Origin::none);
  EXPECT_EQ(ends({0.0101, 0.0}), Origin::none);
  EXPECT_EQ(ends({-0.3}), Origin::none);
}

TEST(LinkMatrix, TheReasonOfAnAdjacentPairNamesAtMostEightJoints) {
  const RobotModel two = chain({0.0});
  EXPECT_EQ(matrixOf(two).adjacencyReason(2, 0),
            "the 2 joints 'empty_joint', 'b_joint' connect them in one place, without geometry between them");
  const RobotModel many = chain(std::vector<double>(10, 0.0));
  const std::string reason = matrixOf(many).adjacencyReason(0, std::uint32_t(many.links.size() - 1));
  EXPECT_TRUE(says(reason, "the 11 joints 'empty_joint', 'empty0_joint',"));
  EXPECT_TRUE(says(reason, "'empty6_joint', ... connect them"));
}

TEST(LinkMatrix, JointOriginsAreComparedThroughFixedJoints) {
  for (const double offset : {0.0, 0.02}) {
    RobotModel model = chain({0.0});
    const int bracket = addLink(model, "bracket", 1, JointKind::fixed, false);  // below the link "empty"
    model.links.back().parent_from_joint.translation() << 0.1, 0.2, 0.3 + offset;
    const int c = addLink(model, "c", bracket);
    model.links.back().parent_from_joint.translation() << -0.1, -0.2, -0.3;
    findRigidGroups(model);
    EXPECT_EQ(matrixOf(model).origin(0, std::uint32_t(c)), offset == 0.0 ? Origin::adjacent : Origin::none);
  }
}

TEST(LinkMatrix, GeometryAnywhereInAGroupBetweenEndsTheChain) {
  RobotModel model = chain({0.0});
  const auto b = std::uint32_t(model.find("b"));
  EXPECT_EQ(matrixOf(model).origin(0, b), Origin::adjacent);
  addLink(model, "sensor", 1, JointKind::fixed);  // mounted on the link "empty"
  findRigidGroups(model);
  const LinkMatrix matrix = matrixOf(model);
  const auto sensor = std::uint32_t(model.find("sensor"));
  EXPECT_EQ(matrix.origin(0, b), Origin::none);
  EXPECT_EQ(matrix.origin(0, sensor), Origin::adjacent);
  EXPECT_EQ(matrix.origin(sensor, b), Origin::adjacent);
}

/// Claim: what is fixed to one of the two links of a joint may be hit by what is fixed to the other one.
TEST(LinkMatrix, OnlyTheNearestLinksWithGeometryOfAJointMayTouch) {
  RobotModel model;
  const int world = addLink(model, "world", -1, JointKind::fixed, false);
  const int rail = addLink(model, "rail", world, JointKind::fixed),
            cabinet = addLink(model, "cabinet", world, JointKind::fixed);
  const int mount = addLink(model, "mount", rail, JointKind::fixed, false);
  const int drive = addLink(model, "drive", mount, JointKind::prismatic, false);
  const int left = addLink(model, "left", drive, JointKind::fixed),
            right = addLink(model, "right", drive, JointKind::fixed);
  const int tool = addLink(model, "tool", right, JointKind::fixed),
            motor = addLink(model, "motor", rail, JointKind::fixed);
  findRigidGroups(model);
  const LinkMatrix matrix = matrixOf(model);
  const auto origin = [&](int i, int j) { return matrix.origin(std::uint32_t(i), std::uint32_t(j)); };
  EXPECT_EQ(origin(left, rail), Origin::adjacent);
  EXPECT_EQ(origin(right, rail), Origin::adjacent);
  EXPECT_EQ(origin(left, cabinet), Origin::none);
  EXPECT_EQ(origin(left, motor), Origin::none);
  EXPECT_EQ(origin(tool, rail), Origin::none);
  EXPECT_EQ(origin(tool, right), Origin::rigid);
}

TEST(LinkMatrix, GroupsOnDifferentBranchesAreNeverAdjacent) {
  RobotModel model;
  const int hub = addLink(model, "hub", -1, JointKind::fixed, false);
  const auto left = std::uint32_t(addLink(model, "left", hub)), right = std::uint32_t(addLink(model, "right", hub));
  findRigidGroups(model);
  EXPECT_EQ(matrixOf(model).origin(left, right), Origin::none)
      << "even joints at the same place must not make different branches adjacent";
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
  EXPECT_EQ(origin(finger, camera), Origin::none) << "the finger may hit the camera beside the hand";
}

TEST(LinkMatrix, SrdfTagsDoWhatTheySay) {
  LinkRules rules;
  rules.disabled = {{"base", "wrist", "Never"}};
  EXPECT_EQ(matrixOf(arm(), rules).origin(0, 3), Origin::srdf);
  EXPECT_EQ(matrixOf(arm(), rules).origin(3, 0), Origin::srdf) << "the order of the two links must not matter";
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
  model.links[1].joint_kind = JointKind::fixed;  // base and shoulder form one rigid group
  findRigidGroups(model);
  LinkRules rules;
  rules.disabled_default = {"wrist"};
  rules.enabled = {{"wrist", "base", ""}, {"base", "shoulder", ""}, {"elbow", "wrist", ""}, {"base", "elbow", ""}};
  rules.disabled = {{"elbow", "base", ""}};
  const LinkMatrix matrix = matrixOf(model, rules);
  EXPECT_EQ(matrix.origin(0, 3), Origin::none) << "enable must take precedence over the default disable of the wrist";
  EXPECT_EQ(matrix.origin(0, 1), Origin::none) << "enable must take precedence over the rigid group";
  EXPECT_EQ(matrix.origin(2, 3), Origin::none) << "enable must take precedence over adjacency";
  EXPECT_EQ(matrix.origin(1, 3), Origin::srdf) << "the default disable must apply to the other links";
  EXPECT_EQ(matrix.origin(0, 2), Origin::srdf) << "disable must take precedence over enable";
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
    EXPECT_EQ(tag(0, 2)->reason, "Never, really") << "the last of several tags must count";
    ASSERT_NE(tag(0, 3), nullptr);
    EXPECT_FALSE(tag(0, 3)->disabled);
    EXPECT_EQ(tag(0, 3)->reason, "watch it");
    EXPECT_EQ(tag(1, 3), nullptr) << "a default disable is not a tag of a pair";
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

/// Implements the definition of adjacency directly. It does not use rigid groups, but the joints between two links.
class AdjacencyOracle {
 public:
  explicit AdjacencyOracle(const RobotModel& model) : model_(model) {
    for (const RobotLink& link : model.links) {
      root_from_link_.push_back(link.parent < 0 ? Pose::Identity()
                                                : root_from_link_[std::size_t(link.parent)] * link.parent_from_joint);
    }
  }

  bool rigid(int a, int b) const { return topOf(a) == topOf(b); }
  bool adjacent(int a, int b) const { return isChain(a, b) || isChain(b, a); }

 private:
  const RobotLink& link(int index) const { return model_.links[std::size_t(index)]; }
  bool moves(int index) const { return link(index).parent >= 0 && link(index).joint_kind != JointKind::fixed; }
  /// Returns the link that is nearest to the root among the links of the rigid group of `index`.
  int topOf(int index) const {
    while (link(index).parent >= 0 && !moves(index)) index = link(index).parent;
    return index;
  }
  bool hasGeometry(int top) const {
    for (int i = 0; i < int(model_.links.size()); ++i) {
      if (topOf(i) == top && link(i).has_collision) return true;
    }
    return false;
  }
  /// Returns the links between the root and a link, the link itself first.
  std::vector<int> wayUp(int index) const {
    std::vector<int> way;
    for (; index >= 0; index = link(index).parent) way.push_back(index);
    return way;
  }
  /// Returns whether a chain leads from `upper` down to `lower`. A chain is one moving joint, or several moving joints
  /// at one place without geometry between them. Between the two links, the way through the tree meets no link with
  /// geometry.
  bool isChain(int upper, int lower) const {
    if (!link(upper).has_collision || !link(lower).has_collision) return false;
    const std::vector<int> from_upper = wayUp(upper), from_lower = wayUp(lower);
    for (const auto& [way, other] : {std::make_pair(from_upper, from_lower), std::make_pair(from_lower, from_upper)}) {
      for (const int i : way) {
        const bool common = std::find(other.begin(), other.end(), i) != other.end();
        if (i != upper && i != lower && link(i).has_collision) return false;
        if (common) break;  // the way goes down again from here
      }
    }
    std::vector<int> tops = {topOf(lower)};
    while (tops.back() != topOf(upper)) {
      if (link(tops.back()).parent < 0) return false;  // `upper` is on another branch or below `lower`
      tops.push_back(topOf(link(tops.back()).parent));
    }
    for (std::size_t i = 1; i + 1 < tops.size(); ++i) {
      const Eigen::Vector3d below = root_from_link_[std::size_t(tops[i - 1])].translation();
      const Eigen::Vector3d here = root_from_link_[std::size_t(tops[i])].translation();
      if (hasGeometry(tops[i]) || (below - here).norm() > 0.01) return false;
    }
    return tops.size() > 1;
  }

  const RobotModel& model_;
  std::vector<Pose> root_from_link_;  // poses with all joints at 0
};

TEST(LinkMatrix, IsRightAndSymmetricForAnyTree) {
  int rigid = 0, by_one = 0, by_several = 0, free = 0;
  for (unsigned seed = 1; seed <= 1200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    RobotModel model = test::randomModel(random, random.between(1, 20));
    const double crowding = random.uniform(0, 1);
    for (RobotLink& link : model.links) {
      // Multiplies many joint offsets by 0.02. About half of them are then less than 1 cm.
      if (random.chance(crowding)) link.parent_from_joint.translation() *= 0.02;
      link.has_collision = link.has_collision && random.chance(0.6);
    }
    findRigidGroups(model);
    const LinkMatrix matrix = matrixOf(model);
    const AdjacencyOracle oracle(model);
    for (int i = 0; i < int(model.links.size()); ++i) {
      for (int j = 0; j < int(model.links.size()); ++j) {
        const auto a = std::uint32_t(i), b = std::uint32_t(j);
        ASSERT_EQ(matrix.origin(a, b), matrix.origin(b, a));
        const Origin expected = i == j                  ? Origin::self
                                : oracle.rigid(i, j)    ? Origin::rigid
                                : oracle.adjacent(i, j) ? Origin::adjacent
                                                        : Origin::none;
        ASSERT_EQ(matrix.origin(a, b), expected) << i << " " << j;
        const bool direct = model.links[a].parent == j || model.links[b].parent == i;
        rigid += expected == Origin::rigid;
        by_one += expected == Origin::adjacent && direct;
        by_several += expected == Origin::adjacent && !direct;
        free += expected == Origin::none;
      }
    }
  }
  for (const int count : {rigid, by_one, by_several, free}) EXPECT_GT(count, 1000);
}

}  // namespace
}  // namespace hgrid
