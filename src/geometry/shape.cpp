// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/geometry/shape.h"

#include <cmath>
#include <limits>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

void checkSize(double value, const char* shape, const char* field, const ShapeLimits& limits,
               bool may_be_flat = false) {
  if (may_be_flat && value == 0.0) return;
  if (value >= limits.min_size && value <= limits.max_size && std::isfinite(value)) return;
  throw Refusal(Code::bad_geometry,
                std::string(shape) + ": " + field + " is " + text(value) + " m; it must be " +
                    (std::isfinite(value) ? "within " + text(limits.min_size) + " .. " + text(limits.max_size) + " m"
                                          : "finite"));
}

void checkVertices(const TriangleMesh& mesh, double max_size, const std::string& what) {
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    if (!vertex.allFinite()) {
      throw Refusal(Code::nonfinite, what + " has a vertex that is not finite; every coordinate must be finite");
    }
    checkWithin(vertex, max_size, what + ": a vertex");
  }
}

/// Returns the half-widths of a disc of radius 1 whose axis is `axis`.
///
/// The half-width along a direction is the sine of the angle between the direction and the axis (Ericson 2005, section
/// 4.2). The sine is computed from the other two components of the axis, because 1 - cosine² would lose all digits for
/// small angles. std::hypot is not needed, because squares that underflow are far below the slack of a box.
Eigen::Vector3d discHalfWidths(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d squares = axis.cwiseAbs2();
  return {std::sqrt(squares.y() + squares.z()), std::sqrt(squares.x() + squares.z()),
          std::sqrt(squares.x() + squares.y())};
}

}  // namespace

void checkMesh(const TriangleMesh& mesh, double max_size, const std::string& what) {
  checkVertices(mesh, max_size, what);
  bool has_area = false;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) {
      if (index >= mesh.vertices.size()) {
        throw Refusal(Code::bad_geometry, what + " has a triangle with vertex index " + std::to_string(index) +
                                              "; it must be less than the number of vertices, " +
                                              std::to_string(mesh.vertices.size()));
      }
    }
    const Eigen::Vector3d &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]],
                          &c = mesh.vertices[triangle[2]];
    has_area = has_area || (b - a).cross(c - a).squaredNorm() > 0.0;
  }
  if (!has_area) {
    throw Refusal(Code::bad_geometry, what + " has " + std::to_string(mesh.triangles.size()) +
                                          " triangles, but none of them has an area; at least one must have an area");
  }
}

const char* name(ShapeKind kind) {
  static constexpr const char* kNames[] = {"none",    "sphere", "box",  "cylinder", "cone",
                                           "capsule", "hull",   "mesh", "cells",    "plane"};
  return kNames[static_cast<int>(kind)];
}

Shape::Shape(ShapeKind kind, const Eigen::Vector3d& size, std::shared_ptr<const TriangleMesh> mesh)
    : kind_(kind), size_(size), mesh_(std::move(mesh)) {
  const double height = size_[0], radius = size_[1];
  switch (kind_) {
    case ShapeKind::sphere:
      reach_ = size_[0];
      break;
    case ShapeKind::box:
      reach_ = 0.5 * size_.norm();
      break;
    case ShapeKind::cylinder:
    case ShapeKind::cone:
      reach_ = std::sqrt(0.25 * height * height + radius * radius);
      break;
    case ShapeKind::capsule:
      reach_ = 0.5 * height + radius;
      break;
    case ShapeKind::hull:
    case ShapeKind::mesh:
      for (const Eigen::Vector3d& vertex : mesh_->vertices) reach_ = std::max(reach_, vertex.norm());
      break;
    case ShapeKind::plane:
      reach_ = std::numeric_limits<double>::infinity();
      break;
  }
}

Shape Shape::sphere(double radius, const ShapeLimits& limits) {
  checkSize(radius, "sphere", "radius", limits);
  return Shape(ShapeKind::sphere, {radius, 0.0, 0.0}, nullptr);
}

Shape Shape::box(const Eigen::Vector3d& size, const ShapeLimits& limits) {
  static constexpr const char* kSides[] = {"side x", "side y", "side z"};
  const bool one_flat = limits.allow_flat && (size.array() == 0.0).count() == 1;
  for (int axis = 0; axis < 3; ++axis) checkSize(size[axis], "box", kSides[axis], limits, one_flat);
  return Shape(ShapeKind::box, size, nullptr);
}

Shape Shape::cylinder(double height, double radius, const ShapeLimits& limits) {
  checkSize(height, "cylinder", "height", limits);
  checkSize(radius, "cylinder", "radius", limits);
  return Shape(ShapeKind::cylinder, {height, radius, 0.0}, nullptr);
}

Shape Shape::cone(double height, double radius, const ShapeLimits& limits) {
  checkSize(height, "cone", "height", limits);
  checkSize(radius, "cone", "radius", limits);
  return Shape(ShapeKind::cone, {height, radius, 0.0}, nullptr);
}

Shape Shape::capsule(double height, double radius, const ShapeLimits& limits) {
  checkSize(height, "capsule", "height", limits);
  checkSize(radius, "capsule", "radius", limits);
  return Shape(ShapeKind::capsule, {height, radius, 0.0}, nullptr);
}

Shape Shape::hull(std::shared_ptr<const TriangleMesh> vertices, const ShapeLimits& limits) {
  if (vertices == nullptr || vertices->vertices.empty()) {
    throw Refusal(Code::bad_geometry, "hull: it has 0 vertices; it must have at least 1");
  }
  checkVertices(*vertices, limits.max_size, "hull");
  return Shape(ShapeKind::hull, Eigen::Vector3d::Zero(), std::move(vertices));
}

