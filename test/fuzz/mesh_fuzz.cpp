// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "hgrid_proximity/adapters/mesh.h"
#include "test/adapters/temporary_folder.h"
#include "test/fuzz/obj_oracle.h"
#include "test/fuzz/targets.h"
#include "test/support/sentences.h"

namespace hgrid {
namespace test {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostTriangles = 200;

/// Returns the ids of all child processes of the calling thread. libFuzzer may have a child of its own, which finds the
/// names of functions for its messages.
std::string children() {
  std::ifstream file("/proc/thread-self/children");
  std::string ids;
  std::getline(file, ids);
  return ids;
}

std::ptrdiff_t openFiles() { return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator()); }

/// Returns what is wrong with a mesh that was read; empty if nothing is wrong. Does not use the product's check.
std::string flawOfMesh(const TriangleMesh& mesh) {
  if (mesh.triangles.empty() || mesh.triangles.size() > kMostTriangles) return "the number of triangles is wrong";
  if (mesh.vertices.size() > 3 * kMostTriangles) return "there are too many vertices";
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    if (!vertex.allFinite() || vertex.cwiseAbs().maxCoeff() > ShapeLimits().max_size) return "a vertex is too far away";
  }
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) {
      if (index >= mesh.vertices.size()) return "an index is out of range";
    }
  }
  return {};
}

/// Returns the number of faces of an OBJ file. Returns 0 if a face does not have 3 corners, because the number of
/// triangles is then not the number of faces.
std::size_t facesOfObj(std::string_view file) {
  std::size_t faces = 0;
  for (const std::vector<std::string>& words : wordsOfObj(file)) {
    if (words.empty() || words[0] != "f") continue;
    if (words.size() != 4) return 0;
    ++faces;
  }
  return faces;
}

/// Returns the number of triangles that a binary STL file declares, or of the facets of a text STL file.
std::size_t facetsOfStl(std::string_view file) {
  std::uint32_t declared = 0;
  if (file.size() >= 84) std::memcpy(&declared, file.data() + 80, 4);
  if (file.size() == 84 + std::size_t{50} * declared) return declared;
  std::istringstream lines{std::string(file)};
  std::size_t facets = 0;
  for (std::string line, word; std::getline(lines, line);) {
    std::istringstream words(line);
    facets += words >> word && word == "facet" ? 1 : 0;
  }
  return facets;
}

MeshPolicy policyFor(const TemporaryFolder& folder) {
  MeshPolicy policy;
  policy.reader = HGRID_MESH_READER;
  policy.resources.file_roots = {folder.path()};
  policy.max_triangles = kMostTriangles;
  policy.timeout = std::chrono::seconds(5);
  policy.max_memory = 256u << 20;
  return policy;
}

}  // namespace

FuzzResult fuzzMesh(std::string_view input) {
  static const TemporaryFolder folder;
  if (input.empty()) return {};
  const char* const extension = input[0] == 's' ? "stl" : input[0] == 'o' ? "obj" : "dae";
  const std::string path = folder.write(std::string("a.") + extension, std::string(input.substr(1)));
  const std::ptrdiff_t open_before = openFiles();
  const std::string children_before = children();
  FuzzResult result;
  try {
    MeshLoader loader(policyFor(folder));
    const auto mesh = loader.load("file://" + path, Eigen::Vector3d::Ones());
    result = {true, flawOfMesh(*mesh)};
    const std::string_view file = input.substr(1);
    const std::size_t least = input[0] == 's' ? facetsOfStl(file) : input[0] == 'o' ? facesOfObj(file) : 0;
    if (mesh->triangles.size() < least) result.flaw = "triangles are missing";
  } catch (const Refusal& refusal) {
    result = {false, flawOfRefusal(refusal)};
  }
  if (openFiles() != open_before) result.flaw = "a file stays open";
  if (children() != children_before) result.flaw = "the helper process still exists";
  return result;
}

}  // namespace test
}  // namespace hgrid
