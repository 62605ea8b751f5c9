// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/moveit/scene_reply.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>
#include <vector>

#include "node/messages/to_messages.h"
#include "node/moveit/scene_matrix.h"
#include "node/moveit/scene_plane.h"

namespace hgrid {
namespace {

using moveit::GetPlanningScene;
using NoeticObject = moveit::CollisionObject;

void appendPrimitive(std::uint8_t type, const std::vector<double>& dimensions, const Pose& pose, NoeticObject& object) {
  shape_msgs::SolidPrimitive primitive;
  primitive.type = type;
  primitive.dimensions.assign(dimensions.begin(), dimensions.end());
  object.primitives.push_back(std::move(primitive));
  object.primitive_poses.push_back(toPose(pose));
}

/// Appends a cylinder, and a sphere at each of its ends.
void appendCapsule(double height, double radius, const Pose& pose, NoeticObject& object) {
  appendPrimitive(shape_msgs::SolidPrimitive::CYLINDER, {height, radius}, pose, object);
  for (const double end : {-0.5 * height, 0.5 * height}) {
    Pose center = pose;
    center.translation() += end * pose.linear().col(2);
    appendPrimitive(shape_msgs::SolidPrimitive::SPHERE, {radius}, center, object);
  }
}

/// Appends a mesh. A hull may come without triangles; then appends the box around its vertices.
void appendMesh(const TriangleMesh& source, const Pose& pose, NoeticObject& object) {
  if (source.triangles.empty()) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& vertex : source.vertices) box.extend(vertex);
    Pose center = pose;
    center.translation() = pose * box.center();
    const Eigen::Vector3d size = box.sizes();
    return appendPrimitive(shape_msgs::SolidPrimitive::BOX, {size.x(), size.y(), size.z()}, center, object);
  }
  shape_msgs::Mesh mesh;
  for (const Eigen::Vector3d& vertex : source.vertices) mesh.vertices.push_back(toPoint(vertex));
  for (const auto& corners : source.triangles) {
    mesh.triangles.emplace_back();
    std::copy(corners.begin(), corners.end(), mesh.triangles.back().vertex_indices.begin());
  }
  object.meshes.push_back(std::move(mesh));
  object.mesh_poses.push_back(toPose(pose));
}

void appendShape(const BodyShape& part, NoeticObject& object) {
  const std::vector<double> dimensions = part.shape.dimensions();
  switch (part.shape.kind()) {
    case ShapeKind::sphere:
      return appendPrimitive(shape_msgs::SolidPrimitive::SPHERE, dimensions, part.body_from_shape, object);
    case ShapeKind::box:
      return appendPrimitive(shape_msgs::SolidPrimitive::BOX, dimensions, part.body_from_shape, object);
    case ShapeKind::cylinder:
      return appendPrimitive(shape_msgs::SolidPrimitive::CYLINDER, dimensions, part.body_from_shape, object);
    case ShapeKind::cone:
      return appendPrimitive(shape_msgs::SolidPrimitive::CONE, dimensions, part.body_from_shape, object);
    case ShapeKind::capsule:
      return appendCapsule(dimensions[0], dimensions[1], part.body_from_shape, object);
    case ShapeKind::hull:
    case ShapeKind::mesh:
      return appendMesh(*part.shape.mesh(), part.body_from_shape, object);
    case ShapeKind::plane:
      object.planes.push_back(horizontalPlane());
      object.plane_poses.push_back(toPose(part.body_from_shape));
  }
}

/// Returns the name without its source or robot.
std::string localOf(const std::string& name) { return name.substr(name.find('/') + 1); }

NoeticObject objectOf(const std::string& name, const std::string& frame, const Pose& pose,
                      const std::vector<BodyShape>& shapes, bool with_geometry) {
  NoeticObject object;
  object.id = localOf(name);
  object.header.frame_id = frame;
  object.pose = toPose(pose);
  if (!with_geometry) return object;
  for (const BodyShape& shape : shapes) appendShape(shape, object);
  return object;
}

moveit::AttachedCollisionObject attachedOf(const std::string& name, const PlacedObstacle& obstacle) {
  const Attachment& attachment = *obstacle.attachment;
  moveit::AttachedCollisionObject attached;
  attached.link_name = localOf(attachment.link);
  attached.object = objectOf(name, attached.link_name, *attachment.link_from_body, obstacle.what->body.shapes, true);
  attached.touch_links = attachment.touch_links;
  return attached;
}

void appendPaddings(const BodyList& bodies, moveit::PlanningScene& scene) {
  std::map<std::string, int> robots;  // by the name of a link: how many robots have it
  for (const Body& body : bodies) {
    if (body.kind == BodyKind::link) ++robots[localOf(body.name)];
  }
  for (const Body& body : bodies) {
    if (body.kind != BodyKind::link) continue;
    const std::string local = localOf(body.name);
    const std::string& name = robots[local] > 1 ? body.name : local;
    double padding = 0.0;
    for (const BodyShape& shape : body.shapes) padding = std::max(padding, shape.padding);
    scene.link_padding.push_back({name, padding});
    scene.link_scale.push_back({name, 1.0});
  }
}

}  // namespace

moveit::PlanningScene planningScene(std::uint32_t components, const Tick& tick,
                                    const std::map<std::string, PlacedObstacle>& obstacles,
                                    const std::vector<MatrixRule>& matrix) {
  moveit::PlanningScene scene;
  scene.name = "hgrid_proximity";
  scene.robot_state.is_diff = true;  // it contains no joint positions
  if ((components & GetPlanningScene::allowed_collision_matrix) != 0) {
    scene.allowed_collision_matrix = matrixMessage(matrix);
  }
  if (!tick.snapshot) return scene;
  if ((components & GetPlanningScene::padding_and_scale) != 0) appendPaddings(tick.snapshot->structure().bodies, scene);
  const bool with_geometry = (components & GetPlanningScene::object_geometry) != 0;
  const bool with_objects = with_geometry || (components & GetPlanningScene::object_names) != 0;
  const bool with_attached = (components & GetPlanningScene::attached_objects) != 0;
  for (const auto& [name, obstacle] : obstacles) {
    const std::uint32_t index = tick.snapshot->structure().find(name);
    if (index == Structure::kNone || tick.snapshot->poses()[index].state == Freshness::unplaced) continue;
    if (obstacle.attachment) {
      if (with_attached) scene.robot_state.attached_collision_objects.push_back(attachedOf(name, obstacle));
    } else if (with_objects) {
      scene.collision_objects.push_back(objectOf(name, tick.world_frame, tick.snapshot->poses()[index].world_from_body,
                                                 obstacle.what->body.shapes, with_geometry));
    }
  }
  return scene;
}

}  // namespace hgrid
