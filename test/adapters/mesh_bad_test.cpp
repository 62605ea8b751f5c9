// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Reads files that contain no mesh, and meshes that are invalid. The loader must refuse all of them with the right
// code.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "src/tools/mesh/stl_file.h"
#include "test/adapters/mutation.h"
#include "test/adapters/temporary_folder.h"
#include "test/adapters/urdf_texts.h"
#include "test/fuzz/seeds.h"
#include "test/support/refusals.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

using Triangle = std::array<std::array<float, 3>, 3>;

/// Returns a binary STL file with these triangles. Its header says that there are `count` triangles.
std::string stl(const std::vector<Triangle>& triangles, std::uint32_t count) {
  std::string bytes(84, ' ');
  std::memcpy(&bytes[80], &count, 4);
  for (const Triangle& triangle : triangles) {
    char record[50] = {};
    std::memcpy(record + 12, triangle.data(), 36);
    bytes.append(record, sizeof record);
  }
  return bytes;
}
std::string stl(const std::vector<Triangle>& triangles) {
  return stl(triangles, static_cast<std::uint32_t>(triangles.size()));
}

class BadMesh : public ::testing::Test {
 protected:
  BadMesh() {
    policy_.resources.file_roots = {folder_.path()};
    policy_.timeout = policy_.total = std::chrono::seconds(60);
  }
  Code refusal(const std::string& name, const std::string& bytes, const Eigen::Vector3d& scale = {1, 1, 1}) {
    const std::string uri = "file://" + folder_.write(name, bytes);
    MeshLoader loader(policy_);
    sentence_.clear();
    return refusalOf([&] { mesh_ = loader.load(uri, scale); }, &sentence_);
  }
  TemporaryFolder folder_;
  MeshPolicy policy_ = meshPolicy();
  std::string sentence_;
  std::shared_ptr<const TriangleMesh> mesh_;
};

const Triangle kFlat = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
const Triangle kPoint = {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}};
const Triangle kLine = {{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}};

TEST_F(BadMesh, WithoutAnAreaIsRefused) {
  EXPECT_EQ(refusal("points.stl", stl({kPoint, kPoint})), Code::bad_geometry) << sentence_;
  EXPECT_EQ(refusal("lines.stl", stl({kLine, kPoint})), Code::bad_geometry) << sentence_;
  EXPECT_TRUE(says(sentence_, "lines.stl"));
  EXPECT_EQ(refusal("one.stl", stl({kPoint, kFlat})), Code::ok) << sentence_;
  for (const Code code : {refusal("none.stl", stl({})), refusal("vertex.obj", "v 1 2 3\n"),
                          refusal("edge.obj", "v 1 2 3\nv 2 2 3\nl 1 2\n")}) {
    EXPECT_TRUE(code == Code::bad_geometry || code == Code::parse) << name(code);  // the parser may be first to refuse
  }
}

TEST_F(BadMesh, AnObjFileThatEndsWithinALineOrFaceIsRefused) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n# the end";
  EXPECT_EQ(refusal("a.obj", obj), Code::ok) << sentence_;
  const std::size_t face = obj.find("f 1 2 4");
  for (std::size_t size = 1; size <= face + 7; ++size) {
    const Code code = refusal("a.obj", obj.substr(0, size));
    const bool is_complete = size == face;  // all lines of this part are complete
    EXPECT_EQ(code == Code::ok, is_complete) << size << ": " << sentence_;
    if (size == face + 7) {
      EXPECT_EQ(code, Code::truncated) << sentence_;
    }
  }
  EXPECT_EQ(refusal("a.obj", obj.substr(0, face) + "f 1 2\n"), Code::parse) << sentence_;
  EXPECT_TRUE(says(sentence_, "'f 1 2' has fewer than 3 corners"));
  EXPECT_EQ(refusal("a.obj", obj.substr(0, face) + "f 1 2 \\\n 4\r\n"), Code::ok) << sentence_;
}

