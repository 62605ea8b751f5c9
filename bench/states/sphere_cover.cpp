// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/states/sphere_cover.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace hgrid {
namespace bench {
namespace {

constexpr std::size_t kUsual = 6, kFew = 2;  // spheres of a link
constexpr double kShort = 0.08;              // [m] longest side of a link with few spheres

using Triangle = std::array<Eigen::Vector3d, 3>;

/// Returns the triangles of all meshes of a link, in its frame.
std::vector<Triangle> trianglesOf(const RobotLink& link) {
  std::vector<Triangle> triangles;
  for (const BodyShape& shape : link.shapes) {
    if (shape.shape.kind() != ShapeKind::mesh) continue;
    const TriangleMesh& mesh = *shape.shape.mesh();
    for (const auto& t : mesh.triangles) {
      triangles.push_back({shape.body_from_shape * mesh.vertices[t[0]], shape.body_from_shape * mesh.vertices[t[1]],
                           shape.body_from_shape * mesh.vertices[t[2]]});
    }
  }
  return triangles;
}

/// Cuts triangles into slabs of equal thickness along an axis.
/// @returns the corners of the pieces in each slab
std::vector<std::vector<Eigen::Vector3d>> cut(const std::vector<Triangle>& triangles, const Eigen::AlignedBox3d& box,
                                              Eigen::Index axis, std::size_t count) {
  std::vector<std::vector<Eigen::Vector3d>> slabs(count);
  const double begin = box.min()[axis], thickness = box.sizes()[axis] / double(count);
  for (const Triangle& triangle : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d &from = triangle[i], &to = triangle[(i + 1) % 3];
      const double slab = std::floor((from[axis] - begin) / thickness);
      slabs[std::size_t(std::clamp(slab, 0.0, double(count - 1)))].push_back(from);
      for (std::size_t k = 1; k < count; ++k) {
        const double plane = begin + double(k) * thickness;
        if ((from[axis] - plane) * (to[axis] - plane) > 0.0 || from[axis] == to[axis]) continue;
        const Eigen::Vector3d crossing = from + (to - from) * ((plane - from[axis]) / (to[axis] - from[axis]));
        slabs[k - 1].push_back(crossing);
        slabs[k].push_back(crossing);
      }
    }
  }
  return slabs;
}

}  // namespace

std::size_t coverBySpheres(RobotModel& model) {
  std::size_t spheres = 0;
  for (RobotLink& link : model.links) {
    const std::vector<Triangle> triangles = trianglesOf(link);
    if (triangles.empty()) continue;
    Eigen::AlignedBox3d box;
    for (const Triangle& triangle : triangles) {
      for (const Eigen::Vector3d& corner : triangle) box.extend(corner);
    }
    Eigen::Index axis = 0;
    const double longest = box.sizes().maxCoeff(&axis);
    link.shapes.clear();
    for (const auto& slab : cut(triangles, box, axis, longest < kShort ? kFew : kUsual)) {
      if (slab.empty()) continue;
      Eigen::AlignedBox3d around;
      for (const Eigen::Vector3d& corner : slab) around.extend(corner);
      double radius = 0.0;
      for (const Eigen::Vector3d& corner : slab) radius = std::max(radius, (corner - around.center()).norm());
      const Shape sphere = Shape::sphere(std::max(radius, 1e-3));
      link.shapes.push_back({sphere, Pose(Eigen::Translation3d(around.center())), 0.0, {}, Eigen::Vector3d::Ones()});
      ++spheres;
    }
  }
  return spheres;
}

}  // namespace bench
}  // namespace hgrid
