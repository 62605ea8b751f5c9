// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/support/solids.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace hgrid {
namespace test {
namespace {

/// Returns three random dimensions [m] within the proportions. Any of them may be the longest.
Eigen::Vector3d randomSize(Random& random, const Proportions& proportions) {
  const double longest = random.logUniform(proportions.smallest, proportions.largest);
  Eigen::Vector3d size;
  for (int i = 0; i < 3; ++i) size[i] = longest / random.logUniform(1.0, proportions.max_aspect);
  size[random.below(3)] = longest;
  return size;
}

TriangleMesh points(Random& random, const Eigen::Vector3d& size, int count) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    Eigen::Vector3d point;
    for (int k = 0; k < 3; ++k) point[k] = size[k] * random.uniform(-0.5, 0.5);
    mesh.vertices.push_back(point);
  }
  return mesh;
}

}  // namespace

TriangleMesh trayMesh(const Eigen::Vector3d& size, double wall) {
  TriangleMesh mesh;
  const Eigen::Vector3d half = 0.5 * size;
  // Four rings of four corners: the lower and upper edges of the outside, then those of the inside.
  const double rings[][2] = {{0.0, -half[2]}, {0.0, half[2]}, {wall, -half[2] + wall}, {wall, half[2]}};
  for (const auto& [inset, z] : rings) {
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      mesh.vertices.emplace_back(x * (half[0] - inset), y * (half[1] - inset), z);
    }
  }
  const auto add = [&mesh](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  add(3, 2, 1, 0);    // the bottom, seen from below
  add(8, 9, 10, 11);  // the floor, seen from above
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t k = (i + 1) % 4;
    add(i, k, 4 + k, 4 + i);            // a wall from outside
    add(12 + i, 12 + k, 8 + k, 8 + i);  // and from inside
    add(4 + i, 4 + k, 12 + k, 12 + i);  // the rim
  }
  return mesh;
}

TriangleMesh boxMesh(const Eigen::Vector3d& size) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d side(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
    mesh.vertices.push_back(side.cwiseProduct(size));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TriangleMesh ballMesh(int divisions) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex.normalize();
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int division = 0; division < divisions; ++division) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [it, is_new] = middles.insert({std::minmax(a, b), std::uint32_t(mesh.vertices.size())});
      if (is_new) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
      return it->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = finer;
  }
  return mesh;
}

TriangleMesh lumpMesh(Random& random, const Eigen::Vector3d& size) {
  TriangleMesh mesh = ballMesh(random.below(2));
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex = vertex.cwiseProduct(0.5 * size) * random.uniform(0.5, 1.0);
  }
  return mesh;
}

TriangleMesh unwelded(const TriangleMesh& mesh) {
  TriangleMesh result;
  for (const auto& triangle : mesh.triangles) {
    const auto first = std::uint32_t(result.vertices.size());
    for (const std::uint32_t index : triangle) result.vertices.push_back(mesh.vertices[index]);
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

TriangleMesh twoSided(const TriangleMesh& mesh) {
  TriangleMesh result = mesh;
  for (const auto& [a, b, c] : mesh.triangles) result.triangles.push_back({a, c, b});
  return result;
}

TriangleMesh disordered(Random& random, const TriangleMesh& mesh) {
  const double turned = random.chance(0.3) ? 0.0 : random.uniform(0, 1), twice = random.uniform(0, 1);
  TriangleMesh result{mesh.vertices, {}};
  for (const auto& [a, b, c] : mesh.triangles) {
    const int times = random.chance(twice) ? random.between(2, 3) : 1;
    for (int i = 0; i < times; ++i) {
      result.triangles.push_back({a, b, c});
      if (random.chance(turned)) std::swap(result.triangles.back()[1], result.triangles.back()[2]);
    }
  }
  for (std::size_t i = result.triangles.size(); i > 1; --i) {
    std::swap(result.triangles[i - 1], result.triangles[std::size_t(random.below(int(i)))]);
  }
  return result;
}

TriangleMesh joined(TriangleMesh mesh, const TriangleMesh& other) {
  const auto first = std::uint32_t(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
  return mesh;
}

TriangleMesh moved(TriangleMesh mesh, const Eigen::Vector3d& by) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex += by;
  return mesh;
}

TriangleMesh without(TriangleMesh mesh, std::size_t triangle) {
  mesh.triangles.erase(mesh.triangles.begin() + std::ptrdiff_t(triangle));
  return mesh;
}

Shape meshOf(TriangleMesh mesh) { return Shape::mesh(std::make_shared<TriangleMesh>(std::move(mesh))); }

Shape randomSolid(Random& random, ShapeKind kind, const Proportions& proportions) {
  const Eigen::Vector3d size = randomSize(random, proportions);
  switch (kind) {
    case ShapeKind::sphere:
      return Shape::sphere(0.5 * size.maxCoeff());
    case ShapeKind::box:
      return Shape::box(size);
    case ShapeKind::cylinder:
      return Shape::cylinder(size[0], 0.5 * size[1]);
    case ShapeKind::cone:
      return Shape::cone(size[0], 0.5 * size[1]);
    case ShapeKind::capsule:
      return Shape::capsule(size[0], 0.5 * size[1]);
    case ShapeKind::hull:
      return Shape::hull(std::make_shared<TriangleMesh>(points(random, size, random.between(4, 30))));
    case ShapeKind::mesh:
    case ShapeKind::plane:
      break;
  }
  TriangleMesh mesh = random.chance(0.3) ? boxMesh(size) : lumpMesh(random, size);
  return meshOf(random.chance(0.5) ? unwelded(mesh) : mesh);
}

}  // namespace test
}  // namespace hgrid