Shape Shape::mesh(std::shared_ptr<const TriangleMesh> mesh, const ShapeLimits& limits) {
  if (mesh == nullptr) throw Refusal(Code::bad_geometry, "mesh: no mesh was given; it must have at least one triangle");
  checkMesh(*mesh, limits.max_size, "mesh");
  return Shape(ShapeKind::mesh, Eigen::Vector3d::Zero(), std::move(mesh));
}

Shape Shape::plane() { return Shape(ShapeKind::plane, Eigen::Vector3d::Zero(), nullptr); }

Shape Shape::primitive(int kind, const std::vector<double>& dimensions, const ShapeLimits& limits) {
  std::size_t expected = 0;
  switch (kind) {
    case static_cast<int>(ShapeKind::sphere):
      expected = 1;
      break;
    case static_cast<int>(ShapeKind::box):
      expected = 3;
      break;
    case static_cast<int>(ShapeKind::cylinder):
    case static_cast<int>(ShapeKind::cone):
    case static_cast<int>(ShapeKind::capsule):
      expected = 2;
      break;
    default:
      throw Refusal(Code::unsupported, "shape kind " + std::to_string(kind) + " is not a primitive; it must be 1 .. 5");
  }
  if (dimensions.size() != expected) {
    throw Refusal(Code::bad_geometry, std::string(name(static_cast<ShapeKind>(kind))) + ": it has " +
                                          std::to_string(dimensions.size()) + " dimensions; it must have " +
                                          std::to_string(expected));
  }
  switch (static_cast<ShapeKind>(kind)) {
    case ShapeKind::sphere:
      return sphere(dimensions[0], limits);
    case ShapeKind::box:
      return box({dimensions[0], dimensions[1], dimensions[2]}, limits);
    case ShapeKind::cylinder:
      return cylinder(dimensions[0], dimensions[1], limits);
    case ShapeKind::cone:
      return cone(dimensions[0], dimensions[1], limits);
    default:
      return capsule(dimensions[0], dimensions[1], limits);
  }
}

std::vector<double> Shape::dimensions() const {
  switch (kind_) {
    case ShapeKind::sphere:
      return {size_[0]};
    case ShapeKind::box:
      return {size_[0], size_[1], size_[2]};
    case ShapeKind::cylinder:
    case ShapeKind::cone:
    case ShapeKind::capsule:
      return {size_[0], size_[1]};
    default:
      return {};
  }
}

double Shape::reach() const { return reach_; }

Aabb boxOf(const Shape& shape, const Pose& world_from_shape, double padding, const Eigen::Vector3d& origin) {
  if (shape.kind() == ShapeKind::plane) {
    constexpr float kLargest = std::numeric_limits<float>::max();
    return {Eigen::Vector3f::Constant(-kLargest), Eigen::Vector3f::Constant(kLargest)};
  }
  const Eigen::Matrix3d rotation = world_from_shape.linear();
  const Eigen::Vector3d center = world_from_shape.translation();
  const Eigen::Vector3d axis = rotation.col(2);
  const double height = shape.size_[0], radius = shape.size_[1];
  Eigen::Vector3d low, high;
  switch (shape.kind_) {
    case ShapeKind::sphere:
      high = center.array() + shape.size_[0];
      low = center.array() - shape.size_[0];
      break;
    case ShapeKind::box: {
      const Eigen::Vector3d half = rotation.cwiseAbs() * (0.5 * shape.size_);
      high = center + half;
      low = center - half;
      break;
    }
    case ShapeKind::cylinder: {
      const Eigen::Vector3d half = 0.5 * height * axis.cwiseAbs() + radius * discHalfWidths(axis);
      high = center + half;
      low = center - half;
      break;
    }
    case ShapeKind::cone: {
      const Eigen::Vector3d tip = center + 0.5 * height * axis, base = center - 0.5 * height * axis;
      const Eigen::Vector3d disc = radius * discHalfWidths(axis);
      high = tip.cwiseMax(base + disc);
      low = tip.cwiseMin(base - disc);
      break;
    }
    case ShapeKind::capsule: {
      const Eigen::Vector3d half = (0.5 * height * axis.cwiseAbs()).array() + radius;
      high = center + half;
      low = center - half;
      break;
    }
    case ShapeKind::hull:
    case ShapeKind::mesh: {
      const double infinity = std::numeric_limits<double>::infinity();
      low.setConstant(infinity);
      high.setConstant(-infinity);
      for (const Eigen::Vector3d& vertex : shape.mesh_->vertices) {
        const Eigen::Vector3d turned = rotation * vertex;
        low = low.cwiseMin(turned);
        high = high.cwiseMax(turned);
      }
      low += center;
      high += center;
      break;
    }
    case ShapeKind::plane:  // see above
      break;
  }
  // The slack is 64 units of rounding of all terms. The formulas above, the composition of poses and the shift by the
  // origin together need about a fifth of that.
  Aabb box;
  for (int i = 0; i < 3; ++i) {
    const double slack = 64.0 * std::numeric_limits<double>::epsilon() *
                         (std::abs(center[i]) + std::abs(origin[i]) + shape.reach_ + padding);
    box.min[i] = roundedDown(low[i] - origin[i] - padding - slack);
    box.max[i] = roundedUp(high[i] - origin[i] + padding + slack);
  }
  return box;
}

}  // namespace hgrid
