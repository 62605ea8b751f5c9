// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/adapters/srdf.h"

#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <algorithm>

#include "hgrid_proximity/explain/allowed_matrix.h"
#include "test/support/refusals.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

std::string srdf(const std::string& content) { return "<robot name=\"r\">\n" + content + "\n</robot>"; }

TEST(Srdf, AllThreeTagsAreRead) {
  const LinkRules rules = readSrdf(fileText(ownData() + "/robots/traits.srdf"));
  ASSERT_EQ(rules.disabled.size(), 3u);
  EXPECT_EQ(rules.disabled[0].first, "base");
  EXPECT_EQ(rules.disabled[0].second, "arm");
  EXPECT_EQ(rules.disabled[0].reason, "Never");
  EXPECT_EQ(rules.disabled[1].first, "finger_right");
  EXPECT_EQ(rules.disabled[1].second, "finger_left");
  EXPECT_EQ(rules.disabled[1].reason, "");
  EXPECT_EQ(rules.disabled_default, std::vector<std::string>({"drone", "phantom"}));
  ASSERT_EQ(rules.enabled.size(), 4u);
  EXPECT_EQ(rules.enabled[0].first, "drone");
  EXPECT_EQ(rules.enabled[0].second, "cart");
}

TEST(Srdf, GroupsOfJointsAndVirtualJointsAreRead) {
  const JointGroups read =
      readJointGroups(srdf("<virtual_joint name='odometry' type='planar' parent_frame='odom' child_link='base'/>"
                           "<virtual_joint name='stand' type='fixed' parent_frame='floor' child_link='base'/>"
                           "<group name='arm'><chain base_link='base' tip_link='hand'/><joint name='lift'/></group>"
                           "<group name='all'><group name='arm'/><link name='cart'/><link name='plate'/></group>"));
  ASSERT_EQ(read.groups.size(), 2u);
  EXPECT_EQ(read.groups[0].name, "arm");
  ASSERT_EQ(read.groups[0].chains.size(), 1u);
  EXPECT_EQ(read.groups[0].chains[0].base, "base");
  EXPECT_EQ(read.groups[0].chains[0].tip, "hand");
  EXPECT_EQ(read.groups[0].joints, std::vector<std::string>({"lift"}));
  EXPECT_EQ(read.groups[1].groups, std::vector<std::string>({"arm"}));
  EXPECT_EQ(read.groups[1].links, std::vector<std::string>({"cart", "plate"}));
  ASSERT_NE(read.findVirtual("odometry"), nullptr);
  EXPECT_EQ(read.findVirtual("odometry")->kind, JointKind::planar);
  EXPECT_EQ(read.findVirtual("odometry")->parent_frame, "odom");
  EXPECT_EQ(read.findVirtual("odometry")->child_link, "base");
  EXPECT_EQ(read.findVirtual("stand")->kind, JointKind::fixed);
  EXPECT_EQ(read.findVirtual("lift"), nullptr);

  std::string sentence;
  const auto code = [&](const std::string& content) {
    return refusalOf([&] { readJointGroups(srdf(content)); }, &sentence);
  };
  EXPECT_EQ(code("<group><joint name='lift'/></group>"), Code::parse);
  EXPECT_TRUE(says(sentence, "'name'") && says(sentence, "line 2")) << sentence;
  EXPECT_EQ(code("<virtual_joint name='j' type='loose' parent_frame='odom' child_link='base'/>"), Code::parse);
  EXPECT_TRUE(says(sentence, "'j'") && says(sentence, "'loose'")) << sentence;
}

TEST(Srdf, RulesActOnTheModelAndUnknownLinksAreWarnings) {
  MeshLoader loader(meshPolicy());
  const RobotModel model = readWith(loader, fileText(ownData() + "/robots/traits.urdf"));
  std::vector<std::string> warnings;
  const LinkMatrix matrix(model, readSrdf(fileText(ownData() + "/robots/traits.srdf")), warnings);
  const auto origin = [&](const char* a, const char* b) {
    const auto i = static_cast<std::uint32_t>(model.find(a)), j = static_cast<std::uint32_t>(model.find(b));
    EXPECT_EQ(matrix.origin(i, j), matrix.origin(j, i)) << a << ", " << b;
    return matrix.origin(i, j);
  };
  EXPECT_EQ(origin("base", "arm"), Origin::srdf) << "<disable_collisions> takes precedence over <enable_collisions>";
  EXPECT_EQ(origin("finger_left", "finger_right"), Origin::srdf);
  EXPECT_EQ(origin("drone", "arm"), Origin::srdf) << "<disable_default_collisions> disables the pair";
  EXPECT_EQ(origin("drone", "cart"), Origin::none) << "<enable_collisions> takes precedence over a default";
  EXPECT_EQ(origin("arm", "turret"), Origin::none) << "<enable_collisions> takes precedence over adjacency";
  EXPECT_EQ(origin("base", "column"), Origin::none) << "<enable_collisions> takes precedence over a rigid group";
  EXPECT_EQ(origin("column", "arm"), Origin::adjacent);
  EXPECT_EQ(origin("turret", "hand"), Origin::rigid);
  EXPECT_EQ(origin("cart", "arm"), Origin::none);
  EXPECT_EQ(origin("base", "base"), Origin::self);

  ASSERT_EQ(warnings.size(), 2u);
  std::string all = warnings[0] + warnings[1];
  EXPECT_TRUE(says(all, "ghost"));
  EXPECT_TRUE(says(all, "phantom"));
}

