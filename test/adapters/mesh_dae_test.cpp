// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// COLLADA files as programs write them. Each is read as its standard says, or refused with a sentence that names the
// element. No part of the surface is left out without a word.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "test/adapters/temporary_folder.h"
#include "test/support/mesh_oracle.h"
#include "test/support/refusals.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

/// A mesh with the corners of the unit cube: number x + 2 y + 4 z is at x y z.
std::string meshOf(const std::string& primitives, const std::string& name) {
  return "<mesh><source id='s" + name + "'><float_array id='a" + name +
         "' count='24'>0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1</float_array><technique_common><accessor "
         "source='#a" +
         name +
         "' count='8' stride='3'><param name='X' type='float'/><param name='Y' type='float'/><param name='Z' "
         "type='float'/></accessor></technique_common></source><vertices id='v" +
         name + "'><input semantic='POSITION' source='#s" + name + "'/></vertices>" + primitives + "</mesh>";
}

/// Returns faces of the mesh `name`. @param content  such as "<p>0 1 2</p>"
std::string faces(const std::string& kind, int count, const std::string& content, const std::string& name = "g") {
  return "<" + kind + " count='" + std::to_string(count) + "'><input semantic='VERTEX' source='#v" + name +
         "' offset='0'/>" + content + "</" + kind + ">";
}

const std::string kQuads = "<vcount>4 4 4 4 4 4</vcount><p>0 2 3 1 4 5 7 6 0 1 5 4 2 6 7 3 0 4 6 2 1 3 7 5</p>";
const std::string kCube = meshOf(faces("polylist", 6, kQuads), "g");

struct Document {
  std::string nodes = "<node><instance_geometry url='#g'/></node>";
  std::string mesh = kCube;
  std::string unit;
  std::string library;  // further elements of the root
};

std::string dae(const Document& scene) {
  return "<?xml version='1.0'?>\n<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
         "version='1.4.1'><asset>" +
         scene.unit + "<up_axis>Z_UP</up_axis></asset>\n<library_geometries><geometry id='g'>" + scene.mesh +
         "</geometry></library_geometries>\n" + scene.library + "<library_visual_scenes><visual_scene id='w'>" +
         scene.nodes +
         "</visual_scene></library_visual_scenes>\n<scene><instance_visual_scene url='#w'/></scene></COLLADA>";
}

class Collada : public ::testing::Test {
 protected:
  Code refusal(const std::string& text) {
    MeshPolicy policy = meshPolicy();
    policy.resources.file_roots = {folder_.path()};
    const std::string uri = "file://" + folder_.write("a.dae", text);
    sentence_.clear();
    mesh_ = nullptr;
    return refusalOf([&] { mesh_ = MeshLoader(policy).load(uri, {1, 1, 1}); }, &sentence_);
  }

  /// Expects that the file is refused as unsupported or wrong, with these words.
  void expectRefusal(const Document& scene, const std::string& word, Code code = Code::parse) {
    EXPECT_EQ(refusal(dae(scene)), code) << word << ": " << sentence_;
    EXPECT_TRUE(says(sentence_, word));
  }

  /// Expects that the file contains a closed surface around this volume [m^3].
  void expectVolume(const Document& scene, double volume, const std::string& what) {
    ASSERT_EQ(refusal(dae(scene)), Code::ok) << what << ": " << sentence_;
    double sum = 0;
    for (const auto& t : mesh_->triangles) {
      sum += mesh_->vertices[t[0]].dot(mesh_->vertices[t[1]].cross(mesh_->vertices[t[2]])) / 6;
    }
    EXPECT_NEAR(sum, volume, 1e-5 * volume) << what;
  }

  /// Returns the box around the mesh that was read.
  Eigen::AlignedBox3d box() const {
    Eigen::AlignedBox3d all;
    for (const Eigen::Vector3d& vertex : mesh_->vertices) all.extend(vertex);
    return all;
  }

  TemporaryFolder folder_;
  std::string sentence_;
  std::shared_ptr<const TriangleMesh> mesh_;
};

