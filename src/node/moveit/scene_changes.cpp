// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/moveit/scene_changes.h"

#include <hgrid_proximity/Obstacle.h>
#include <hgrid_proximity/ObstacleOperation.h>
#include <hgrid_proximity/ShapeKind.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hgrid_proximity/bodies/name.h"
#include "node/messages/obstacle_messages.h"
#include "node/moveit/scene_matrix.h"
#include "node/moveit/scene_plane.h"
#include "node/text/frame_names.h"
#include "node/wire/from_messages.h"

namespace hgrid {
namespace {

namespace msg = ::hgrid_proximity;
using moveit::CollisionObject;

constexpr std::size_t kMostTouchLinks = 1000;  // of one attached object
constexpr std::size_t kMostRemovals = 100;     // of all objects, in one planning scene
constexpr double kLargestPadding = 1e3;        // [m]

std::string whatOf(const CollisionObject& object) { return "object '" + printable(object.id) + "'"; }

/// Refuses to read a mesh file, because the messages of MoveIt name none.
std::shared_ptr<const TriangleMesh> noFile(const std::string& uri, const Eigen::Vector3d&) {
  throw Refusal(Code::unsupported, "'" + printable(uri) + "': messages of MoveIt cannot name mesh files");
}

bool isUnset(const geometry_msgs::Pose& pose) {
  const geometry_msgs::Point& p = pose.position;
  const geometry_msgs::Quaternion& q = pose.orientation;
  return p.x == 0.0 && p.y == 0.0 && p.z == 0.0 && q.x == 0.0 && q.y == 0.0 && q.z == 0.0 && (q.w == 0.0 || q.w == 1.0);
}

/// Appends shapes with their poses. A shape without a pose is at the origin.
/// @throws Refusal bad_geometry if there are more poses than shapes
template <class Part, class ShapeOf>
void appendShapes(const std::vector<Part>& parts, const std::vector<geometry_msgs::Pose>& poses, const char* kind,
                  const CollisionObject& object, const ShapeOf& shape_of, std::vector<msg::Shape>& shapes) {
  if (poses.size() > parts.size()) {
    throw Refusal(Code::bad_geometry, whatOf(object) + " has " + std::to_string(parts.size()) + " " + kind + " but " +
                                          std::to_string(poses.size()) + " poses of them");
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    msg::Shape shape = shape_of(parts[i]);
    if (i < poses.size()) shape.pose = poses[i];
    shapes.push_back(std::move(shape));
  }
}

msg::Shape fromPrimitive(const shape_msgs::SolidPrimitive& primitive, const CollisionObject& object) {
  msg::Shape shape;
  switch (primitive.type) {
    case shape_msgs::SolidPrimitive::BOX:
      shape.kind = msg::ShapeKind::BOX;
      break;
    case shape_msgs::SolidPrimitive::SPHERE:
      shape.kind = msg::ShapeKind::SPHERE;
      break;
    case shape_msgs::SolidPrimitive::CYLINDER:
      shape.kind = msg::ShapeKind::CYLINDER;
      break;
    case shape_msgs::SolidPrimitive::CONE:
      shape.kind = msg::ShapeKind::CONE;
      break;
    default:
      throw Refusal(Code::unsupported, whatOf(object) + ": the type of a primitive is " +
                                           std::to_string(primitive.type) +
                                           "; it must be 1 (BOX), 2 (SPHERE), 3 (CYLINDER) or 4 (CONE)");
  }
  shape.dimensions.assign(primitive.dimensions.begin(), primitive.dimensions.end());
  return shape;
}

msg::Shape fromMesh(const shape_msgs::Mesh& mesh) {
  msg::Shape shape;
  shape.kind = msg::ShapeKind::MESH;
  shape.mesh = mesh;
  return shape;
}

msg::Shape planeShape() {
  msg::Shape shape;
  shape.kind = msg::ShapeKind::PLANE;
  return shape;
}

std::vector<msg::Shape> shapesOf(const CollisionObject& object) {
  std::vector<msg::Shape> shapes;
  appendShapes(
      object.primitives, object.primitive_poses, "primitives", object,
      [&](const shape_msgs::SolidPrimitive& primitive) { return fromPrimitive(primitive, object); }, shapes);
  appendShapes(
      object.meshes, object.mesh_poses, "meshes", object, [](const shape_msgs::Mesh& mesh) { return fromMesh(mesh); },
      shapes);
  const std::size_t first = shapes.size();
  appendShapes(
      object.planes, object.plane_poses, "planes", object, [](const shape_msgs::Plane&) { return planeShape(); },
      shapes);
  for (std::size_t i = first; i < shapes.size(); ++i) {
    shapes[i].pose = poseOf(object.planes[i - first], shapes[i].pose, whatOf(object));
  }
  return shapes;
}

/// Returns the poses of all shapes that the message gives.
/// @throws Refusal bad_geometry if it gives poses of planes without the planes, whose coefficients are needed
std::vector<geometry_msgs::Pose> posesOf(const CollisionObject& object) {
  std::vector<geometry_msgs::Pose> poses = object.primitive_poses;
  poses.insert(poses.end(), object.mesh_poses.begin(), object.mesh_poses.end());
  if (object.plane_poses.size() != object.planes.size()) {
    throw Refusal(Code::bad_geometry, whatOf(object) + " has " + std::to_string(object.planes.size()) + " planes but " +
                                          std::to_string(object.plane_poses.size()) +
                                          " poses of them; to move planes, give the coefficients of each");
  }
  for (std::size_t i = 0; i < object.planes.size(); ++i) {
    poses.push_back(poseOf(object.planes[i], object.plane_poses[i], whatOf(object)));
  }
  return poses;
}

/// Returns the place of the object: where the frame of the message is at present.
ObstaclePlace placeOf(const CollisionObject& object, const geometry_msgs::Pose& pose) {
  ObstaclePlace place;
  place.frame = withoutSlash(object.header.frame_id);
  place.frame_from_body = fromPose(pose, "the pose of " + whatOf(object));
  checkWithin(place.frame_from_body.translation(), 1e6, "the pose of " + whatOf(object));
  place.at = Time(0);
  return place;
}

/// Returns a change of the obstacle that stands for the object. @throws Refusal bad_id
ObstacleChange changeOf(const CollisionObject& object, ObstacleChange::Kind kind) {
  checkLocal(object.id, "the id of an object");
  ObstacleChange change;
  change.kind = kind;
  change.name = joined("obstacle", object.id);
  return change;
}

ObstacleChange moved(const CollisionObject& object) {
  ObstacleChange change = changeOf(object, ObstacleChange::Kind::move);
  const std::vector<geometry_msgs::Pose> poses = posesOf(object);
  if (poses.size() == 1 && isUnset(object.pose)) {  // as in shapesOf() of an object with one shape
    change.place = placeOf(object, poses.front());
    change.shape_poses = {Pose::Identity()};
    return change;
  }
  change.place = placeOf(object, object.pose);
  for (const geometry_msgs::Pose& pose : poses) {
    change.shape_poses.push_back(fromPose(pose, "the pose of a shape of " + whatOf(object)));
    checkWithin(change.shape_poses.back().translation(), 1e6, "the pose of a shape of " + whatOf(object));
  }
  return change;
}

[[noreturn]] void refuseOperation(const CollisionObject& object, const char* allowed) {
  throw Refusal(Code::unsupported,
                whatOf(object) + ": operation is " + std::to_string(object.operation) + "; it must be " + allowed);
}

/// Each removal of all objects visits all obstacles. @throws Refusal limit if there are too many of them
void checkRemovals(const moveit::PlanningScene& scene) {
  const auto removes_all = [](const CollisionObject& object) {
    return object.operation == CollisionObject::REMOVE && object.id.empty();
  };
  std::size_t count = 0;
  for (const auto& object : scene.collision_objects) count += removes_all(object) ? 1 : 0;
  for (const auto& attached : scene.robot_state.attached_collision_objects)
    count += removes_all(attached.object) ? 1 : 0;
  if (count <= kMostRemovals) return;
  throw Refusal(Code::limit, "the planning scene removes or detaches all objects " + std::to_string(count) +
                                 " times; at most " + std::to_string(kMostRemovals) + " times are allowed");
}

/// Calls `act`, which appends changes. @throws ChangeRefusal instead of a Refusal, with the index of the change
template <class Act>
void numbered(ObstacleChanges& changes, const Act& act) {
  try {
    act();
  } catch (const Refusal& refusal) {
    throw ChangeRefusal(changes.changes.size(), refusal);
  }
}

}  // namespace

/// Returns a change that adds the object. @param placed_now  false: the object follows its frame
ObstacleChange SceneReader::added(const CollisionObject& object, bool placed_now) const {
  msg::Obstacle change;
  change.operation = msg::ObstacleOperation::ADD;
  change.name = object.id;
  change.replace = true;
  change.header.frame_id = object.header.frame_id;
  change.at_stamp = placed_now;  // with the stamp 0, which means the present pose
  change.pose = object.pose;
  change.shapes = shapesOf(object);
  if (change.shapes.size() == 1 && isUnset(object.pose)) {  // the origin of the only shape is that of the object
    change.pose = change.shapes.front().pose;
    change.shapes.front().pose = geometry_msgs::Pose();
  }
  return obstacleChangeOf(change, kSceneOwner, params_, narrow_phase_, noFile);
}

void SceneReader::appendObject(const CollisionObject& object, ObstacleChanges& changes) const {
  switch (object.operation) {
    case CollisionObject::ADD:
      changes.changes.push_back(added(object, true));
      changes.changes.back().free_only = true;
      break;
    case CollisionObject::APPEND:
      changes.changes.push_back(added(object, true));
      changes.changes.back().free_only = true;
      changes.changes.back().kind = ObstacleChange::Kind::append;
      break;
    case CollisionObject::MOVE:
      changes.changes.push_back(moved(object));
      break;
    case CollisionObject::REMOVE:
      if (object.id.empty()) {
        ObstacleChange all;
        all.kind = ObstacleChange::Kind::remove_all_free;
        all.owner = kSceneOwner;
        changes.changes.push_back(std::move(all));
      } else {
        changes.changes.push_back(changeOf(object, ObstacleChange::Kind::remove));
        changes.changes.back().free_only = true;
      }
      break;
    default:
      refuseOperation(object, "0 (ADD), 1 (REMOVE), 2 (APPEND) or 3 (MOVE)");
  }
}

void SceneReader::appendAttached(const moveit::AttachedCollisionObject& attached, ObstacleChanges& changes) const {
  const CollisionObject& object = attached.object;
  if (object.operation == CollisionObject::REMOVE) {
    ObstacleChange change;
    if (!object.id.empty()) {
      change = changeOf(object, ObstacleChange::Kind::detach);
    } else {
      change.kind = ObstacleChange::Kind::detach_all;
      change.owner = kSceneOwner;
      change.link = attached.link_name;
    }
    changes.changes.push_back(std::move(change));
    return;
  }
  if (object.operation != CollisionObject::ADD) refuseOperation(object, "0 (ADD) or 1 (REMOVE)");
  if (attached.touch_links.size() > kMostTouchLinks) {
    throw Refusal(Code::limit, whatOf(object) + ": touch_links has " + std::to_string(attached.touch_links.size()) +
                                   " names; at most " + std::to_string(kMostTouchLinks) + " are allowed");
  }
  auto attachment = std::make_shared<Attachment>();
  attachment->link = attached.link_name;
  attachment->without_robot = true;
  attachment->owner = kSceneOwner;
  for (const std::string& link : attached.touch_links) {
    checkLocal(link, "a name in touch_links of " + whatOf(object));
    attachment->touch_links.push_back(link);
  }
  ObstacleChange attach = changeOf(object, ObstacleChange::Kind::attach);
  attach.in_set = true;
  if (!object.primitives.empty() || !object.meshes.empty() || !object.planes.empty()) {
    const bool at_link = isNameOfLink(withoutSlash(object.header.frame_id), attached.link_name);
    ObstacleChange add = added(object, !at_link);
    if (at_link) attachment->link_from_body = add.added->place.frame_from_body;
    changes.changes.push_back(std::move(add));
  }
  attach.attachment = std::move(attachment);
  changes.changes.push_back(std::move(attach));
}

ObstacleChanges SceneReader::changesOf(const CollisionObject& object) const {
  ObstacleChanges changes;
  numbered(changes, [&] { appendObject(object, changes); });
  return changes;
}

ObstacleChanges SceneReader::changesOf(const moveit::AttachedCollisionObject& attached) const {
  ObstacleChanges changes;
  numbered(changes, [&] { appendAttached(attached, changes); });
  return changes;
}

ObstacleChanges SceneReader::changesOf(const moveit::PlanningScene& scene) const {
  const std::size_t count = scene.collision_objects.size() + scene.robot_state.attached_collision_objects.size();
  const auto most = static_cast<std::size_t>(params_.max_bodies);
  if (count > most) {
    throw Refusal(Code::limit, "the planning scene has " + std::to_string(count) + " objects; at most " +
                                   std::to_string(most) + " are allowed (~limits/max_bodies)");
  }
  checkRemovals(scene);
  ObstacleChanges changes;
  if (!scene.is_diff) {
    changes.complete_set_of = kSceneOwner;
    // MoveIt detaches everything only if the message contains a complete state of the robot.
    changes.spare_attached = scene.robot_state.is_diff || (scene.robot_state.joint_state.name.empty() &&
                                                           scene.robot_state.multi_dof_joint_state.joint_names.empty());
  }
  std::set<std::string> attached, begun;
  for (const auto& one : scene.robot_state.attached_collision_objects) {  // MoveIt applies these first
    numbered(changes, [&] { appendAttached(one, changes); });
    if (one.object.operation == CollisionObject::ADD) attached.insert(one.object.id);
  }
  for (const moveit::CollisionObject& object : scene.collision_objects) {
    const bool left = object.operation == CollisionObject::REMOVE && attached.count(object.id) != 0;
    if (left) continue;  // it left MoveIt's world when it was attached
    numbered(changes, [&] { appendObject(object, changes); });
    const bool begins = begun.insert(object.id).second;
    // In a complete scene, no object is there before its first shapes are added.
    if (!scene.is_diff && begins && object.operation == CollisionObject::APPEND) {
      changes.changes.back().kind = ObstacleChange::Kind::add;
    }
  }
  return changes;
}

SceneExtras SceneReader::extrasOf(const moveit::PlanningScene& scene) const {
  SceneExtras extras;
  extras.complete = !scene.is_diff;
  for (const moveit::LinkNumber& padding : scene.link_padding) {
    checkLocal(padding.link_name, "a name in link_padding");
    const std::string what = "the padding of link '" + printable(padding.link_name) + "'";
    if (!(padding.value >= 0.0 && padding.value <= kLargestPadding)) {
      throw Refusal(Code::out_of_range,
                    what + " is " + text(padding.value) + " m; it must be within 0 .. " + text(kLargestPadding) + " m");
    }
    if (!extras.paddings.emplace(padding.link_name, padding.value).second) {
      throw Refusal(Code::dup_id, what + " is given twice; give each link one padding");
    }
  }
  const moveit::AllowedCollisionMatrix& matrix = scene.allowed_collision_matrix;
  const bool has_matrix = !scene.is_diff || !matrix.entry_names.empty() || !matrix.default_entry_names.empty();
  if (params_.moveit_matrix && has_matrix) {
    extras.matrix = matrixRulesOf(matrix, static_cast<std::size_t>(params_.max_rules));
  }
  return extras;
}

LinkPaddings paddingsAfter(const SceneExtras& extras, const LinkPaddings& before, std::size_t most) {
  LinkPaddings after;
  if (!extras.complete) after = before;
  for (const auto& [link, padding] : extras.paddings) {
    if (padding == 0.0) {
      after.erase(link);
    } else {
      after[link] = padding;
    }
  }
  if (after.size() <= most) return after;
  throw Refusal(Code::limit, "there would be paddings of " + std::to_string(after.size()) + " links; at most " +
                                 std::to_string(most) + " are allowed (~limits/max_links)");
}

}  // namespace hgrid
