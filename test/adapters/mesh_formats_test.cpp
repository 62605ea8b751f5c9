// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The files corner.* in test/data/meshes contain the same solid. The loader must return this solid for each of them.
// The coordinates must be equal bit by bit if the file stores them exactly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test/adapters/temporary_folder.h"
#include "test/adapters/urdf_texts.h"
#include "test/support/refusals.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

using Corners = std::array<std::array<double, 3>, 3>;

/// Returns the corners of all triangles, sorted. The least corner of each triangle comes first.
std::vector<Corners> trianglesOf(const TriangleMesh& mesh) {
  std::vector<Corners> all;
  for (const auto& triangle : mesh.triangles) {
    Corners corners;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d& v = mesh.vertices.at(triangle[i]);
      corners[i] = {v.x() + 0.0, v.y() + 0.0, v.z() + 0.0};  // adding 0 turns -0 into 0
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    all.push_back(corners);
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// Returns the volume [m^3] of a closed mesh, positive if its triangles face outward.
double signedVolume(const TriangleMesh& mesh) {
  double volume = 0;
  for (const auto& t : mesh.triangles) {
    volume += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])) / 6;
  }
  return volume;
}

const double kVolume = 0.5 * 0.25 * 0.125 / 6;
const std::vector<std::string> kFiles = {"corner.stl", "corner_ascii.stl", "corner.obj", "corner.dae"};

class MeshFormats : public ::testing::Test {
 protected:
  std::shared_ptr<const TriangleMesh> load(const std::string& file, const Eigen::Vector3d& scale = {1, 1, 1}) {
    return loader_.load("package://hgrid_test/meshes/" + file, scale);
  }
  MeshLoader loader_{meshPolicy()};
};

TEST_F(MeshFormats, EveryFileShowsTheSameSolid) {
  for (const char* file : {"corner.stl", "corner_ascii.stl", "corner.obj"}) {
    EXPECT_EQ(trianglesOf(*load(file)), trianglesOf(*tetrahedron())) << file;
  }
}

/// Reads corner.dae with a new loader, after replacing `part` of its text with `instead`.
std::shared_ptr<const TriangleMesh> loadCollada(const std::string& part, const std::string& instead) {
  std::string text = fileText(ownData() + "/meshes/corner.dae");
  text.replace(text.find(part), part.size(), instead);
  TemporaryFolder folder;
  MeshPolicy policy = meshPolicy();
  policy.resources.file_roots = {folder.path()};
  return MeshLoader(policy).load("file://" + folder.write("corner.dae", text), {1, 1, 1});
}

TEST_F(MeshFormats, ColladaCountsUnitsAndNodesButNotTheUpAxis) {  // like RViz
  const auto expected = tetrahedron();
  for (const char* up : {"Y_UP", "Z_UP", "X_UP"}) {
    SCOPED_TRACE(up);
    const auto mesh = loadCollada("Y_UP", up);
    ASSERT_EQ(mesh->triangles.size(), 4u);
    EXPECT_NEAR(signedVolume(*mesh), kVolume, 1e-6 * kVolume);
    for (const Eigen::Vector3d& corner : expected->vertices) {
      double nearest = 1e9;
      for (const Eigen::Vector3d& v : mesh->vertices) nearest = std::min(nearest, (v - corner).norm());
      EXPECT_LT(nearest, 1e-7) << corner.transpose();
    }
  }
}

TEST_F(MeshFormats, ColladaWithoutAUnitIsInMeters) {
  const auto mesh = loadCollada("<unit name=\"centimeter\" meter=\"0.01\"/>", "");
  EXPECT_NEAR(signedVolume(*mesh), 1e6 * kVolume, kVolume);
}

TEST_F(MeshFormats, AMirroringNodeKeepsTheTrianglesOutward) {
  const auto mesh = loadCollada("<scale>2 2 2</scale>", "<scale>2 -2 2</scale>");
  EXPECT_NEAR(signedVolume(*mesh), kVolume, 1e-6 * kVolume);
}

