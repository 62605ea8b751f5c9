// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/shape_markers.h"

#include <algorithm>
#include <optional>

#include "node/messages/marker_parts.h"
#include "node/messages/to_messages.h"

namespace hgrid {
namespace {

using visualization_msgs::Marker;

constexpr int kMostParts = 3;  // most markers that draw one shape: a capsule is a cylinder and two spheres
constexpr std::size_t kMostTriangles = 20000;
constexpr double kPlaneSide = 10.0, kPlaneThickness = 0.002;  // [m] of the square that stands for a plane
constexpr int kMostStates = 20;
constexpr double kStateTextHeight = 0.05;  // [m]

std_msgs::ColorRGBA colorOf(BodyKind kind, Freshness state) {
  switch (state) {
    case Freshness::fresh:
    case Freshness::late:
      return kind == BodyKind::link ? rgba(0.34, 0.71, 0.91, 0.7) : rgba(0.82, 0.76, 0.64, 0.75);
    case Freshness::stale:
      return rgba(0.90, 0.62, 0.0, 0.7);
    case Freshness::frozen:
      return rgba(0.80, 0.47, 0.65, 0.7);
    default:
      return rgba(0.90, 0.10, 0.10, 0.7);
  }
}

/// Returns the color of a level of the grid. People who confuse red and green can distinguish the colors, too (after
/// Okabe and Ito, 2008).
std_msgs::ColorRGBA levelColor(int level) {
  static const std_msgs::ColorRGBA kColors[] = {rgba(0.34, 0.71, 0.91, 0.9), rgba(0.90, 0.62, 0.00, 0.9),
                                                rgba(0.00, 0.62, 0.45, 0.9), rgba(0.80, 0.47, 0.65, 0.9),
                                                rgba(0.94, 0.89, 0.26, 0.9), rgba(0.00, 0.45, 0.70, 0.9)};
  return kColors[static_cast<std::size_t>(std::max(level, 0)) % 6];
}

void setScale(Marker& marker, double x, double y, double z) {
  marker.scale.x = x;
  marker.scale.y = y;
  marker.scale.z = z;
}

/// Adds the triangles of a cone to a marker. Its center is the origin and its tip is at +z.
void addCone(Marker& marker, double height, double radius) {
  constexpr int kSides = 32;
  const auto rim = [&](int side) {
    const double angle = 2.0 * M_PI * side / kSides;
    return toPoint({radius * std::cos(angle), radius * std::sin(angle), -0.5 * height});
  };
  for (int side = 0; side < kSides; ++side) {
    for (const double z : {0.5 * height, -0.5 * height}) {  // the mantle, then the base
      marker.points.push_back(toPoint({0.0, 0.0, z}));
      marker.points.push_back(rim(side));
      marker.points.push_back(rim(side + 1));
      if (z < 0.0) std::swap(marker.points.back(), marker.points[marker.points.size() - 2]);
    }
  }
}

void addTriangles(Marker& marker, const TriangleMesh& mesh) {
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) marker.points.push_back(toPoint(mesh.vertices[corner]));
  }
}

/// Returns the center [m, world] of the box around all placed bodies that can move; nullopt if there are none.
std::optional<Eigen::Vector3d> centerOfMoving(const Snapshot& snapshot) {
  const Structure& structure = snapshot.structure();
  Eigen::AlignedBox3d all;
  for (ProxyId proxy = 0; proxy < snapshot.boxes().size(); ++proxy) {
    const std::uint32_t body = structure.body_of_proxy[proxy];
    const bool moves = structure.bodies[body].mobility == Mobility::moving;
    if (moves && snapshot.poses()[body].state != Freshness::unplaced) all.extend(inDouble(snapshot.boxes()[proxy]));
  }
  if (all.isEmpty()) return std::nullopt;
  return snapshot.origin() + all.center();
}

