// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/bodies_message.h"

#include <hgrid_proximity/ShapeKind.h>

#include <cmath>

namespace hgrid {
namespace {

msg::Shape toMsg(const BodyShape& source) {
  msg::Shape shape;
  shape.kind = static_cast<std::uint8_t>(source.shape.kind());
  shape.dimensions = source.shape.dimensions();
  shape.pose = toPose(source.body_from_shape);
  shape.padding = source.padding;
  shape.resource = source.resource;
  shape.scale.x = source.scale.x();
  shape.scale.y = source.scale.y();
  shape.scale.z = source.scale.z();
  if (source.shape.mesh()) {
    shape.vertex_count = static_cast<std::uint32_t>(source.shape.mesh()->vertices.size());
    shape.triangle_count = static_cast<std::uint32_t>(source.shape.mesh()->triangles.size());
  }
  return shape;
}

msg::Body toMsg(const Body& source, double margin) {
  msg::Body body;
  body.name = source.name;
  body.frame = source.frame;
  body.pose = toPose(source.frame_from_body);
  body.mobility = static_cast<std::uint8_t>(source.mobility);
  body.robot = source.robot;
  body.rigid_group = source.rigid_group;
  body.shapes.reserve(source.shapes.size());
  for (const BodyShape& shape : source.shapes) body.shapes.push_back(toMsg(shape));
  body.covered = source.covered;
  body.waived = source.waived;
  body.note = source.note;
  body.margin = margin;
  body.max_speed = std::isfinite(source.max_speed) ? source.max_speed : std::nan("");
  return body;
}

/// Returns a shape of kind CELLS that describes the cells of a map or cloud.
msg::Shape shapeOf(const StaticGrid& grid) {
  msg::Shape shape;
  shape.kind = msg::ShapeKind::CELLS;
  shape.dimensions = {grid.finestEdge(), 0.0, 0.0, 0.0};
  shape.pose.orientation.w = 1.0;
  shape.scale.x = shape.scale.y = shape.scale.z = 1.0;
  shape.vertex_count = static_cast<std::uint32_t>(grid.size());
  if (grid.size() == 0) return shape;
  const Eigen::Vector3d sizes = grid.bounds().sizes();
  for (int axis = 0; axis < 3; ++axis) shape.dimensions[static_cast<std::size_t>(axis) + 1] = sizes[axis];
  shape.pose.position = toPoint(grid.bounds().center());
  return shape;
}

}  // namespace

msg::Bodies bodiesMessage(const Tick& tick) {
  msg::Bodies message;
  message.header = headerOf(tick);
  message.epoch = tick.epoch;
  message.without_collision = tick.models->without_collision;
  if (!tick.snapshot) return message;
  const Structure& structure = tick.snapshot->structure();
  message.bodies_revision = structure.revision;
  message.origin = toPoint(tick.snapshot->origin());
  message.bodies.reserve(structure.bodies.size());
  for (std::size_t i = 0; i < structure.bodies.size(); ++i) {
    message.bodies.push_back(toMsg(structure.bodies[i], structure.margin[i]));
    const auto cells = tick.snapshot->cellsOf(static_cast<std::uint32_t>(i));
    if (cells) message.bodies.back().shapes.push_back(shapeOf(*cells->grid));
  }
  return message;
}

}  // namespace hgrid
