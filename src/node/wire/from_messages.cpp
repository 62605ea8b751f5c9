// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/wire/from_messages.h"

#include <hgrid_proximity/ShapeKind.h>

#include <algorithm>
#include <memory>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

namespace msg = ::hgrid_proximity;

/// Converts a mesh. Its vertices are limited as well, because not every vertex needs to belong to a triangle.
std::shared_ptr<const TriangleMesh> fromMesh(const shape_msgs::Mesh& source, std::size_t max_triangles) {
  if (source.triangles.size() > max_triangles || source.vertices.size() > 3 * max_triangles) {
    throw Refusal(Code::limit,
                  "the shape has " + std::to_string(source.triangles.size()) + " triangles and " +
                      std::to_string(source.vertices.size()) + " vertices; at most " + std::to_string(max_triangles) +
                      " triangles (~limits/max_mesh_triangles) and three times as many vertices are allowed");
  }
  const auto mesh = std::make_shared<TriangleMesh>();
  for (const geometry_msgs::Point& vertex : source.vertices) mesh->vertices.push_back(fromPoint(vertex));
  for (const shape_msgs::MeshTriangle& triangle : source.triangles) {
    mesh->triangles.push_back({triangle.vertex_indices[0], triangle.vertex_indices[1], triangle.vertex_indices[2]});
  }
  return mesh;
}

}  // namespace

Pose fromPose(const geometry_msgs::Pose& pose, const std::string& what) {
  const auto& q = pose.orientation;
  const bool unset = q.x == 0.0 && q.y == 0.0 && q.z == 0.0 && q.w == 0.0;
  const Eigen::Vector4d rotation = unset ? Eigen::Vector4d(0.0, 0.0, 0.0, 1.0) : Eigen::Vector4d(q.x, q.y, q.z, q.w);
  return checkedPose(fromPoint(pose.position), rotation, what);
}

Shape fromShape(const msg::Shape& shape, const ShapeLimits& limits, std::size_t max_triangles) {
  if (shape.kind == msg::ShapeKind::HULL) return Shape::hull(fromMesh(shape.mesh, max_triangles), limits);
  if (shape.kind == msg::ShapeKind::MESH) return Shape::mesh(fromMesh(shape.mesh, max_triangles), limits);
  if (shape.kind == msg::ShapeKind::PLANE) {
    if (!shape.dimensions.empty()) {
      throw Refusal(Code::bad_geometry, "plane: it has " + std::to_string(shape.dimensions.size()) +
                                            " dimensions; it must have 0, because its pose says where it is");
    }
    return Shape::plane();
  }
  if (shape.kind == msg::ShapeKind::CELLS) {
    throw Refusal(Code::unsupported,
                  "the shape's kind is CELLS; it must be SPHERE, BOX, CYLINDER, CONE, CAPSULE, HULL, MESH or PLANE");
  }
  return Shape::primitive(shape.kind, shape.dimensions, limits);
}

}  // namespace hgrid