/// Claim: a text STL file that was cut anywhere before its last line is refused, also between two facets.
TEST_F(BadMesh, AnStlTextThatEndsBeforeItsLastLineIsRefused) {
  std::string text = "solid part\n";
  for (const char* apex : {"0 1 0", "0 0 1"}) {
    text += std::string("facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex ") + apex +
            "\nendloop\nendfacet\n";
  }
  const std::string whole = text + "endsolid part\n";
  for (const char* ending : {"endsolid part\n", "endsolid\n", "endsolid", " ENDSOLID part\r\n\n", "endsolid\n \n"}) {
    EXPECT_EQ(refusal("whole.stl", text + ending), Code::ok) << ending << sentence_;
    EXPECT_EQ(mesh_->triangles.size(), 2u);
  }
  EXPECT_EQ(refusal("facets.stl", text), Code::truncated) << sentence_;
  EXPECT_NE(sentence_.find("does not end with 'endsolid'"), std::string::npos) << sentence_;
  const std::size_t last_line = whole.find("endsolid");
  for (std::size_t length = last_line + 8; length-- > 0;) {
    const bool between_lines = length == 0 || whole[length - 1] == '\n';
    if (!between_lines && length < last_line && length % 16 != 0) continue;  // each cut takes a process
    if (refusal("cut.stl", whole.substr(0, length)) == Code::ok) ADD_FAILURE() << length << " bytes were accepted";
  }
}

TEST_F(BadMesh, ATextStlFileThatEndsTooEarlyIsRefused) {
  const std::string stl = fileText(ownData() + "/meshes/corner_ascii.stl");
  const std::size_t end = stl.find("endsolid") + 8;
  for (std::size_t size = 6; size < end; ++size) {
    ASSERT_EQ(refusalOf([&] { readStl(stl.substr(0, size)); }), Code::truncated) << size;
  }
  const std::size_t facet = stl.rfind("  facet");  // a parser would take the facets before it for the whole mesh
  EXPECT_EQ(refusal("a.stl", stl.substr(0, facet)), Code::truncated) << sentence_;
  EXPECT_EQ(refusal("a.stl", stl.substr(0, end)), Code::ok) << sentence_;
  EXPECT_EQ(refusal("a.stl", stl.substr(0, facet) + "faect" + stl.substr(facet + 7)), Code::parse) << sentence_;
  EXPECT_TRUE(says(sentence_, "it has 3 facets and 12 vertices"));
}

// The parser alone would leave out some of these faces, and read other vertices for the rest.
TEST_F(BadMesh, EveryFaceOfAnObjFileIsReadHoweverItsLinesAreWritten) {
  const std::string vertices = "v 0 0 0\n v 1 0 0\r\n\tv 0 1 0\n\x0bv 0 0 1\n";
  for (const char* faces : {"f 1 2 3\n f 1 2 4\n", "\tf 1 2 3\nf 1 2 4\r\n", "f 1 2 3\\\n\nf 1 2 4\n",
                            "\\\n f 1 2 3\nf 1 2 4\n", "f 1 2 3\rf 1 2 4\n",
                            "f\x0b"
                            "1 2 3\nf 1 2\x0c"
                            "4\n"}) {
    EXPECT_EQ(refusal("a.obj", vertices + faces), Code::ok) << faces << sentence_;
    EXPECT_EQ(mesh_->triangles.size(), 2u) << faces;
    EXPECT_EQ(mesh_->vertices.size(), 4u) << faces;
  }
  EXPECT_EQ(refusal("a.obj", "\xef\xbb\xbf" + vertices + "f 1 2 3\n"), Code::ok) << sentence_;
  for (const std::string& face : {std::string("\\\nf 1 2\n"), std::string("f 1 2\r3 4\n"),
                                  std::string("f 1\0 2 3\n", 9), std::string("f +1 +2 +3\n")}) {
    EXPECT_EQ(refusal("a.obj", vertices + "f 1 2 3\n" + face), Code::parse) << face;
  }
}

