// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Visual geometry replaces collision geometry only if the caller selects the link and the link has no <collision>.
#include <gtest/gtest.h>

#include "test/adapters/urdf_texts.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace test {
namespace {

std::string visual(const std::string& geometry, const std::string& more = "") {
  return "<visual>" + more + "<geometry>" + geometry + "</geometry></visual>";
}

RobotModel readWithVisual(const std::string& urdf, const VisualChoice& takes_visual, const ShapeLimits& limits = {}) {
  return readUrdf(urdf, knowsOneMesh, {}, limits, takes_visual);
}

bool all(const std::string&) { return true; }

TEST(UrdfVisual, IsUsedOnlyForChosenLinksWithoutCollision) {
  const std::string text =
      robot(link("base", visual("<sphere radius=\"1\"/>") + collision("<sphere radius=\"2\"/>")) +
            link("chosen", visual("<sphere radius=\"3\"/>") + visual("<box size=\"1 2 3\"/>")) +
            link("other", visual("<sphere radius=\"4\"/>")) + link("bare") + joint("a", "base", "chosen") +
            joint("b", "base", "other") + joint("c", "base", "bare"));
  const RobotModel model = readWithVisual(text, [](const std::string& link) { return link != "other"; });
  const auto linkOf = [&](const char* name) -> const RobotLink& {
    return model.links.at(static_cast<std::size_t>(model.find(name)));
  };
  ASSERT_EQ(linkOf("base").shapes.size(), 1u);
  EXPECT_EQ(linkOf("base").shapes[0].shape.dimensions(), std::vector<double>({2}));
  EXPECT_FALSE(linkOf("base").uses_visual);
  ASSERT_EQ(linkOf("chosen").shapes.size(), 2u);
  EXPECT_EQ(linkOf("chosen").shapes[0].shape.dimensions(), std::vector<double>({3}));
  EXPECT_EQ(linkOf("chosen").shapes[1].shape.dimensions(), std::vector<double>({1, 2, 3}));
  EXPECT_TRUE(linkOf("chosen").uses_visual && linkOf("chosen").hasGeometry());
  EXPECT_FALSE(linkOf("chosen").has_collision);
  for (const char* name : {"other", "bare"}) EXPECT_FALSE(linkOf(name).uses_visual || linkOf(name).hasGeometry());
  for (const RobotLink& link : readWithVisual(text, {}).links) EXPECT_FALSE(link.uses_visual) << link.name;
}

TEST(UrdfVisual, DoesNotReplaceACollisionThatCannotBeRead) {
  const RobotModel model = readWithVisual(
      robot(link("base", collision("<sphere radius=\"nan\"/>") + visual("<sphere radius=\"1\"/>"))), all);
  EXPECT_FALSE(model.links[0].uses_visual);
  EXPECT_TRUE(model.links[0].shapes.empty());
  EXPECT_EQ(model.links[0].unreadable.size(), 1u);
}

TEST(UrdfVisual, HasTheOriginMeshAndScaleOfTheElement) {
  const RobotModel model =
      readWithVisual(robot(link("base", visual("<mesh filename=\"package://p/tetrahedron.stl\" scale=\"1 2 4\"/>",
                                               "<origin xyz=\"1 2 3\" rpy=\"0 0 0\"/>"))),
                     all);
  ASSERT_EQ(model.links[0].shapes.size(), 1u);
  const BodyShape& shape = model.links[0].shapes[0];
  EXPECT_EQ(shape.body_from_shape.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(shape.resource, "package://p/tetrahedron.stl");
  EXPECT_EQ(shape.scale, Eigen::Vector3d(1, 2, 4));
}

TEST(UrdfVisual, AnythingButOriginAndGeometryDoesNotMatter) {
  for (const char* material :
       {"<material/>", "<material name=\"\"/>", "<material name=\"x\"><color rgba=\"a\"/></material>",
        "<material name=\"nobody defined this\"/>"}) {
    const RobotModel model = readWithVisual(robot(link("base", visual("<sphere radius=\"1\"/>", material))), all);
    EXPECT_EQ(model.links[0].shapes.size(), 1u) << material;
    EXPECT_TRUE(model.links[0].unreadable.empty()) << material;
  }
}

TEST(UrdfVisual, ThatCannotBeReadIsNamedAndTheRestIsUsed) {
  struct Bad {
    std::string visual;
    Code code;
    std::string word;
  };
  ShapeLimits limits;
  limits.max_size = 10.0;
  for (const Bad& bad : {Bad{visual("<sphere radius=\"nan\"/>"), Code::parse, "nan"},
                         Bad{visual("<sphere radius=\"11\"/>"), Code::bad_geometry, "11"},
                         Bad{visual("<torus/>"), Code::parse, "torus"}, Bad{"<visual/>", Code::parse, "geometry"},
                         Bad{visual("<mesh filename=\"package://p/gone.dae\"/>"), Code::resource_missing, "gone.dae"},
                         Bad{visual("<sphere radius=\"1\"/>", "<origin xyz=\"99 0 0\"/>"), Code::out_of_range, "99"}}) {
    SCOPED_TRACE(bad.visual);
    const RobotModel model =
        readWithVisual(robot(link("base", bad.visual + visual("<sphere radius=\"1\"/>"))), all, limits);
    EXPECT_TRUE(model.links[0].uses_visual);
    EXPECT_EQ(model.links[0].shapes.size(), 1u);
    ASSERT_EQ(model.links[0].unreadable.size(), 1u);
    EXPECT_EQ(model.links[0].unreadable[0].code(), bad.code);
    EXPECT_TRUE(says(model.links[0].unreadable[0].what(), "<visual> 1 of link 'base'"));
    EXPECT_TRUE(says(model.links[0].unreadable[0].what(), bad.word));
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
