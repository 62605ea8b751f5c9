// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// A robot is refused if its links and joints do not form a tree. The error sentence names a link or a joint.
#include <gtest/gtest.h>

#include <limits>

#include "hgrid_proximity/bodies/kinematics.h"
#include "test/adapters/urdf_texts.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace test {
namespace {

struct NoTree {
  const char* what;
  std::string content;
  std::vector<std::string> one_of;  // the sentence must contain at least one of these names
};

const std::vector<NoTree>& noTrees() {
  static const std::vector<NoTree> all = {
      // Loops of joints.
      {"self-loop beside a root", link("base") + link("wheel") + joint("spin", "wheel", "wheel"), {"wheel"}},
      {"self-loop alone", link("wheel") + joint("spin", "wheel", "wheel"), {"wheel"}},
      {"cycle of two alone",
       link("wheel") + link("axle") + joint("j1", "wheel", "axle") + joint("j2", "axle", "wheel"),
       {"wheel", "axle"}},
      {"detached cycle of two and a root",
       link("base") + link("wheel") + link("axle") + joint("j1", "wheel", "axle") + joint("j2", "axle", "wheel"),
       {"wheel", "axle"}},
      {"detached cycle of three and a tree",
       link("base") + link("arm") + joint("j0", "base", "arm") + link("wheel") + link("axle") + link("rim") +
           joint("j1", "wheel", "axle") + joint("j2", "axle", "rim") + joint("j3", "rim", "wheel"),
       {"wheel", "axle", "rim"}},
      // Several parents or roots, and missing or duplicate names.
      {"two parents",
       link("base") + link("left") + link("hand") + joint("j1", "base", "left") + joint("j2", "base", "hand") +
           joint("j3", "left", "hand"),
       {"hand"}},
      {"two roots", link("base") + link("island"), {"base", "island"}},
      {"missing child", link("base") + joint("j1", "base", "ghost"), {"ghost"}},
      {"missing parent", link("base") + joint("j1", "ghost", "base"), {"ghost"}},
      {"duplicate link", link("base") + link("twin") + link("twin") + joint("j1", "base", "twin"), {"twin"}},
      {"xacro that was not expanded", "<xacro:include filename=\"arm.xacro\"/>", {"xacro:include"}},
      {"xacro inside a link", link("base", "<xacro:box size=\"1\"/>"), {"xacro:box"}},
      {"duplicate joint",
       link("base") + link("left") + link("right") + joint("hinge", "base", "left") + joint("hinge", "base", "right"),
       {"hinge"}},
      // Other errors.
      {"unknown joint type", link("base") + link("arm") + joint("hinge", "base", "arm", "screwed"), {"hinge"}},
      {"revolute without limits", link("base") + link("arm") + joint("hinge", "base", "arm", "revolute"), {"hinge"}},
      {"joint origin that is not a number",
       link("base") + link("arm") + joint("hinge", "base", "arm", "fixed", "<origin xyz=\"0 nan 0\"/>"),
       {"hinge", "arm"}},
  };
  return all;
}

TEST(UrdfStructure, LinksThatFormNoTreeAreRefusedByName) {
  for (const NoTree& bad : noTrees()) {
    SCOPED_TRACE(bad.what);
    std::string sentence;
    EXPECT_EQ(refusalOf([&] { read(robot(bad.content)); }, &sentence), Code::parse);
    bool named = false;
    for (const std::string& name : bad.one_of) named |= sentence.find(name) != std::string::npos;
    EXPECT_TRUE(named) << sentence;
  }
}

TEST(UrdfStructure, NoLinksAndNoNameAreRefused) {
  EXPECT_EQ(refusalOf([] { read(robot("")); }), Code::parse);
  EXPECT_EQ(refusalOf([] { read("<robot>" + link("a") + "</robot>"); }), Code::parse);
}

TEST(UrdfStructure, InvalidLinkNamesAreRefused) {
  for (const std::string& name : {std::string(), std::string("cl&#x1b;[31maw"), std::string("a&#10;b"),
                                  std::string("\xff"), std::string(129, 'x')}) {
    std::string sentence;
    const Code code = refusalOf([&] { read(robot(link(name))); }, &sentence);
    EXPECT_TRUE(code == Code::bad_id || code == Code::parse) << hgrid::name(code);
    for (const char c : sentence) EXPECT_NE(c, '\x1b');
  }
  EXPECT_EQ(read(robot(link(std::string(128, 'x')))).links.size(), 1u);
}

TEST(UrdfStructure, AnElementOfXacroBesideLinksIsIgnoredWithAWarning) {
  const RobotModel model = read(robot("<xacro:include filename=\"more.xacro\"/>\n" + link("base")));
  EXPECT_EQ(model.links.size(), 1u);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_TRUE(says(model.warnings[0], "<xacro:include> in line 2"));
  const std::string hidden = "<xacro:if value=\"1\">" + link("arm") + joint("j", "base", "arm") + "</xacro:if>";
  EXPECT_EQ(refusalOf([&] { read(robot(link("base") + hidden)); }), Code::parse) << "a part would be missing";
}

TEST(UrdfStructure, WhatUrdfdomSaysIsInTheSentence) {
  std::string sentence;
  EXPECT_EQ(refusalOf([] { read("<robot name=\"r\" version=\"1\">" + link("a") + "</robot>"); }, &sentence),
            Code::parse);
  EXPECT_TRUE(says(sentence, "the URDF's links and joints cannot be read: "));
  EXPECT_TRUE(says(sentence, "ersion")) << "urdfdom takes version 1.0 only, and says so";
}

/// Claim: a joint whose limits leave it no room is named, because other tools do not let it move at all.
TEST(UrdfStructure, LimitsWithoutRoomAreAWarningByName) {
  for (const std::string limit : {"", "lower=\"1\" upper=\"-1\" "}) {
    SCOPED_TRACE(limit);
    const RobotModel model =
        read(robot(link("base") + link("arm") +
                   joint("hinge", "base", "arm", "revolute", "<limit " + limit + "effort=\"1\" velocity=\"1\"/>")));
    ASSERT_EQ(model.warnings.size(), 1u);
    EXPECT_TRUE(says(model.warnings[0], "joint 'hinge' may go from"));
  }
}

TEST(UrdfStructure, AnAxisOfLengthZeroIsAWarningByName) {
  const RobotModel model =
      read(robot(link("base") + link("arm") + joint("hinge", "base", "arm", "continuous", "<axis xyz=\"0 0 0\"/>")));
  EXPECT_EQ(model.links.at(1).axis.norm(), 1.0);
  EXPECT_FALSE(model.links.at(1).has_axis);
  EXPECT_EQ(refusalOf([&] { Kinematics{model}; }), Code::bad_geometry) << "nobody knows how this joint moves";
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_TRUE(says(model.warnings[0], "hinge"));
}

TEST(UrdfStructure, AJointThatMimicsAnotherNamesItWithItsMultiplierAndOffset) {
  const RobotModel model = read(robot(
      link("base") + link("left") + link("right") + joint("open", "base", "left", "continuous") +
      joint("follow", "base", "right", "continuous", "<mimic joint=\"open\" multiplier=\"-2\" offset=\"0.25\"/>")));
  const RobotLink &left = model.links.at(std::size_t(model.find("left"))),
                  &right = model.links.at(std::size_t(model.find("right")));
  EXPECT_TRUE(left.continuous);
  EXPECT_EQ(left.mimic, "");
  EXPECT_EQ(right.mimic, "open");
  EXPECT_EQ(right.mimic_multiplier, -2.0);
  EXPECT_EQ(right.mimic_offset, 0.25);
}

TEST(UrdfStructure, ARefusalDoesNotAffectTheNextText) {
  const std::string good = robot(link("base", collision("<sphere radius=\"1\"/>")));
  for (const NoTree& bad : noTrees()) {
    refusalOf([&] { read(robot(bad.content)); });
    EXPECT_EQ(accountedFor(read(good)), 1u) << "after " << bad.what;
  }
}

TEST(UrdfStructure, AFarJointIsRefusedOrFinite) {  // a model must not contain infinite numbers
  const std::string far = link("base") + link("arm") + link("hand", collision("<sphere radius=\"1\"/>"));
  const std::string origin = "<origin xyz=\"1e300 0 0\"/>";
  const std::string text =
      robot(far + joint("j1", "base", "arm", "fixed", origin) + joint("j2", "arm", "hand", "fixed", origin));
  std::string sentence;
  const Code code = refusalOf([&] { read(text); }, &sentence);
  EXPECT_TRUE(code == Code::out_of_range || code == Code::parse) << name(code) << ": " << sentence;
  EXPECT_TRUE(says(sentence, "j1"));
}

TEST(UrdfStructure, ANegativeVelocityLimitIsNotUsedAndIsNamed) {
  const RobotModel model =
      read(robot(link("a") + link("b") +
                 joint("j", "a", "b", "revolute", "<limit lower=\"0\" upper=\"1\" velocity=\"-12\" effort=\"3\"/>")));
  EXPECT_EQ(model.links[1].max_velocity, 0.0);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_EQ(model.warnings[0], "joint 'j' has the velocity limit -12; it must not be negative and is not used");
}

}  // namespace
}  // namespace test
}  // namespace hgrid
