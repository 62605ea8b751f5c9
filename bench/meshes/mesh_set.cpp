// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/meshes/mesh_set.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <stdexcept>

#include "bench/workload/random.h"

namespace hgrid {
namespace bench {
namespace {

using Vector = Eigen::Vector3d;
using Surface = std::function<Vector(double, double)>;

/// Returns the points of a surface over 0 .. 1 squared as a mesh of u * v cells, two triangles each.
/// @param u_closed  whether the surface continues from u = 1 to u = 0
TriangleMesh meshOf(std::uint32_t u, std::uint32_t v, bool u_closed, bool v_closed, const Surface& surface) {
  const std::uint32_t rows = u_closed ? u : u + 1, columns = v_closed ? v : v + 1;
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < rows; ++i) {
    for (std::uint32_t j = 0; j < columns; ++j) mesh.vertices.push_back(surface(double(i) / u, double(j) / v));
  }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return i % rows * columns + j % columns; };
  for (std::uint32_t i = 0; i < u; ++i) {
    for (std::uint32_t j = 0; j < v; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

TriangleMesh torus() {
  return meshOf(140, 70, true, true, [](double u, double v) {
    const double around = 2 * M_PI * u, across = 2 * M_PI * v, radius = 0.4 + 0.1 * std::cos(across);
    return Vector(radius * std::cos(around), radius * std::sin(around), 0.1 * std::sin(across));
  });
}

TriangleMesh terrain() {
  Random random(5);
  return meshOf(100, 100, false, false, [&](double u, double v) {
    return Vector(2 * u - 1, 2 * v - 1, 0.1 * std::sin(9 * u) * std::cos(7 * v) + random.uniform(0, 0.01));
  });
}

}  // namespace

TriangleMesh stlMesh(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
  std::uint32_t count = 0;
  if (bytes.size() >= 84) std::memcpy(&count, &bytes[80], sizeof(count));
  if (count == 0 || bytes.size() != 84 + 50 * std::size_t{count}) {
    throw std::runtime_error(path.string() + " is not a binary STL file; replace it by the original file");
  }
  TriangleMesh mesh;
  std::map<std::array<float, 3>, std::uint32_t> numbers;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<std::array<float, 3>, 3> corners;
    std::memcpy(corners.data(), &bytes[84 + 50 * i + 12], sizeof(corners));  // behind the normal
    mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& [x, y, z] = corners[k];
      const auto [known, is_new] = numbers.emplace(corners[k], std::uint32_t(mesh.vertices.size()));
      if (is_new) mesh.vertices.emplace_back(x, y, z);
      mesh.triangles.back()[k] = known->second;
    }
  }
  return mesh;
}

TriangleMesh sphereOf(std::size_t triangles) {
  const auto rows = static_cast<std::uint32_t>(std::sqrt(0.5 * double(triangles)));
  return meshOf(rows, rows, true, false, [](double u, double v) {
    const double around = 2 * M_PI * u, down = M_PI * v, radius = 0.5 * std::sin(down);
    return Vector(radius * std::cos(around), radius * std::sin(around), 0.5 * std::cos(down));
  });
}

std::vector<MeshPair> generatedPairs() {
  const std::vector<NamedMesh> meshes{{"sphere", sphereOf(20000)}, {"torus", torus()}, {"terrain", terrain()}};
  std::vector<MeshPair> pairs;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    for (std::size_t j = i; j < meshes.size(); ++j) pairs.push_back({meshes[i], meshes[j]});
  }
  return pairs;
}

std::vector<MeshPair> robotPairs() {
  const char* told = std::getenv("HGRID_TEST_DATA");
  const std::filesystem::path data = told ? told : HGRID_PROJECT_DIR "/../shared/data",
                              robots = data / "example-robot-data" / "robots",
                              pr2 = robots / "pr2_description" / "meshes",
                              ur5 = robots / "ur_description" / "meshes" / "ur5" / "collision";
  if (!std::filesystem::exists(pr2) || !std::filesystem::exists(ur5)) return {};
  const NamedMesh torso{"PR2 torso", stlMesh(pr2 / "torso_v0" / "torso.stl")},
      base{"PR2 base", stlMesh(pr2 / "base_v0" / "base.stl")},
      upper_arm{"PR2 upper arm", stlMesh(pr2 / "upper_arm_v0" / "upper_arm.stl")},
      forearm{"PR2 forearm", stlMesh(pr2 / "forearm_v0" / "forearm.stl")},
      head{"PR2 head", stlMesh(pr2 / "head_v0" / "head_tilt.stl")},
      ur5_upper_arm{"UR5 upper arm", stlMesh(ur5 / "upperarm.stl")},
      ur5_forearm{"UR5 forearm", stlMesh(ur5 / "forearm.stl")};
  return {{torso, forearm},     {base, upper_arm},   {upper_arm, forearm},
          {forearm, forearm},   {head, ur5_forearm}, {ur5_upper_arm, ur5_forearm},
          {base, ur5_upper_arm}};
}

}  // namespace bench
}  // namespace hgrid
