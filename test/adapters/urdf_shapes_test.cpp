// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The robot loads without the shapes that cannot be read. The model reports each such shape by name.
#include <gtest/gtest.h>

#include "test/adapters/urdf_texts.h"
#include "test/support/refusals.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

struct BadShape {
  std::string collision;
  Code code;
  std::vector<std::string> words;  // words that the sentence must contain, in addition to the name of the link
};

std::string sphere(const std::string& radius) { return collision("<sphere radius=\"" + radius + "\"/>"); }
std::string box(const std::string& size) { return collision("<box size=\"" + size + "\"/>"); }
std::string cylinder(const std::string& radius, const std::string& length) {
  return collision("<cylinder radius=\"" + radius + "\" length=\"" + length + "\"/>");
}
std::string mesh(const std::string& uri, const std::string& more = "") {
  return collision("<mesh filename=\"" + uri + "\" " + more + "/>");
}
std::string at(const std::string& origin) { return collision("<sphere radius=\"1\"/>", "<origin " + origin + "/>"); }

/// Loads a robot whose link "claw" has three shapes: a valid box, the bad shape and a valid sphere.
void expectUnreadable(const BadShape& bad, MeshLoader& loader) {
  SCOPED_TRACE(bad.collision);
  const std::string text = robot(
      link("base", box("1 1 1")) +
      link("claw", box("1 2 3") + bad.collision + collision("<sphere radius=\"2\"/>", "<origin xyz=\"0 0 7\"/>")) +
      joint("j", "base", "claw"));
  const RobotModel model = readWith(loader, text);
  ASSERT_EQ(model.links.size(), 2u);
  EXPECT_EQ(accountedFor(model), 4u);
  EXPECT_TRUE(model.links[0].unreadable.empty());
  EXPECT_EQ(model.links[0].shapes.size(), 1u);

  const RobotLink& claw = model.links[1];
  EXPECT_TRUE(claw.has_collision);
  ASSERT_EQ(claw.shapes.size(), 2u);  // the valid shapes, each at its own origin
  EXPECT_EQ(claw.shapes[0].shape.dimensions(), std::vector<double>({1, 2, 3}));
  EXPECT_EQ(claw.shapes[0].body_from_shape.translation(), Eigen::Vector3d::Zero());
  EXPECT_EQ(claw.shapes[1].shape.dimensions(), std::vector<double>({2}));
  EXPECT_EQ(claw.shapes[1].body_from_shape.translation(), Eigen::Vector3d(0, 0, 7));
  ASSERT_EQ(claw.unreadable.size(), 1u);
  const std::string sentence = claw.unreadable[0].what();
  EXPECT_EQ(claw.unreadable[0].code(), bad.code) << sentence;
  EXPECT_TRUE(says(sentence, "claw"));
  for (const std::string& word : bad.words) EXPECT_TRUE(says(sentence, word));
}

void expectUnreadable(const std::vector<BadShape>& shapes) {
  MeshLoader loader(meshPolicy());
  for (const BadShape& bad : shapes) expectUnreadable(bad, loader);
}

TEST(UrdfShapes, InvalidNumbersAreNamed) {
  expectUnreadable({
      {sphere("nan"), Code::parse, {"nan", "radius"}},
      {sphere("inf"), Code::parse, {"inf", "radius"}},
      {sphere("-inf"), Code::parse, {"-inf", "radius"}},
      {sphere("1,5"), Code::parse, {"1,5", "radius"}},
      {sphere("1 abc"), Code::parse, {"1 abc", "radius"}},
      {sphere("abc"), Code::parse, {"abc", "radius"}},
      {sphere(""), Code::parse, {"radius"}},
      {sphere("1e400"), Code::parse, {"1e400", "radius"}},
      {box("1 nan 1"), Code::parse, {"nan", "size"}},
      {box("1 1"), Code::parse, {"1 1", "size"}},
      {box("1 1 1 1"), Code::parse, {"1 1 1 1", "size"}},
      {box("1,5 1 1"), Code::parse, {"1,5", "size"}},
      {cylinder("nan", "1"), Code::parse, {"nan", "radius"}},
      {cylinder("1", "inf"), Code::parse, {"inf", "length"}},
  });
}

TEST(UrdfShapes, InvalidGeometryIsNamed) {
  expectUnreadable({
      {collision("<torus radius=\"1\"/>"), Code::parse, {"torus"}},
      {collision(""), Code::parse, {"geometry"}},
      {"<collision><geometry/></collision>", Code::parse, {"geometry"}},
      {"<collision/>", Code::parse, {"geometry"}},
      {"<collision><origin xyz=\"0 0 0\"/></collision>", Code::parse, {"geometry"}},
      {collision("<mesh/>"), Code::parse, {"mesh", "filename"}},
      {collision("<mesh filename=\"\"/>"), Code::resource_denied, {"''"}},
      {collision("<sphere/>"), Code::parse, {"sphere", "radius"}},
      {collision("<box/>"), Code::parse, {"box", "size"}},
      {collision("<cylinder radius=\"1\"/>"), Code::parse, {"cylinder", "length"}},
      {collision("<cylinder length=\"1\"/>"), Code::parse, {"cylinder", "radius"}},
  });
}

TEST(UrdfShapes, SizesThatAreNotPositiveAreNamed) {
  expectUnreadable({
      {sphere("-1"), Code::bad_geometry, {"-1", "radius"}},
      {sphere("1e-320"), Code::bad_geometry, {"radius"}},
      {box("1 -2 1"), Code::bad_geometry, {"-2"}},
      {box("1 1 0"), Code::bad_geometry, {"0"}},
      {cylinder("-0.5", "1"), Code::bad_geometry, {"-0.5", "radius"}},
      {cylinder("1", "-0.25"), Code::bad_geometry, {"-0.25"}},
      {cylinder("0", "1"), Code::bad_geometry, {"0", "radius"}},
  });
}