// The parser alone would leave out a face with one of the refused corners, or read other corners.
TEST_F(BadMesh, AFaceWithACornerThatIsNoneIsRefused) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\nf 1 2 4\nf 1 2 ";
  for (const char* corner : {"/3", "//1", "/1/1", "1-3", "-", "3-", "3/-", "3/1/1/1", "3///1", "--3", "3/1-1"}) {
    EXPECT_EQ(refusal("a.obj", text + corner + "\n"), Code::parse) << corner;
    EXPECT_TRUE(says(sentence_, std::string("has the corner '") + corner + "'")) << sentence_;
  }
  for (const char* corner : {"3", "-2", "3/1", "3//1", "3/1/1", "-2/-1/-1", "3/", "3//", "3/1/"}) {
    EXPECT_EQ(refusal("a.obj", text + corner + "\n"), Code::ok) << corner << sentence_;
    EXPECT_EQ(mesh_->triangles.size(), 2u) << corner;
  }
}

/// Claim: a statement that adds a surface and is not read is refused by its name, not left out.
TEST_F(BadMesh, AnObjStatementThatIsNotReadIsNamed) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const std::string patch = "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 1\nparm u 0 1\nparm v 0 1\nend\n";
  for (const std::string& part :
       {patch, patch.substr(patch.find("surf")), std::string("cstype bspline\nf 3 2 1\n"), std::string("fo 1 2 3\n"),
        std::string("call other.obj\n"), std::string("F 1 2 3\n"), std::string("bzp 1 2 3\n")}) {
    EXPECT_EQ(refusal("a.obj", text + part), Code::unsupported) << part << sentence_;
    EXPECT_TRUE(says(sentence_, "'" + part.substr(0, part.find(' ')) + "'"));
  }
  const std::string skipped =
      "g a\no b\ns off\nusemtl c\nmtllib d.mtl\nvt 0 0\nvn 0 0 1\nvp 0\nl 1 2\np 1\nlod 1\nmg 0\nbevel on\n";
  EXPECT_EQ(refusal("a.obj", text + skipped + "f 3 2 1\n"), Code::ok) << sentence_;
  EXPECT_EQ(mesh_->triangles.size(), 2u);
}

/// Claim: a weight after the coordinates does not move the vertex without a word; a color is skipped.
TEST_F(BadMesh, AnObjVertexHasThreeCoordinates) {
  for (const char* more : {"", " 1", " 1.0", " 0.5 0.5 0.5", " 1 0.5 0.5 0.5"}) {
    EXPECT_EQ(refusal("a.obj", std::string("v 0 0 0\nv 1 0 0") + more + "\nv 0 2 0\nf 1 2 3\n"), Code::ok) << sentence_;
    EXPECT_EQ(mesh_->vertices[1], Eigen::Vector3d(1, 0, 0)) << more;
  }
  for (const char* vertex : {"v 1 0", "v 1", "v 1 0 0 2", "v 1 0 0 0", "v 1 0 0 1 1", "v 1,5 0 0", "v 1 0 0x1"}) {
    EXPECT_EQ(refusal("a.obj", std::string("v 0 0 0\n") + vertex + "\nv 0 2 0\nf 1 2 3\n"), Code::parse) << vertex;
  }
}

TEST_F(BadMesh, IndicesOutOfRangeAreRefused) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const char* face : {"f 1 2 4\n", "f 1 2 99999999\n", "f -1 -2 -9\n", "f 0 1 2\n", "f 1 2 4294967297\n"}) {
    const Code code = refusal("a.obj", vertices + face);
    EXPECT_TRUE(code == Code::bad_geometry || code == Code::parse) << face << name(code) << " " << sentence_;
  }
  EXPECT_EQ(refusal("a.obj", vertices + "f -1 -2 -3\n"), Code::ok) << "negative indices count from the end";

  TriangleMesh mesh = *tetrahedron();
  for (const std::uint32_t index : {4u, 0x7fffffffu, 0xffffffffu}) {
    mesh.triangles[2] = {0, index, 1};
    std::string sentence;
    EXPECT_EQ(refusalOf([&] { checkMesh(mesh, 1e5, "the mesh"); }, &sentence), Code::bad_geometry);
    for (const std::string& word : {std::string("the mesh"), std::to_string(index), std::string("4")}) {
      EXPECT_TRUE(says(sentence, word));
    }
  }
}

