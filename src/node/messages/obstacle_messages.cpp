// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/obstacle_messages.h"

#include <hgrid_proximity/LifetimeEnd.h>
#include <hgrid_proximity/ObstacleOperation.h>
#include <hgrid_proximity/ShapeKind.h>

#include <algorithm>
#include <utility>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/pairs/pair_rule.h"
#include "node/params/body_params.h"
#include "node/text/frame_names.h"
#include "node/time/ros_time.h"
#include "node/wire/from_messages.h"

namespace hgrid {
namespace {

namespace msg = ::hgrid_proximity;

constexpr std::size_t kMostGlobs = 100;    // globs of one obstacle over the bodies that may touch it
constexpr std::size_t kLongestText = 512;  // [byte] length of the name of a frame or an owner

/// Returns a name for error sentences.
std::string whatOf(const msg::Obstacle& change) { return "obstacle '" + printable(change.name) + "'"; }

/// @throws Refusal out_of_range unless 0 <= value <= most
void checkAmount(const msg::Obstacle& change, const char* field, double value, double most, const char* unit) {
  if (value >= 0.0 && value <= most) return;
  throw Refusal(Code::out_of_range, whatOf(change) + ": its " + field + " is " + text(value) + " " + unit +
                                        "; it must be within 0 .. " + text(most));
}

/// @throws Refusal bad_id unless the text is short, printable UTF-8
void checkText(const std::string& text, const std::string& what) {
  if (text.size() <= kLongestText && printable(text, kLongestText) == text) return;
  throw Refusal(Code::bad_id, what + " is '" + printable(text, 48) +
                                  "'; it must be UTF-8 without control characters, " + "of at most " +
                                  std::to_string(kLongestText) + " bytes");
}

ObstaclePlace placeOf(const msg::Obstacle& change) {
  ObstaclePlace place;
  checkText(change.header.frame_id, "the frame of " + whatOf(change));
  place.frame = withoutSlash(change.header.frame_id);
  place.frame_from_body = fromPose(change.pose, "the pose of " + whatOf(change));
  checkWithin(place.frame_from_body.translation(), 1e6, "the pose of " + whatOf(change));
  if (change.at_stamp) place.at = fromRos(change.header.stamp);
  return place;
}

/// @throws Refusal unsupported if the change uses what this version does not offer
void checkOffered(const msg::Obstacle& change) {
  if (change.lifetime_end <= msg::LifetimeEnd::LOST) return;
  throw Refusal(Code::unsupported,
                whatOf(change) + ": lifetime_end must be REMOVE (0) or LOST (1) in this version of the node");
}

/// Reads the mesh file of a shape.
Shape fromFile(const msg::Shape& source, const Eigen::Vector3d& scale, const Params& params, const MeshSource& meshes) {
  const std::string resource = "a shape with the resource '" + printable(source.resource) + "'";
  const bool is_hull = source.kind == msg::ShapeKind::HULL;
  if (!is_hull && source.kind != msg::ShapeKind::MESH) {
    throw Refusal(Code::bad_geometry, resource + " must be of the kind MESH or HULL");
  }
  if (!source.mesh.vertices.empty()) throw Refusal(Code::bad_geometry, resource + " must have an empty mesh");
  const std::shared_ptr<const TriangleMesh> mesh = meshes(source.resource, scale);
  return is_hull ? Shape::hull(mesh, params.shapeLimits()) : Shape::mesh(mesh, params.shapeLimits());
}

BodyShape shapeOf(const msg::Shape& source, const msg::Obstacle& change, const Params& params,
                  const MeshSource& meshes) {
  checkAmount(change, "padding", source.padding, 1e3, "m");
  const std::string what = whatOf(change);
  const Pose pose = fromPose(source.pose, "the pose of a shape of " + what);
  checkWithin(pose.translation(), 1e6, "the pose of a shape of " + what);
  Eigen::Vector3d scale(source.scale.x, source.scale.y, source.scale.z);
  if (source.resource.empty() || scale.isZero(0.0)) scale = Eigen::Vector3d::Ones();
  try {
    const auto most_triangles = static_cast<std::size_t>(params.max_mesh_triangles);
    return {source.resource.empty() ? fromShape(source, params.shapeLimits(), most_triangles)
                                    : fromFile(source, scale, params, meshes),
            pose, source.padding, source.resource, scale};
  } catch (const Refusal& refusal) {
    throw Refusal(refusal.code(), what + ": " + refusal.what());
  }
}

std::shared_ptr<const RequestedObstacle> addedBy(const msg::Obstacle& change, const std::string& name,
                                                 const std::string& caller, const Params& params,
                                                 NarrowPhase& narrow_phase, const MeshSource& meshes) {
  checkOffered(change);
  if (change.shapes.empty())
    throw Refusal(Code::bad_geometry, whatOf(change) + " has no shape; it must have at least one");
  if (change.shapes.size() > kMostShapes) {
    throw Refusal(Code::limit, whatOf(change) + " has " + std::to_string(change.shapes.size()) + " shapes; at most " +
                                   std::to_string(kMostShapes) + " are allowed");
  }
  checkText(change.owner, "the owner of " + whatOf(change));
  if (!change.group.empty()) checkLocal(change.group, "the group of " + whatOf(change));
  checkAmount(change, "margin", change.margin, 1e3, "m");
  checkAmount(change, "max_speed", change.max_speed, 1e6, "m/s");
  checkAmount(change, "lifetime", change.lifetime.toSec(), 1e9, "s");
  auto added = std::make_shared<RequestedObstacle>();
  Body& body = added->body;
  body.name = name;
  body.group = change.group;
  for (const msg::Shape& shape : change.shapes) body.shapes.push_back(shapeOf(shape, change, params, meshes));
  completeObstacle(params, change.margin, change.max_speed, narrow_phase, body);
  added->place = placeOf(change);
  added->moving = change.moving;
  added->lost_at_end = change.lifetime_end == msg::LifetimeEnd::LOST;
  added->owner = change.owner.empty() ? caller : change.owner;
  added->lifetime = std::chrono::nanoseconds(change.lifetime.toNSec());
  return added;
}

std::shared_ptr<const Attachment> attachmentOf(const msg::Obstacle& change, const std::string& caller) {
  if (change.touch.size() > kMostGlobs) {
    throw Refusal(Code::limit, whatOf(change) + ": touch has " + std::to_string(change.touch.size()) +
                                   " globs; at most " + std::to_string(kMostGlobs) + " are allowed");
  }
  auto attachment = std::make_shared<Attachment>();
  attachment->link = change.link;
  attachment->touch = change.touch;
  attachment->owner = caller;
  for (const std::string& glob : change.touch) checkRule(PairRule{joined("obstacle", change.name), glob, ""});
  if (change.at_attach_pose) {
    attachment->link_from_body = fromPose(change.attach_pose, "the attach_pose of " + whatOf(change));
    checkWithin(attachment->link_from_body->translation(), 1e6, "the attach_pose of " + whatOf(change));
  }
  return attachment;
}

}  // namespace

ObstacleChange obstacleChangeOf(const msg::Obstacle& source, const std::string& caller, const Params& params,
                                NarrowPhase& narrow_phase, const MeshSource& meshes) {
  checkLocal(source.name, "the name of an obstacle");
  ObstacleChange change;
  change.name = joined("obstacle", source.name);
  switch (source.operation) {
    case msg::ObstacleOperation::ADD:
      change.added = addedBy(source, change.name, caller, params, narrow_phase, meshes);
      change.replace = source.replace;
      break;
    case msg::ObstacleOperation::MOVE:
      change.kind = ObstacleChange::Kind::move;
      change.place = placeOf(source);
      break;
    case msg::ObstacleOperation::REMOVE:
      change.kind = ObstacleChange::Kind::remove;
      break;
    case msg::ObstacleOperation::ATTACH:
      change.kind = ObstacleChange::Kind::attach;
      change.attachment = attachmentOf(source, caller);
      break;
    case msg::ObstacleOperation::DETACH:
      change.kind = ObstacleChange::Kind::detach;
      break;
    default:
      throw Refusal(Code::unsupported, whatOf(source) + ": operation is " + std::to_string(source.operation) +
                                           "; it must be 0 (ADD), 1 (MOVE), 2 (REMOVE), 3 (ATTACH) or 4 (DETACH)");
  }
  return change;
}

ObstacleChanges obstacleChangesOf(const msg::ApplyObstacles::Request& request, const std::string& caller,
                                  const Params& params, NarrowPhase& narrow_phase, const MeshSource& meshes) {
  const auto most = 4 * static_cast<std::size_t>(params.max_bodies);
  if (request.changes.size() > most) {
    throw Refusal(Code::limit, "the request has " + std::to_string(request.changes.size()) + " changes; at most " +
                                   std::to_string(most) + " are allowed (4 * ~limits/max_bodies)");
  }
  ObstacleChanges changes;
  checkText(request.owner, "the owner of the complete set");
  if (request.complete_set) {
    changes.complete_set_of = request.owner.empty() ? caller : request.owner;
    if (changes.complete_set_of->empty())
      throw Refusal(Code::bad_id, "complete_set needs an owner; owner is empty and the caller has no name: set owner");
  }
  for (std::size_t i = 0; i < request.changes.size(); ++i) {
    try {
      changes.changes.push_back(obstacleChangeOf(request.changes[i], caller, params, narrow_phase, meshes));
    } catch (const Refusal& refusal) {
      throw ChangeRefusal(i, refusal);
    }
  }
  return changes;
}

}  // namespace hgrid