std::string nodeWith(const std::string& transforms) {
  return "<node>" + transforms + "<instance_geometry url='#g'/></node>";
}

TEST_F(Collada, WhatIsNotReadIsRefusedByName) {
  const std::string first = "<node><instance_geometry url='#g'/></node>";
  Document scene;
  scene.library =
      "<library_geometries><geometry id='h'><convex_mesh convex_hull_of='#g'/></geometry></library_geometries>";
  expectVolume(scene, 1.0, "a geometry that the scene does not use");
  scene.nodes = first + "<node><translate>2 0 0</translate><instance_geometry url='#h'/></node>";
  expectRefusal(scene, "<convex_mesh>", Code::unsupported);
  scene = {};
  scene.library = "<library_geometries><geometry id='h'><brep/></geometry></library_geometries>";
  scene.nodes = first + "<node><instance_geometry url='#h'/></node>";
  expectRefusal(scene, "<brep>", Code::unsupported);
  scene = {};
  for (const char* url : {"#nobody", "", "#", "other.dae#g", "g"}) {
    scene.nodes = first + "<node><instance_geometry url='" + url + "'/></node>";
    expectRefusal(scene, "<instance_geometry>");
    EXPECT_TRUE(says(sentence_, std::string("'") + url + "'"));
  }
  scene.nodes = first + "<node><instance_node url='#nobody'/></node>";
  expectRefusal(scene, "<instance_node>");
  scene.nodes = first + "<node><instance_controller url='#skin'/></node>";
  expectRefusal(scene, "<instance_controller>", Code::unsupported);
  scene.nodes = nodeWith("<skew>45 1 0 0 0 1 0</skew>");
  expectRefusal(scene, "<skew>", Code::unsupported);
  scene.nodes = nodeWith("<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0.1 1</matrix>");
  expectRefusal(scene, "<matrix>", Code::unsupported);
  scene = {};
  scene.mesh = meshOf(faces("polygons", 1, "<ph><p>0 1 3 2</p><h>0 1 3</h></ph>"), "g");
  expectRefusal(scene, "<ph>", Code::unsupported);
  scene.mesh = meshOf(faces("polylist", 6, kQuads) + "<surfaces/>", "g");
  expectRefusal(scene, "<surfaces>", Code::unsupported);
}

TEST_F(Collada, EveryKindOfFaceIsRead) {
  Document scene;
  scene.mesh = meshOf(
      faces("polygons", 6, "<p>0 2 3 1</p><p>4 5 7 6</p><p>0 1 5 4</p><p>2 6 7 3</p><p>0 4 6 2</p><p>1 3 7 5</p>"),
      "g");
  expectVolume(scene, 1.0, "polygons");
  scene.mesh = meshOf(faces("tristrips", 3, "<p>0 1 4 5 6 7 2 3</p><p>4 6 0 2</p><p>1 3 5 7</p>") +
                          faces("triangles", 2, "<p>0 2 1 1 2 3</p>"),
                      "g");
  expectVolume(scene, 1.0, "tristrips");
  const std::string base = faces("polylist", 1, "<vcount>4</vcount><p>0 2 3 1</p>");  // of a pyramid
  scene.mesh = meshOf(faces("trifans", 1, "<p>4 0 1 3 2 0</p>") + base, "g");
  expectVolume(scene, 1.0 / 3, "a fan");
  scene.mesh = meshOf(faces("trifans", 2, "<p>4 0 1 3</p><p>4 3 2 0</p>") + base, "g");
  expectVolume(scene, 1.0 / 3, "two fans");
  scene.mesh = meshOf(faces("lines", 1, "<p>0 7</p>") + faces("polylist", 6, kQuads) + "<extra/>", "g");
  expectVolume(scene, 1.0, "lines have no area");
}