TEST_F(MeshFormats, FacesOfFourCornersBecomeTriangles) {
  const auto mesh = load("wedge.obj");
  EXPECT_EQ(mesh->triangles.size(), 8u);
  EXPECT_NEAR(signedVolume(*mesh), 0.25 * 0.5 / 2, 1e-12);
}

TEST_F(MeshFormats, ScaleMultipliesEachCoordinate) {
  for (const std::string& file : kFiles) {
    const Eigen::Vector3d scale(2, 0.5, 4);
    const auto plain = load(file), scaled = load(file, scale);
    ASSERT_EQ(plain->vertices.size(), scaled->vertices.size()) << file;
    for (std::size_t i = 0; i < plain->vertices.size(); ++i) {
      EXPECT_EQ(scaled->vertices[i], plain->vertices[i].cwiseProduct(scale)) << file;
    }
    EXPECT_EQ(scaled->triangles, plain->triangles) << file;
    EXPECT_NEAR(signedVolume(*scaled), 4 * kVolume, 1e-6 * kVolume) << file;
  }
}

TEST_F(MeshFormats, AMirroringScaleKeepsTheTrianglesOutward) {
  for (const std::string& file : kFiles) {
    for (const Eigen::Vector3d& scale :
         {Eigen::Vector3d(-1, 1, 1), Eigen::Vector3d(1, -1, 1), Eigen::Vector3d(1, 1, -1), Eigen::Vector3d(-1, -1, 1),
          Eigen::Vector3d(-1, -1, -1)}) {
      const auto mesh = load(file, scale);
      EXPECT_NEAR(signedVolume(*mesh), kVolume, 1e-6 * kVolume) << file << ", scale " << scale.transpose();
    }
    const auto plain = load(file), mirrored = load(file, {-1, 1, 1});
    for (std::size_t i = 0; i < plain->vertices.size(); ++i) {
      EXPECT_EQ(mirrored->vertices[i], plain->vertices[i].cwiseProduct(Eigen::Vector3d(-1, 1, 1))) << file;
    }
  }
}

TEST_F(MeshFormats, FileExtensionsMayBeUpperCase) {
  TemporaryFolder folder;
  MeshPolicy policy = meshPolicy();
  policy.resources.file_roots = {folder.path()};
  MeshLoader loader(policy);
  const auto same = [&](const std::string& name, const std::string& bytes) {
    folder.write(name, bytes);
    EXPECT_EQ(trianglesOf(*loader.load("file://" + folder / name, {1, 1, 1})), trianglesOf(*tetrahedron())) << name;
  };
  std::string binary = fileText(ownData() + "/meshes/corner.stl");
  same("A.STL", binary);
  same("a.b.Stl", binary);
  same("A.OBJ", fileText(ownData() + "/meshes/corner.obj"));
  binary.replace(0, 5, "solid");
  same("solid.stl", binary);  // a binary file whose first bytes are like those of a text file
}

TEST_F(MeshFormats, AFileIsReadOnceForEachLoader) {
  TemporaryFolder folder;
  const std::string path = folder.write("a.stl", fileText(ownData() + "/meshes/corner.stl"));
  std::filesystem::create_symlink(path, folder / "b.stl");
  MeshPolicy policy = meshPolicy();
  policy.resources.file_roots = {folder.path()};
  policy.reader = folder / "reader";
  std::filesystem::create_symlink(HGRID_MESH_READER, policy.reader);
  MeshLoader loader(policy);
  loader.load("file://" + path, {1, 1, 1});
  std::filesystem::remove(policy.reader);
  EXPECT_EQ(trianglesOf(*loader.load("file://" + path, {1, 1, 1})), trianglesOf(*tetrahedron()));
  EXPECT_EQ(trianglesOf(*loader.load("file://" + path, {1, 2, 1})), trianglesOf(*tetrahedron({1, 2, 1})));
  EXPECT_EQ(trianglesOf(*loader.load("file://" + folder / "b.stl", {1, 1, 1})), trianglesOf(*tetrahedron()))
      << "a link to the same file must not be read again";
  MeshLoader another(policy);
  EXPECT_NE(refusalOf([&] { another.load("file://" + path, {1, 1, 1}); }), Code::ok) << "its reader was removed";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
