// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace hgrid {

/// The faces of a file, or of one part of it.
struct Faces {
  std::vector<Eigen::Vector3f> places;  ///< of vertices
  std::vector<std::uint32_t> corners;   ///< of all faces, one face after the other: numbers of vertices
  std::vector<std::size_t> ends;        ///< for each face: the index in `corners` after its last corner

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    corners.insert(corners.end(), {a, b, c});
    ends.push_back(corners.size());
  }
};

/// Triangles from faces. Equal places become one vertex, so that faces that meet share the number of the vertex.
class Triangles {
 public:
  explicit Triangles(std::size_t max_triangles) : max_triangles_(max_triangles) {}

  /// Adds the faces, moved by `mesh_from_faces`. A mirrored face keeps the side that faces outward.
  /// @throws Refusal limit if there are too many triangles
  /// @throws Refusal bad_geometry if a face names a vertex that does not exist
  void add(const Faces& faces, const Eigen::Affine3d& mesh_from_faces = Eigen::Affine3d::Identity());

  const std::vector<std::array<float, 3>>& vertices() const { return vertices_; }
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }

 private:
  struct Hash {
    std::size_t operator()(const std::array<float, 3>& place) const;
  };
  std::uint32_t number(const Eigen::Vector3d& place);

  std::size_t max_triangles_;
  std::vector<std::array<float, 3>> vertices_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::unordered_map<std::array<float, 3>, std::uint32_t, Hash> numbers_;
};

}  // namespace hgrid
