// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/enclosure.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace hgrid {
namespace {

using Index = std::uint32_t;

/// Returns a number for each vertex. Vertices at the same position get the same number, since many files repeat a
/// vertex for every triangle that uses it.
std::vector<Index> weldedNumbers(const std::vector<Eigen::Vector3d>& vertices) {
  std::vector<Index> order(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto before = [&](Index i, Index j) {
    return std::lexicographical_compare(vertices[i].data(), vertices[i].data() + 3, vertices[j].data(),
                                        vertices[j].data() + 3);
  };
  std::sort(order.begin(), order.end(), before);
  std::vector<Index> numbers(vertices.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && vertices[order[k]] == vertices[order[k - 1]];
    numbers[order[k]] = same ? numbers[order[k - 1]] : order[k];
  }
  return numbers;
}

/// Returns the triangles of a mesh with the numbers of weldedNumbers(). Leaves out triangles with two equal corners,
/// since they are lines, which enclose nothing.
std::vector<WindingTree::Corners> weldedTriangles(const TriangleMesh& mesh) {
  const std::vector<Index> numbers = weldedNumbers(mesh.vertices);
  std::vector<WindingTree::Corners> triangles;
  for (const auto& given : mesh.triangles) {
    const WindingTree::Corners t{numbers[given[0]], numbers[given[1]], numbers[given[2]]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
  return triangles;
}

/// Returns the root of `i` in a union-find forest, and shortens the path to it.
Index rootOf(std::vector<Index>& parent, Index i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

Enclosure::Enclosure(const TriangleMesh& mesh) : Enclosure(mesh, weldedTriangles(mesh)) {}

Enclosure::Enclosure(const TriangleMesh& mesh, const std::vector<WindingTree::Corners>& triangles)
    : winding_(mesh.vertices, triangles) {
  std::vector<Index> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (const auto& t : triangles) {
    const Index root = rootOf(parent, t[0]);
    parent[rootOf(parent, t[1])] = root;
    parent[rootOf(parent, t[2])] = root;
  }
  std::vector<std::size_t> part_of(parent.size(), parts_.max_size());
  for (const auto& triangle : triangles) {
    const Index root = rootOf(parent, triangle[0]);
    if (part_of[root] == parts_.max_size()) {
      part_of[root] = parts_.size();
      parts_.emplace_back();
      parts_.back().fill(mesh.vertices[root]);
    }
    Part& part = parts_[part_of[root]];
    for (const Index i : triangle) {
      const Eigen::Vector3d& vertex = mesh.vertices[i];
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const auto least = static_cast<std::size_t>(axis), most = least + 3;
        if (vertex[axis] < part[least][axis]) part[least] = vertex;
        if (vertex[axis] > part[most][axis]) part[most] = vertex;
      }
    }
  }
}

}  // namespace hgrid