TEST_F(BadMesh, InvalidVerticesAreRefused) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (int k = 0; k < 3; ++k) {
    for (const float value : {nan, inf, -inf}) {
      Triangle bad = kFlat;
      bad[1][static_cast<std::size_t>(k)] = value;
      EXPECT_EQ(refusal("a.stl", stl({kFlat, bad})), Code::nonfinite) << value << " " << sentence_;
    }
    for (const float value : {1e38f, -1e38f, 1.00001e5f}) {
      Triangle bad = kFlat;
      bad[2][static_cast<std::size_t>(k)] = value;
      EXPECT_EQ(refusal("a.stl", stl({kFlat, bad})), Code::out_of_range) << value << " " << sentence_;
    }
  }
  EXPECT_EQ(refusal("a.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n") == Code::ok, false);
}

/// Claim: the limit of coordinates is one of meters, so it counts after the scale.
TEST_F(BadMesh, AFileInMillimetersMayHoldLargeNumbers) {
  MeshLoader loader(policy_);
  Triangle hall = kFlat;
  hall[1] = {149900, 0, 0};
  const std::string uri = "file://" + folder_.write("hall.stl", stl({kFlat, hall}));
  const auto mesh = loader.load(uri, Eigen::Vector3d::Constant(0.001));
  double farthest = 0.0;
  for (const Eigen::Vector3d& vertex : mesh->vertices) farthest = std::max(farthest, vertex.x());
  EXPECT_NEAR(farthest, 149.9, 1e-9);
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { loader.load(uri, Eigen::Vector3d::Ones()); }, &sentence), Code::out_of_range);
  EXPECT_TRUE(says(sentence, "at scale 1 1 1")) << "the sentence tells that the file may be in another unit";
}

TEST_F(BadMesh, CheckMeshAppliesItsLimit) {
  TriangleMesh mesh = *tetrahedron();
  EXPECT_EQ(refusalOf([&] { checkMesh(mesh, 0.5, "m"); }), Code::ok) << "a size equal to the limit is allowed";
  EXPECT_EQ(refusalOf([&] { checkMesh(mesh, 0.49, "m"); }), Code::out_of_range);
  mesh.vertices.push_back({0, std::nan(""), 0});
  EXPECT_EQ(refusalOf([&] { checkMesh(mesh, 1, "m"); }), Code::nonfinite) << "an unused vertex must be finite, too";
  EXPECT_EQ(refusalOf([&] { checkMesh({}, 1, "m"); }), Code::bad_geometry);
}

TEST_F(BadMesh, TrianglesAreLimited) {
  policy_.max_triangles = 3;
  EXPECT_EQ(refusal("a.stl", stl({kFlat, kFlat, kFlat})), Code::ok) << sentence_;
  EXPECT_EQ(refusal("b.stl", stl({kFlat, kFlat, kFlat, kFlat})), Code::limit);
  for (const char* word : {"b.stl", "3"}) EXPECT_TRUE(says(sentence_, word));
  EXPECT_EQ(refusal("c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\nf 1 2 3\nf 1 2 3\n"), Code::limit)
      << sentence_;
}

/// Returns `count` triangles side by side, in rows of 1000.
std::vector<Triangle> square(int count) {
  std::vector<Triangle> triangles;
  triangles.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const float x = static_cast<float>(i % 1000), y = static_cast<float>(i / 1000);
    triangles.push_back({{{x, y, 0}, {x + 1, y, 0}, {x, y + 1, 0}}});
  }
  return triangles;
}

TEST_F(BadMesh, AMillionTrianglesAreTakenAndNoMore) {
  ASSERT_EQ(refusal("a.stl", stl(square(1000000))), Code::ok) << sentence_;
  EXPECT_EQ(mesh_->triangles.size(), 1000000u);
  EXPECT_EQ(refusal("b.stl", stl(square(1000001))), Code::limit) << sentence_;
}

