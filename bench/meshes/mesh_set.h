// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hgrid_proximity/geometry/shape.h"

namespace hgrid {
namespace bench {

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

/// Two meshes whose distance is measured.
struct MeshPair {
  NamedMesh first, second;
};

/// Returns pairs of generated meshes of about 20,000 triangles each: a sphere, a torus and rough terrain.
std::vector<MeshPair> generatedPairs();

/// Returns pairs of links of PR2 and UR5. Their files are in the folder HGRID_TEST_DATA or, if that is not set, in
/// ../shared/data beside the project. Returns nothing if there are no such files.
std::vector<MeshPair> robotPairs();

/// Reads a binary STL file. Equal corners become one vertex. @throws std::runtime_error if it is not such a file
TriangleMesh stlMesh(const std::filesystem::path& path);

/// Returns a sphere of radius 0.5 m of about this number of triangles.
TriangleMesh sphereOf(std::size_t triangles);

}  // namespace bench
}  // namespace hgrid
