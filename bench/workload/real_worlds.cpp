// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/workload/real_worlds.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "bench/workload/random.h"

namespace hgrid {
namespace bench {
namespace {

namespace fs = std::filesystem;

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!(text << in.rdbuf())) throw std::runtime_error(file.string() + " cannot be read");
  return text.str();
}

Aabb shifted(const Aabb& box, Random& random) {
  const double size = double((box.max - box.min).maxCoeff());
  Eigen::Vector3f shift;
  for (int axis = 0; axis < 3; ++axis) shift[axis] = static_cast<float>(size * random.uniform(-0.05, 0.05));
  return {box.min + shift, box.max + shift};
}

RealWorld gameWorld(const fs::path& file) {
  RealWorld world;
  world.name = file.stem().string();
  std::istringstream in(contents(file));
  Random random(1);
  for (Aabb box; in >> box.min.x() >> box.min.y() >> box.min.z() >> box.max.x() >> box.max.y() >> box.max.z();) {
    world.boxes.push_back(box);
    world.before.push_back(shifted(box, random));
  }
  if (world.boxes.empty() || !in.eof()) throw std::runtime_error(file.string() + " does not hold six numbers a line");
  return world;
}

using Element = std::vector<std::uint32_t>;  // indices of vertices

struct Mesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Element> faces;
};

/// Reads a binary PLY file that holds nothing but vertices of three doubles, and triangles.
Mesh meshOf(const fs::path& file) {
  const std::string text = contents(file);
  const std::string end = "end_header\n";
  const std::size_t header = text.find(end);
  std::size_t vertices = 0, faces = 0;
  std::istringstream in(text.substr(0, header));
  for (std::string word; in >> word;) {
    if (word != "element") continue;
    in >> word;
    in >> (word == "vertex" ? vertices : faces);
  }
  const std::size_t vertex_bytes = 3 * sizeof(double), face_bytes = 1 + 3 * sizeof(std::uint32_t);
  if (header == std::string::npos ||
      text.size() != header + end.size() + vertices * vertex_bytes + faces * face_bytes) {
    throw std::runtime_error(file.string() + " is not a binary PLY file of vertices of doubles, and triangles");
  }
  const char* data = text.data() + header + end.size();
  Mesh mesh;
  mesh.vertices.resize(vertices);
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    std::memcpy(vertex.data(), data, vertex_bytes);
    data += vertex_bytes;
  }
  mesh.faces.assign(faces, Element(3));
  for (Element& face : mesh.faces) {
    std::memcpy(face.data(), data + 1, face_bytes - 1);
    data += face_bytes;
  }
  return mesh;
}

/// Returns the vertices, then the edges (larger vertex first, sorted), then the faces.
std::vector<Element> elementsOf(const Mesh& mesh) {
  std::vector<Element> edges;
  for (const Element& face : mesh.faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = face.at(i), b = face.at((i + 1) % 3);
      edges.push_back({std::max(a, b), std::min(a, b)});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<Element> elements;
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) elements.push_back({i});
  elements.insert(elements.end(), edges.begin(), edges.end());
  elements.insert(elements.end(), mesh.faces.begin(), mesh.faces.end());
  return elements;
}

/// Returns the smallest box of floats around these vertices of all meshes.
Aabb boxAround(const Element& element, const std::vector<const Mesh*>& meshes) {
  Eigen::AlignedBox3d exact;
  for (const Mesh* mesh : meshes) {
    for (const std::uint32_t vertex : element) exact.extend(mesh->vertices.at(vertex));
  }
  Aabb box{exact.min().cast<float>(), exact.max().cast<float>()};
  const float infinity = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (double(box.min[axis]) > exact.min()[axis]) box.min[axis] = std::nextafter(box.min[axis], -infinity);
    if (double(box.max[axis]) < exact.max()[axis]) box.max[axis] = std::nextafter(box.max[axis], infinity);
  }
  return box;
}

/// Reads pairs of numbers; everything else separates them.
void readPairs(const fs::path& file, std::vector<ProxyPair>& pairs) {
  std::string text = contents(file);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < '0' || c > '9'; }, ' ');
  std::istringstream in(text);
  for (ProxyId a, b; in >> a >> b;) pairs.push_back({std::min(a, b), std::max(a, b)});
}

RealWorld meshWorld(const fs::path& folder) {
  std::vector<fs::path> frames;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".ply") frames.push_back(entry.path());
  }
  std::sort(frames.begin(), frames.end());
  if (frames.size() != 2) throw std::runtime_error(folder.string() + " does not hold two PLY files");
  const Mesh first = meshOf(frames[0]), second = meshOf(frames[1]);
  RealWorld world;
  world.name = folder.filename().string();
  for (const Element& element : elementsOf(first)) {
    world.before.push_back(boxAround(element, {&second}));
    world.boxes.push_back(boxAround(element, {&first, &second}));
  }
  for (const char* kind : {"ee.json", "vf.json"}) {
    readPairs(folder / (frames[0].stem().string() + kind), world.required);
  }
  return world;
}

}  // namespace

std::vector<RealWorld> realWorlds(const std::string& folder) {
  std::vector<fs::path> games, meshes;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".txt") games.push_back(entry.path());
  }
  if (fs::is_directory(fs::path(folder) / "mesh_in_motion")) {
    for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(folder) / "mesh_in_motion"))
      meshes.push_back(entry.path());
  }
  std::sort(games.begin(), games.end());
  std::sort(meshes.begin(), meshes.end());
  std::vector<RealWorld> worlds;
  for (const fs::path& file : games) worlds.push_back(gameWorld(file));
  for (const fs::path& path : meshes) worlds.push_back(meshWorld(path));
  return worlds;
}

}  // namespace bench
}  // namespace hgrid