TEST(Srdf, WhatTheAllowedMatrixPrintsReadsBackAsTheSameMatrix) {
  MeshLoader loader(meshPolicy());
  const RobotModel model = readWith(loader, fileText(ownData() + "/robots/traits.urdf"));
  std::vector<std::string> warnings;
  const auto matrix =
      std::make_shared<const LinkMatrix>(model, readSrdf(fileText(ownData() + "/robots/traits.srdf")), warnings);
  std::vector<Body> bodies;
  for (std::uint32_t i = 0; i < model.links.size(); ++i) {
    if (!model.links[i].has_collision) continue;
    Body body;
    body.name = "traits/" + model.links[i].name;
    body.kind = BodyKind::link;
    body.robot = "traits";
    body.link = i;
    body.links = matrix;
    bodies.push_back(body);
  }
  std::sort(bodies.begin(), bodies.end(), [](const Body& a, const Body& b) { return a.name < b.name; });
  Structure structure;
  structure.bodies = std::move(bodies);
  structure.filter = PairFilter(structure.bodies, {}, {});
  const AllowedList list = decidedPairs(structure, {"", "", 1000000});
  std::vector<std::string> none;
  const LinkMatrix again(model, readSrdf(srdfOf(structure, list.entries)), none);
  EXPECT_TRUE(none.empty());
  EXPECT_GT(list.total, 10u);
  for (const Body& a : structure.bodies) {
    for (const Body& b : structure.bodies) {
      EXPECT_EQ(again.allowed(a.link, b.link), matrix->allowed(a.link, b.link)) << a.name << " " << b.name;
    }
  }
}

TEST(Srdf, TextWithoutCollisionTagsGivesNoRules) {
  for (const char* content : {"", "<group name=\"g\"/>", "<!-- <disable_collisions link1=\"a\" link2=\"b\"/> -->"}) {
    const LinkRules rules = readSrdf(srdf(content));
    EXPECT_TRUE(rules.disabled.empty() && rules.disabled_default.empty() && rules.enabled.empty()) << content;
  }
}

TEST(Srdf, InvalidTextIsRefused) {
  std::string deep;
  for (int i = 0; i < 50000; ++i) deep += "<a>";
  struct Bad {
    std::string text;
    Code code;
  };
  const std::vector<Bad> all = {{"", Code::parse},
                                {"hello", Code::parse},
                                {"<robot name=\"r\">\n<disable_collisions", Code::parse},
                                {"<robot name=\"r\">\n<group>\n</robot>", Code::parse},
                                {std::string(100, '\0'), Code::parse},
                                {"<sdf/>", Code::parse},
                                {srdf(deep), Code::limit},
                                {std::string((16u << 20) + 1, ' '), Code::limit},
                                {"<!DOCTYPE robot>" + srdf(""), Code::unsupported}};
  for (const Bad& bad : all) EXPECT_EQ(refusalOf([&] { readSrdf(bad.text); }), bad.code) << bad.text.substr(0, 60);
}

TEST(Srdf, ARuleWithoutItsLinksIsRefusedByName) {
  for (const char* rule :
       {"<disable_collisions link1=\"a\"/>", "<disable_collisions link2=\"b\"/>", "<disable_collisions/>",
        "<enable_collisions link1=\"a\"/>", "<disable_default_collisions/>"}) {
    std::string sentence;
    EXPECT_EQ(refusalOf([&] { readSrdf(srdf(rule)); }, &sentence), Code::parse) << rule;
    EXPECT_TRUE(says(sentence, "collisions")) << rule;
    EXPECT_TRUE(says(sentence, "link")) << rule;
  }
}

TEST(Srdf, RealFilesAreReadCompletely) {
  HGRID_NEEDS_SHARED_DATA();
  for (const char* name : {"ur5", "panda", "pr2"}) {
    const RealRobot robot = realRobot(name);
    tinyxml2::XMLDocument document;
    ASSERT_EQ(document.Parse(robot.srdf.data(), robot.srdf.size()), tinyxml2::XML_SUCCESS);
    std::size_t count = 0;
    for (const auto* rule = document.RootElement()->FirstChildElement("disable_collisions"); rule;
         rule = rule->NextSiblingElement("disable_collisions")) {
      ++count;
    }
    const LinkRules rules = readSrdf(robot.srdf);
    EXPECT_GT(count, 9u) << name;
    EXPECT_EQ(rules.disabled.size(), count) << name;
    EXPECT_TRUE(rules.enabled.empty()) << name;
    EXPECT_TRUE(rules.disabled_default.empty()) << name;
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