/// Draws the markers of one shape.
class ShapeDrawing {
 public:
  ShapeDrawing(const Tick& tick, std::uint32_t proxy, const std_msgs::ColorRGBA& color, std::vector<Marker>& markers)
      : tick_(tick), proxy_(proxy), color_(color), markers_(markers) {}

  void draw(const BodyShape& shape, const Pose& world_from_shape) {
    const std::vector<double> size = shape.shape.dimensions();
    const double padding = shape.padding;
    switch (shape.shape.kind()) {
      case ShapeKind::sphere:
        return sphere(world_from_shape, size[0] + padding);
      case ShapeKind::box: {
        Marker& box = add(Marker::CUBE, world_from_shape);
        return setScale(box, size[0] + 2.0 * padding, size[1] + 2.0 * padding, size[2] + 2.0 * padding);
      }
      case ShapeKind::cylinder:
        return cylinder(world_from_shape, size[0] + 2.0 * padding, size[1] + padding);
      case ShapeKind::cone: {
        Marker& cone = add(Marker::TRIANGLE_LIST, world_from_shape);
        setScale(cone, 1.0, 1.0, 1.0);
        return addCone(cone, size[0] + 2.0 * padding, size[1] + padding);
      }
      case ShapeKind::capsule: {
        cylinder(world_from_shape, size[0], size[1] + padding);
        for (const double end : {-0.5, 0.5}) {
          sphere(world_from_shape * Eigen::Translation3d(0.0, 0.0, end * size[0]), size[1] + padding);
        }
        return;
      }
      case ShapeKind::hull:
      case ShapeKind::mesh:
        return mesh(shape, world_from_shape);
      case ShapeKind::plane:
        return plane(world_from_shape, padding);
    }
  }

 private:
  Marker& add(int type, const Pose& pose) {
    markers_.push_back(markerOf(tick_, "shapes", static_cast<int>(proxy_) * kMostParts + parts_++, type));
    Marker& marker = markers_.back();
    marker.action = Marker::ADD;
    marker.pose = toPose(pose);
    marker.color = color_;
    return marker;
  }
  void sphere(const Pose& pose, double radius) {
    setScale(add(Marker::SPHERE, pose), 2.0 * radius, 2.0 * radius, 2.0 * radius);
  }
  void cylinder(const Pose& pose, double height, double radius) {
    setScale(add(Marker::CYLINDER, pose), 2.0 * radius, 2.0 * radius, height);
  }
  void mesh(const BodyShape& shape, const Pose& pose) {
    if (!shape.resource.empty()) {
      Marker& file = add(Marker::MESH_RESOURCE, pose);
      file.mesh_resource = shape.resource;
      return setScale(file, shape.scale.x(), shape.scale.y(), shape.scale.z());
    }
    const TriangleMesh& triangles = *shape.shape.mesh();
    if (!triangles.triangles.empty() && triangles.triangles.size() <= kMostTriangles) {
      Marker& list = add(Marker::TRIANGLE_LIST, pose);
      setScale(list, 1.0, 1.0, 1.0);
      return addTriangles(list, triangles);
    }
    const Aabb& box = tick_.snapshot->boxes()[proxy_];
    Pose center = Pose::Identity();
    center.translation() = inDouble(box).center() + tick_.snapshot->origin();
    const Eigen::Vector3d size = inDouble(box).sizes();
    setScale(add(Marker::CUBE, center), size.x(), size.y(), size.z());
  }

  /// Draws a thin square below the surface. It shows the part of the plane that is nearest to what moves.
  void plane(const Pose& pose, double padding) {
    Eigen::Vector3d center = pose.inverse() * centerOfMoving(*tick_.snapshot).value_or(pose.translation());
    center.z() = padding - 0.5 * kPlaneThickness;
    Marker& square = add(Marker::CUBE, pose * Eigen::Translation3d(center));
    square.color.a = 0.3f;
    setScale(square, kPlaneSide, kPlaneSide, kPlaneThickness);
  }

