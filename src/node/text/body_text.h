// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "node/text/value_text.h"

namespace hgrid {

// Each pass() function writes a value if the file is a TextWriter. If the file is a TextReader, it reads the value.

template <class File>
void pass(File& file, Time& time) {
  auto count = static_cast<std::int64_t>(time.count());
  file.value(count);
  time = Time(count);
}

template <class File>
void pass(File& file, Eigen::Vector3d& vector) {
  for (int axis = 0; axis < 3; ++axis) file.value(vector[axis]);
}

template <class File>
void pass(File& file, Pose& pose) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) file.value(pose.matrix()(row, column));
  }
}

template <class File>
void pass(File& file, TriangleMesh& mesh) {
  passAll(file, "vertices", mesh.vertices, Eigen::Vector3d(Eigen::Vector3d::Zero()), [&](Eigen::Vector3d& vertex) {
    file.line("vertex");
    pass(file, vertex);
  });
  passAll(file, "triangles", mesh.triangles, {}, [&](std::array<std::uint32_t, 3>& triangle) {
    file.line("triangle");
    for (std::uint32_t& corner : triangle) file.value(corner);
  });
}

/// Returns the shape of a kind. @throws Refusal if the lengths or the mesh are not valid
inline Shape shapeOfText(ShapeKind kind, const std::vector<double>& dimensions, const TriangleMesh& mesh) {
  const ShapeLimits limits{0.0, 1e9, true};
  const auto shared = std::make_shared<const TriangleMesh>(mesh);
  if (kind == ShapeKind::hull) return Shape::hull(shared, limits);
  if (kind == ShapeKind::mesh) return Shape::mesh(shared, limits);
  if (kind == ShapeKind::plane) return Shape::plane();
  return Shape::primitive(static_cast<int>(kind), dimensions, limits);
}

template <class File>
void pass(File& file, BodyShape& shape) {
  ShapeKind kind = shape.shape.kind();
  std::vector<double> dimensions = shape.shape.dimensions();
  TriangleMesh mesh = shape.shape.mesh() ? *shape.shape.mesh() : TriangleMesh{};
  file.line("shape");
  file.value(kind);
  file.value(shape.padding);
  file.value(shape.resource);
  pass(file, shape.scale);
  pass(file, shape.body_from_shape);
  passAll(file, "dimensions", dimensions, 0.0, [&](double& length) {
    file.line("dimension");
    file.value(length);
  });
  if (kind == ShapeKind::hull || kind == ShapeKind::mesh) pass(file, mesh);
  if (File::kReads) shape.shape = shapeOfText(kind, dimensions, mesh);
}

template <class File>
void pass(File& file, Body& body) {
  file.line("body");
  file.value(body.name);
  file.value(body.frame);
  file.value(body.robot);
  file.value(body.group);
  file.value(body.kind);
  file.value(body.mobility);
  file.value(body.margin);
  file.value(body.max_speed);
  pass(file, body.frame_from_body);
  const BodyShape blank{Shape::sphere(1.0), Pose::Identity(), 0.0, {}, Eigen::Vector3d::Ones()};
  passAll(file, "shapes", body.shapes, blank, [&](BodyShape& shape) { pass(file, shape); });
}

}  // namespace hgrid