TEST_F(Collada, AnAxisOfAnyLengthOnlyTurns) {
  Document scene;
  for (const char* rotate : {"0 0 1 30", "0 0 2 30", "0.1 0.2 -0.05 77", "3 0 0 0", "0 0 0 0", "0 -1e-3 0 90"}) {
    scene.nodes = nodeWith(std::string("<rotate>") + rotate + "</rotate>");
    expectVolume(scene, 1.0, rotate);
  }
  scene.nodes = nodeWith("<rotate>0 0 5 90</rotate>");
  expectVolume(scene, 1.0, "a quarter");
  EXPECT_LT((box().min() - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-6);
  scene.nodes = nodeWith("<rotate>0 0 0 90</rotate>");
  expectRefusal(scene, "<rotate>");
}

TEST_F(Collada, AUnitWithBlanksIsThatUnit) {
  Document scene;
  for (const char* meter : {"0.01", " 0.01", "0.01 ", "&#9;1e-2&#10;"}) {
    scene.unit = std::string("<unit name='centimeter' meter='") + meter + "'/>";
    expectVolume(scene, 1e-6, meter);
  }
  for (const char* meter : {"0,01", "0.01 m", "", "0", "-1", "nan", "0x1"}) {
    scene.unit = std::string("<unit meter='") + meter + "'/>";
    expectRefusal(scene, "<unit>");
  }
}

TEST_F(Collada, ALookatDoesNotShear) {
  Document scene;
  scene.nodes = nodeWith("<lookat>1 2 3  4 6 3  3 4 5</lookat>");  // its up is not normal to its direction
  expectVolume(scene, 1.0, "lookat");
  for (const Eigen::Vector3d& v : mesh_->vertices) {  // the node looks along its -z, from its origin
    const Eigen::Vector3d from_eye = v - Eigen::Vector3d(1, 2, 3);
    const double z = -from_eye.dot(Eigen::Vector3d(0.6, 0.8, 0)), y = from_eye.z();
    EXPECT_TRUE(std::abs(z * (z - 1)) < 1e-6 && std::abs(y * (y - 1)) < 1e-6) << v.transpose();
  }
  for (const char* lookat : {"1 2 3 1 2 3 0 0 1", "0 0 0 0 0 1 0 0 2"}) {
    scene.nodes = nodeWith(std::string("<lookat>") + lookat + "</lookat>");
    expectRefusal(scene, "<lookat>");
  }
}

TEST_F(Collada, TransformsAndInstancesAreAppliedInTheirOrder) {
  Document scene;
  scene.nodes =
      "<node id='n'><translate>1 0 0</translate><scale>2 2 2</scale><instance_geometry url='#g'/></node>"
      "<node><matrix>1 0 0 10 0 1 0 0 0 0 1 0 0 0 0 1</matrix><instance_node url='#n'/></node>";
  expectVolume(scene, 16.0, "two instances");
  EXPECT_LT((box().min() - Eigen::Vector3d(1, 0, 0)).norm(), 1e-6);
  EXPECT_LT((box().max() - Eigen::Vector3d(13, 2, 2)).norm(), 1e-6);
  scene.nodes = "<node id='n'><instance_geometry url='#g'/><instance_node url='#n'/></node>";
  expectRefusal(scene, "or in itself", Code::limit);
  scene.nodes = nodeWith("<translate>1 0</translate>");
  expectRefusal(scene, "<translate>");
}

/// Claim: comments within numbers, and numbers in several pieces, do not end the list.
TEST_F(Collada, CommentsDoNotHideNumbers) {
  Document scene;
  std::string quads = kQuads;
  quads.insert(quads.find("4 5 7 6"), "<!-- top -->");
  scene.mesh = meshOf(faces("polylist", 6, quads), "g");
  scene.mesh.replace(scene.mesh.find("0 0 1 1 0 1"), 0, "<!-- upper --><![CDATA[ ]]>");
  scene.nodes = nodeWith("<scale>2 <!-- twice -->2 2</scale>");
  expectVolume(scene, 8.0, "comments");
}

/// Claim: a file without any face is refused. The reader does not invent a shape for it.
TEST_F(Collada, ASceneWithoutFacesHasNoShape) {
  Document scene;
  scene.nodes = "<node><translate>1 0 0</translate><node><translate>0 1 0</translate></node></node>";
  EXPECT_EQ(refusal(dae(scene)), Code::bad_geometry) << sentence_;
  scene.nodes = "";
  EXPECT_EQ(refusal(dae(scene)), Code::bad_geometry) << sentence_;
  scene = {};
  scene.mesh = meshOf(faces("lines", 1, "<p>0 1</p>"), "g");
  EXPECT_EQ(refusal(dae(scene)), Code::bad_geometry) << sentence_;
}

TEST_F(Collada, CountsMustFit) {
  Document scene;
  scene.mesh = meshOf(faces("polylist", 5, kQuads), "g");
  expectRefusal(scene, "<polylist>");
  scene.mesh = meshOf(faces("polylist", 2, "<vcount>4 4</vcount><p>0 2 3 1 4 5 7</p>"), "g");
  expectRefusal(scene, "<polylist>");
  scene.mesh = meshOf(faces("polylist", 1, "<vcount>4</vcount><p>0 2 3 1 4 5 7 6</p>"), "g");
  expectRefusal(scene, "<polylist>");
  scene.mesh = meshOf(faces("triangles", 2, "<p>0 2 3</p>"), "g");
  expectRefusal(scene, "<triangles>");
  scene.mesh = meshOf(faces("triangles", 1, "<p>0 2 3 1</p>"), "g");
  expectRefusal(scene, "<triangles>");
  scene.mesh = meshOf(faces("triangles", 1, "<p>0 2 -1</p>"), "g");
  expectRefusal(scene, "<p>");
  scene.mesh = meshOf(faces("triangles", 1, "<p>0 2 8</p>"), "g");
  expectRefusal(scene, "vertex 8", Code::bad_geometry);
  const std::vector<std::array<std::string, 3>> changes = {
      {"count='8'", "count='9'", "<accessor>"},    {"stride='3'", "stride='1'", "<accessor>"},
      {"name='Y'", "name='Z'", "<accessor>"},      {"count='24'", "count='27'", "<float_array>"},
      {"1 1 1<", "1 1 1,0<", "<float_array>"},     {"'POSITION'", "'NORMAL'", "<vertices>"},
      {"source='#vg'", "source='#vh'", "<input>"},
  };
  for (const auto& [part, instead, word] : changes) {
    scene.mesh = kCube;
    scene.mesh.replace(scene.mesh.find(part), part.size(), instead);
    const Code code = refusal(dae(scene));
    EXPECT_TRUE(code == Code::parse || code == Code::unsupported) << part << name(code);
    EXPECT_TRUE(says(sentence_, word));
  }
}

TEST_F(Collada, TextThatIsNoColladaIsRefused) {
  EXPECT_EQ(refusal("<robot name='a'/>"), Code::parse) << sentence_;
  EXPECT_TRUE(says(sentence_, "<COLLADA>"));
  EXPECT_EQ(refusal(dae({}).substr(0, 900)), Code::parse) << sentence_;
  std::string deep = dae({});
  for (int i = 0; i < 200; ++i) {
    deep.insert(deep.find("<node>"), "<node>");
    deep.insert(deep.rfind("</visual_scene>"), "</node>");
  }
  EXPECT_EQ(refusal(deep), Code::limit) << sentence_;
  std::string entity = dae({});
  entity.insert(entity.find("<COLLADA"), "<!DOCTYPE COLLADA [<!ENTITY a 'b'>]>");
  EXPECT_EQ(refusal(entity), Code::unsupported) << sentence_;
  std::string twice = dae({});
  twice.insert(twice.find("<library_visual"),
               "<library_geometries><geometry id='g'>" + kCube + "</geometry></library_geometries>");
  EXPECT_EQ(refusal(twice), Code::parse) << sentence_;
}

}  // namespace
}  // namespace test
}  // namespace hgrid