/// Claim: a shape without any extent, by which some robots mark a place, is a point. A shape that is only flat is not.
TEST(UrdfShapes, WithoutAnyExtentIsAPoint) {
  const RobotModel model = read(robot(link("a", sphere("0") + box("0 0 0") + box("0 0 1"))));
  const RobotLink& a = model.links.at(0);
  ASSERT_EQ(a.shapes.size(), 2u);
  EXPECT_EQ(a.shapes[0].shape.dimensions(), std::vector<double>({1e-4}));
  EXPECT_EQ(a.shapes[1].shape.dimensions(), std::vector<double>({1e-4, 1e-4, 1e-4}));
  ASSERT_EQ(a.unreadable.size(), 1u);
  EXPECT_EQ(a.unreadable[0].code(), Code::bad_geometry);
  ASSERT_EQ(model.warnings.size(), 2u);
  EXPECT_EQ(model.warnings[0], "<collision> 1 of link 'a' has size 0; it counts as a point of 0.0001 m");
}

TEST(UrdfShapes, MeshesThatCannotBeOpenedAreNamed) {
  expectUnreadable({
      {mesh("package://hgrid_test/meshes/gone.stl"), Code::resource_missing, {"gone.stl"}},
      {mesh("package://no_such_package/a.stl"), Code::resource_missing, {"no_such_package"}},
      {mesh("package://hgrid_test/../CMakeLists.txt"), Code::resource_denied, {"CMakeLists.txt"}},
      {mesh("file:///etc/passwd"), Code::resource_denied, {"/etc/passwd"}},
      {mesh("http://127.0.0.1:9/a.stl"), Code::resource_denied, {"http"}},
      {mesh("meshes/corner.stl"), Code::resource_denied, {"meshes/corner.stl"}},
      {mesh("package://hgrid_test/robots/traits.urdf"), Code::unsupported, {"traits.urdf"}},
  });
}

TEST(UrdfShapes, ScalesThatMakeNoMeshAreNamed) {
  const std::string corner = "package://hgrid_test/meshes/corner.stl";
  expectUnreadable({
      {mesh(corner, "scale=\"0 1 1\""), Code::bad_geometry, {"scale"}},
      {mesh(corner, "scale=\"0 0 0\""), Code::bad_geometry, {"scale"}},
      {mesh(corner, "scale=\"nan 1 1\""), Code::parse, {"nan", "scale"}},
      {mesh(corner, "scale=\"1 1\""), Code::parse, {"1 1", "scale"}},
      {mesh(corner, "scale=\"1,0 1 1\""), Code::parse, {"1,0", "scale"}},
      {mesh(corner, "scale=\"1e-30 1e-30 1e-30\""), Code::bad_geometry, {"corner.stl"}},
      {mesh(corner, "scale=\"1e30 1 1\""), Code::bad_geometry, {"scale"}},
  });
}

TEST(UrdfShapes, OriginsBeyondTheLimitAreNamed) {
  expectUnreadable({
      {at("xyz=\"1e300 0 0\""), Code::out_of_range, {"1e", "origin"}},
      {at("xyz=\"0 0 -1e300\""), Code::out_of_range, {"-1e", "origin"}},
      {at("xyz=\"nan 0 0\""), Code::parse, {"nan", "origin"}},
      {at("xyz=\"0 inf 0\""), Code::parse, {"inf", "origin"}},
      {at("xyz=\"0 0\""), Code::parse, {"0 0", "origin"}},
      {at("rpy=\"0 nan 0\""), Code::parse, {"nan", "origin"}},
      {at("rpy=\"0 0 abc\""), Code::parse, {"abc", "origin"}},
  });
}

TEST(UrdfShapes, ARobotOfBadShapesOnlyIsStillARobot) {
  const RobotModel model = read(robot(link("base", sphere("nan") + box("0 0 1") + collision("<torus/>"))));
  ASSERT_EQ(model.links.size(), 1u);
  EXPECT_TRUE(model.links[0].has_collision);
  EXPECT_TRUE(model.links[0].shapes.empty());
  EXPECT_EQ(model.links[0].unreadable.size(), 3u);
}

TEST(UrdfShapes, NothingFromOutsideBreaksTheSentence) {
  const RobotModel model = read(robot(link("base", sphere("n&#10;&#x1b;[31man") + collision("<tor\xffus/>"))));
  ASSERT_EQ(model.links.size(), 1u);
  ASSERT_EQ(model.links[0].unreadable.size(), 2u);
  for (const Refusal& refusal : model.links[0].unreadable) {
    for (const char c : std::string(refusal.what())) EXPECT_TRUE(c >= 0x20 && c < 0x7f) << refusal.what();
  }
}

TEST(UrdfShapes, ShapeLimitsAreThoseOfTheCaller) {
  ShapeLimits limits;
  limits.max_size = 10.0;
  limits.allow_flat = true;
  const std::string text = robot(link("base", sphere("11") + sphere("10") + box("1 1 0")));
  const RobotModel model = readUrdf(text, knowsOneMesh, {}, limits);
  EXPECT_EQ(model.links.at(0).shapes.size(), 2u);
  ASSERT_EQ(model.links.at(0).unreadable.size(), 1u);
  EXPECT_TRUE(says(model.links[0].unreadable[0].what(), "11"));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