TEST_F(BadMesh, TooMuchMemoryIsRefusedAsALimit) {  // not as a parse error, because the file is valid
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the helper does not limit its memory under a sanitizer";
#endif
  const std::string bytes = stl(square(100000));
  ASSERT_EQ(refusal("a.stl", bytes), Code::ok) << sentence_;
  EXPECT_EQ(mesh_->triangles.size(), 100000u);
  policy_.max_memory = 24u << 20;
  EXPECT_EQ(refusal("a.stl", bytes), Code::limit) << sentence_;
  EXPECT_TRUE(says(sentence_, "memory"));
}

TEST_F(BadMesh, CountsLargerThanTheFileAreRefused) {
  for (const std::uint32_t count : {2u, 1000000u, 0x7fffffffu, 0xffffffffu}) {
    EXPECT_NE(refusal("a.stl", stl({kFlat}, count)), Code::ok) << count;
  }
}

TEST_F(BadMesh, ScalesThatMakeNoMeshAreRefused) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  const std::string solid = fileText(ownData() + "/meshes/corner.stl");
  for (int k = 0; k < 3; ++k) {
    for (const double factor : {0.0, -0.0, 1e-30, -1e-30, nan, inf, -inf}) {
      Eigen::Vector3d scale(1, 1, 1);
      scale[k] = factor;
      const Code code = refusal("a.stl", solid, scale);
      EXPECT_TRUE(code == Code::bad_geometry || (!std::isfinite(factor) && code == Code::nonfinite)) << factor;
      EXPECT_TRUE(says(sentence_, "scale"));
    }
  }
  EXPECT_EQ(refusal("a.stl", solid, {1e7, 1, 1}), Code::out_of_range) << sentence_;
}

TEST_F(BadMesh, OtherKindsOfFileAreUnsupported) {
  const std::string solid = fileText(ownData() + "/meshes/corner.stl");
  for (const char* name : {"a.ply", "a.fbx", "a.blend", "a.gltf", "a.PLY", "stl", "a.", "a.stl.gz", "a.stl/b"}) {
    EXPECT_EQ(refusal(name, solid), Code::unsupported) << name;
    EXPECT_TRUE(says(sentence_, name));
  }
}

TEST_F(BadMesh, ContentOfAnotherKindIsRefused) {
  const std::string zip = std::string("PK\x03\x04\x14\x00\x00\x00\x08\x00", 10) + std::string(200, '\x5a');
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 0\nend_header\n";
  for (const char* name : {"a.stl", "a.obj", "a.dae"}) {
    for (const std::string& bytes : {zip, ply, std::string(), std::string(1, 'x'), std::string(1000, '\0')}) {
      const Code code = refusal(name, bytes);
      EXPECT_TRUE(code == Code::parse || code == Code::bad_geometry || code == Code::truncated ||
                  code == Code::unsupported)
          << name << " " << hgrid::name(code) << " " << sentence_;
    }
  }
}

TEST_F(BadMesh, ADamagedFileIsAValidMeshOrARefusal) {
  int read_anyway = 0;
  for (const char* file : {"corner.stl", "corner_ascii.stl", "corner.obj", "corner.dae"}) {
    const std::string whole = fileText(ownData() + "/meshes/" + file);
    for (int seed = 0; seed < 60; ++seed) {
      Random random(static_cast<std::uint64_t>(seed));
      const std::string harmed = mutated(whole, {"nan", "inf", "1e308", "-1", "99999999", "<", ">", "/"}, random);
      const Code code = refusal(file, harmed);
      ASSERT_NE(code, Code::budget) << file << ", seed " << seed << ": " << sentence_;
      if (code != Code::ok) continue;
      ++read_anyway;
      EXPECT_EQ(refusalOf([&] { checkMesh(*mesh_, ShapeLimits().max_size, "it"); }), Code::ok)
          << file << ", seed " << seed;
    }
  }
  EXPECT_GT(read_anyway, 20);
}

TEST_F(BadMesh, TheSeedsOfTheFuzzersAreReadCorrectly) {
  expectNoFlawInSeeds("mesh", fuzzMesh);
  expectNoFlawInSeeds("obj", fuzzObj);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
