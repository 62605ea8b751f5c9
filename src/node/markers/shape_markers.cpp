// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/markers/shape_markers.h"

#include <algorithm>
#include <optional>

#include "node/markers/marker_parts.h"
#include "node/messages/to_messages.h"

namespace hgrid {
namespace {

using visualization_msgs::Marker;

constexpr int kMostParts = 3;  // most markers that draw one shape: a capsule is a cylinder and two spheres
constexpr std::size_t kMostTriangles = 20000;
constexpr double kPlaneSide = 10.0, kPlaneThickness = 0.002;  // [m] of the square that stands for a plane

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

}  // namespace

std::vector<Marker> shapeMarkers(const Tick& tick, const NearPairs& near) {
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
    // Only a part of a plane is near.
    const std::optional<double> nearness = structure.isPlane(proxy) ? std::nullopt : near.nearness[number];
    ShapeDrawing(tick, proxy, colorOfBody(body.kind, pose.state, nearness), markers)
        .draw(shape, pose.world_from_body * shape.body_from_shape);
  }
  return markers;
}

}  // namespace hgrid
