// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/enclosure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "geometry/rotation.h"

namespace hgrid {
namespace {

using Index = std::uint32_t;

constexpr double kMaybeInside = 0.25;  // an open mesh may enclose a point with at least this winding number
// A closed mesh winds around a point 0 times or a whole number of times, so rounding cannot matter at one half.
constexpr double kInsideOnce = 0.5, kInsideTwice = 1.5;
constexpr int kLines = 64;      // that are followed from a point
constexpr int kLinesOut = 8;    // if so many of them lead out, the point is not walled in
constexpr int kDoubtful = 24;   // if so many of them contradict, the directions of an open mesh are wrong around there
constexpr double kThin = 1e-5;  // walls that are thinner than this share of the size of the mesh are only surfaces

/// Returns unit vectors that are spread evenly, on a spiral. They lie in no plane of symmetry of usual meshes. Those
/// that follow each other are far apart.
std::vector<Eigen::Vector3d> directions() {
  std::vector<Eigen::Vector3d> result;
  for (int k = 0; k < kLines; ++k) {
    const int i = 27 * k % kLines;
    const double z = 1.0 - (2.0 * i + 1.0) / kLines, around = i * M_PI * (3.0 - std::sqrt(5.0)) + 0.1;
    const double radius = std::sqrt(1.0 - z * z);
    result.emplace_back(radius * cosine(around), radius * sine(around), z);
  }
  return result;
}

/// Returns a number for each vertex. Vertices at the same position get the same number.
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

/// Returns the root of `i` in a union-find forest, and shortens the path to it.
Index rootOf(std::vector<Index>& parent, Index i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

std::vector<WindingTree::Corners> weldedTriangles(const TriangleMesh& mesh) {
  const std::vector<Index> numbers = weldedNumbers(mesh.vertices);
  std::vector<WindingTree::Corners> triangles;
  for (const auto& given : mesh.triangles) {
    const WindingTree::Corners t{numbers[given[0]], numbers[given[1]], numbers[given[2]]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
  return triangles;
}

Enclosure::Enclosure(const TriangleMesh& mesh) : Enclosure(mesh, weldedTriangles(mesh)) {}

Enclosure::Enclosure(const TriangleMesh& mesh, const std::vector<WindingTree::Corners>& triangles) {
  for (const auto& triangle : triangles) {
    for (const Index i : triangle) box_.extend(mesh.vertices[i]);
  }
  FaceDirections faces = faceDirections(mesh.vertices, triangles);
  corrected_ = !faces.corrected.empty();
  for (auto* surface : {&faces.given, &faces.corrected}) {
    if (!surface->empty()) surfaces_.emplace_back(mesh.vertices, std::move(*surface));
  }
  const auto isClosed = [](const WindingTree& surface) { return surface.closed(); };
  closed_ = !surfaces_.empty() && std::all_of(surfaces_.begin(), surfaces_.end(), isClosed);
  simple_ = closed_ && faces.simple;
  findParts(mesh.vertices, triangles);
}

Inside Enclosure::holds(const Eigen::Vector3d& point) const {
  if (!boxHolds(point)) return Inside::no;
  double winding = 0.0;  // how often the surfaces wind around the point, in whatever direction
  for (const WindingTree& surface : surfaces_) winding += std::abs(surface.windingNumber(point));
  if (winding >= (closed_ ? kInsideOnce : kMaybeInside)) {
    // Of two surfaces around each other, the inner one may be a cavity, if its direction had to be corrected.
    return closed_ && !(corrected_ && winding >= kInsideTwice) ? Inside::yes : Inside::unknown;
  }
  return !simple() && isWalledIn(point) ? Inside::unknown : Inside::no;
}

bool Enclosure::isWalledIn(const Eigen::Vector3d& point) const {
  static const std::vector<Eigen::Vector3d> kDirections = directions();
  int out = 0, doubtful = 0;
  bool front = false, back = false;
  for (const Eigen::Vector3d& direction : kDirections) {
    LineView view;
    view.thin = kThin * box_.sizes().norm();
    for (const WindingTree& surface : surfaces_) surface.look(point, direction, view);
    if (view.unsure) continue;
    front = front || view.front;
    back = back || view.back;
    doubtful += (view.front && view.back) || view.sum != 0;
    out += !view.front && !view.back;
    if (out == kLinesOut) return false;
  }
  // Around a point outside of a mesh whose triangles agree, only lines through holes have another sum than 0.
  return closed_ ? front && back : doubtful >= kDoubtful;
}

void Enclosure::findParts(const std::vector<Eigen::Vector3d>& vertices,
                          const std::vector<WindingTree::Corners>& triangles) {
  std::vector<Index> parent(vertices.size());
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
      parts_.back().fill(vertices[root]);
    }
    Part& part = parts_[part_of[root]];
    for (const Index i : triangle) {
      const Eigen::Vector3d& vertex = vertices[i];
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const auto least = static_cast<std::size_t>(axis), most = least + 3;
        if (vertex[axis] < part[least][axis]) part[least] = vertex;
        if (vertex[axis] > part[most][axis]) part[most] = vertex;
      }
    }
  }
}

}  // namespace hgrid
