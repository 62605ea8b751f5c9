// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "tools/mesh/faces.h"

#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "hgrid_proximity/refusal.h"
#include "tools/mesh/polygon.h"

namespace hgrid {

std::size_t Triangles::Hash::operator()(const std::array<float, 3>& place) const {
  std::uint64_t hash = 0;
  for (const float coordinate : place) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &coordinate, sizeof bits);
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 32;
  }
  return static_cast<std::size_t>(hash);
}

std::uint32_t Triangles::number(const Eigen::Vector3d& place) {
  std::array<float, 3> exact, rounded;
  for (int axis = 0; axis < 3; ++axis) {
    exact[axis] = static_cast<float>(place[axis]);
    // A coordinate that should be 0 is often a rest of a rotation, at one corner 6e-17 and at the other -6e-17.
    rounded[axis] = std::abs(exact[axis]) < 1e-12f ? 0.0f : exact[axis];
  }
  const auto [known, is_new] = numbers_.try_emplace(rounded, static_cast<std::uint32_t>(vertices_.size()));
  if (is_new) vertices_.push_back(exact);
  return known->second;
}

void Triangles::add(const Faces& faces, const Eigen::Affine3d& mesh_from_faces) {
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> numbers(faces.places.size(), kNone);
  const bool mirrored = mesh_from_faces.linear().determinant() < 0;
  std::vector<Eigen::Vector3f> polygon;
  std::size_t begin = 0;
  for (const std::size_t end : faces.ends) {
    polygon.clear();
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t corner = faces.corners[i];
      if (corner >= numbers.size()) {
        throw Refusal(Code::bad_geometry, "a face has the vertex " + std::to_string(corner) +
                                              ", counted from 0; there are " + std::to_string(numbers.size()) +
                                              " vertices");
      }
      polygon.push_back(faces.places[corner]);
      if (numbers[corner] == kNone) numbers[corner] = number(mesh_from_faces * faces.places[corner].cast<double>());
    }
    if (triangles_.size() + polygon.size() > max_triangles_ + 2) {
      throw Refusal(Code::limit, "it has too many triangles; at most " + std::to_string(max_triangles_) +
                                     " are allowed; simplify it");
    }
    const std::vector<std::array<std::uint32_t, 3>> parts =
        polygon.size() == 3 ? std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}} : splitPolygon(polygon);
    for (const auto& part : parts) {
      std::array<std::uint32_t, 3> triangle;
      for (int i = 0; i < 3; ++i) triangle[i] = numbers[faces.corners[begin + part[i]]];
      if (mirrored) std::swap(triangle[1], triangle[2]);
      triangles_.push_back(triangle);
    }
    begin = end;
  }
}

}  // namespace hgrid