  const Tick& tick_;
  const std::uint32_t proxy_;
  const std_msgs::ColorRGBA color_;
  std::vector<Marker>& markers_;
  int parts_ = 0;
};

void addEdges(Marker& lines, const Aabb& box, const Eigen::Vector3d& origin, const std_msgs::ColorRGBA& color) {
  const auto corner = [&](int bits) {
    Eigen::Vector3d point;
    for (int axis = 0; axis < 3; ++axis)
      point[axis] = origin[axis] + (bits >> axis & 1 ? box.max[axis] : box.min[axis]);
    return point;
  };
  for (int bits = 0; bits < 8; ++bits) {
    for (int axis = 0; axis < 3; ++axis) {
      if ((bits >> axis & 1) == 0) addLine(lines, corner(bits), corner(bits | 1 << axis), color);
    }
  }
}

}  // namespace

std::vector<Marker> shapeMarkers(const Tick& tick) {
  std::vector<Marker> markers;
  if (!tick.snapshot) return markers;
  const Snapshot& snapshot = *tick.snapshot;
  const Structure& structure = snapshot.structure();
  for (std::uint32_t proxy = 0; proxy < snapshot.boxes().size(); ++proxy) {
    const std::uint32_t number = structure.body_of_proxy[proxy];
    const BodyPose& pose = snapshot.poses()[number];
    if (pose.state == Freshness::unplaced) continue;
    const Body& body = structure.bodies[number];
    const BodyShape& shape = body.shapes[structure.shapeOf(proxy)];
    ShapeDrawing(tick, proxy, colorOf(body.kind, pose.state), markers)
        .draw(shape, pose.world_from_body * shape.body_from_shape);
  }
  return markers;
}

Marker boxMarker(const Tick& tick) {
  Marker boxes = markerOf(tick, "boxes", 0, Marker::LINE_LIST);
  boxes.scale.x = 0.004;
  if (!tick.snapshot) return boxes;
  const Snapshot& snapshot = *tick.snapshot;
  for (ProxyId proxy = 0; proxy < snapshot.boxes().size(); ++proxy) {
    if (snapshot.poses()[snapshot.structure().body_of_proxy[proxy]].state == Freshness::unplaced) continue;
    if (snapshot.structure().isPlane(proxy)) continue;  // it has no box
    addEdges(boxes, snapshot.boxes()[proxy], snapshot.origin(), levelColor(snapshot.broadPhase().levelOf(proxy)));
  }
  return boxes;
}

std::vector<Marker> stateMarkers(const Tick& tick) {
  std::vector<Marker> texts;
  for (int i = 0; i < kMostStates; ++i) {
    texts.push_back(markerOf(tick, "states", i, Marker::TEXT_VIEW_FACING));
    texts.back().scale.z = kStateTextHeight;
  }
  if (!tick.snapshot) return texts;
  const Snapshot& snapshot = *tick.snapshot;
  const Structure& structure = snapshot.structure();
  std::vector<std::uint32_t> bodies;
  for (std::uint32_t body = 0; body < structure.bodies.size(); ++body) {
    const Freshness state = snapshot.poses()[body].state;
    if (state >= Freshness::stale && state != Freshness::unplaced) bodies.push_back(body);
  }
  std::stable_sort(bodies.begin(), bodies.end(), [&](std::uint32_t a, std::uint32_t b) {
    return snapshot.poses()[a].state > snapshot.poses()[b].state;
  });
  for (std::size_t i = 0; i < std::min(texts.size(), bodies.size()); ++i) {
    const Body& body = structure.bodies[bodies[i]];
    const BodyPose& pose = snapshot.poses()[bodies[i]];
    texts[i].action = Marker::ADD;
    texts[i].text = body.name + ": " + name(pose.state);
    texts[i].color = colorOf(body.kind, pose.state);
    texts[i].color.a = 1.0f;
    texts[i].pose.position = toPoint(pose.world_from_body.translation());
  }
  return texts;
}

}  // namespace hgrid
