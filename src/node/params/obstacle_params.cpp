// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/params/obstacle_params.h"

#include <array>
#include <cmath>
#include <memory>

#include "geometry/rotation.h"
#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/pairs/pair_rule.h"
#include "hgrid_proximity/refusal.h"
#include "node/text/frame_names.h"

namespace hgrid {
namespace {

constexpr double kFarthest = 1e6;           // largest coordinate [m] and angle [rad] of a pose
constexpr std::size_t kLongestOwner = 512;  // [byte]

void readLength(ParamValue& shape, const char* key, double& length) {
  // Accept any number here. Shape checks the value and explains what is wrong with it.
  if (auto value = shape.require(key)) value->number(length, -HUGE_VAL, HUGE_VAL, "m");
}

/// Reads the vertices of a hull, or the vertices and triangles of a mesh.
std::shared_ptr<const TriangleMesh> readMesh(ParamValue& shape, bool has_triangles, const Params& params) {
  auto mesh = std::make_shared<TriangleMesh>();
  if (auto vertices = shape.require("vertices")) {
    for (ParamValue& vertex : vertices->elements()) {
      mesh->vertices.emplace_back(Eigen::Vector3d::Zero());
      vertex.vector(mesh->vertices.back(), HUGE_VAL);
    }
  }
  if (!has_triangles) return mesh;
  const auto triangles = shape.require("triangles");
  if (!triangles) return mesh;
  const auto most = static_cast<std::size_t>(params.max_mesh_triangles);
  std::vector<ParamValue> list = ParamValue(*triangles).elements();
  if (list.size() > most) {
    throw Refusal(Code::limit, "the mesh has " + std::to_string(list.size()) + " triangles; at most " +
                                   std::to_string(most) + " are allowed (~limits/max_mesh_triangles)");
  }
  for (ParamValue& triangle : list) {
    std::vector<ParamValue> corners = triangle.elements();
    if (corners.size() != 3) {
      triangle.error("must be a list of 3 indices of vertices");
      continue;
    }
    std::array<std::uint32_t, 3> indices{};
    for (std::size_t i = 0; i < 3; ++i) {
      int index = 0;
      corners[i].integer(index, 0, static_cast<int>(mesh->vertices.size()) - 1);
      indices[i] = static_cast<std::uint32_t>(index);
    }
    mesh->triangles.push_back(indices);
  }
  return mesh;
}

Shape makeShape(ParamValue& value, const std::string& type, const Params& params) {
  const ShapeLimits limits = params.shapeLimits();
  double height = 1.0, radius = 1.0;
  if (type == "box") {
    Eigen::Vector3d size = Eigen::Vector3d::Ones();
    if (auto sides = value.require("size")) sides->vector(size, HUGE_VAL);
    return Shape::box(size, limits);
  }
  if (type == "sphere") {
    readLength(value, "radius", radius);
    return Shape::sphere(radius, limits);
  }
  if (type == "plane") return Shape::plane();
  if (type == "hull") return Shape::hull(readMesh(value, false, params), limits);
  if (type == "mesh") return Shape::mesh(readMesh(value, true, params), limits);
  if (type != "cylinder" && type != "cone" && type != "capsule") {
    throw Refusal(Code::unsupported, "has type '" + printable(type, 48) +
                                         "'; it must be box, sphere, cylinder, cone, capsule, hull, mesh or plane");
  }
  readLength(value, "height", height);
  readLength(value, "radius", radius);
  if (type == "cylinder") return Shape::cylinder(height, radius, limits);
  return type == "cone" ? Shape::cone(height, radius, limits) : Shape::capsule(height, radius, limits);
}

void readShape(ParamValue value, const Params& params, std::vector<BodyShape>& shapes) {
  if (!value.requireStruct()) return;
  std::string type;
  if (auto named = value.require("type")) named->string(type);
  Pose pose = Pose::Identity();
  if (auto given = value.get("pose")) pose = readPose(*given);
  double padding = 0.0;
  if (auto given = value.get("padding")) given->number(padding, 0.0, 1e3, "m");
  try {
    shapes.push_back({makeShape(value, type, params), pose, padding, {}, Eigen::Vector3d::Ones()});
  } catch (const Refusal& refusal) {
    value.error(std::string(refusal.code() == Code::unsupported ? "" : "is not a valid shape: ") + refusal.what());
  }
  value.finish("field of a shape");
}

/// Reads the four numbers of a quaternion, x first.
Eigen::Quaterniond readQuaternion(ParamValue value) {
  Eigen::Vector4d xyzw(0.0, 0.0, 0.0, 1.0);
  std::vector<ParamValue> numbers = value.elements();
  if (numbers.size() != 4) {
    value.error("has " + std::to_string(numbers.size()) + " elements; it must have 4: x, y, z, w");
    return Eigen::Quaterniond::Identity();
  }
  for (int i = 0; i < 4; ++i) numbers[static_cast<std::size_t>(i)].number(xyzw[i], -2.0, 2.0, "");
  try {
    return Eigen::Quaterniond(checkedPose(Eigen::Vector3d::Zero(), xyzw, "its rotation").linear());
  } catch (const Refusal& refusal) {
    value.error(std::string("is not a rotation: ") + refusal.what());
    return Eigen::Quaterniond::Identity();
  }
}

/// Reads {link, pose, touch}.
void readAttached(ParamValue value, ParamValue& element, ObstacleParams& obstacle) {
  if (!value.requireStruct()) return;
  if (element.get("frame") || element.get("pose"))
    element.error("has attached, and frame or pose; the pose of an attached obstacle is in attached/pose");
  const std::string local = obstacle.body.name.substr(obstacle.body.name.find('/') + 1);
  if (isGlob(local)) {  // a rule with this name would also be about other obstacles
    element.error("is attached, but its name '" + printable(local) +
                  "' contains *; the names of attached obstacles must not");
  }
  AttachedParams attached;
  if (auto link = value.require("link")) {
    link->string(attached.link);
    if (attached.link.find('/') == std::string::npos || isGlob(attached.link))
      link->error("is '" + printable(attached.link) + "'; it must be the name robot/link of a link");
  }
  if (auto pose = value.get("pose")) attached.link_from_body = readPose(*pose);
  if (auto touch = value.get("touch")) {
    touch->strings(attached.touch);
    for (const std::string& glob : attached.touch) {
      try {
        checkRule(PairRule{obstacle.body.name, glob, ""});
      } catch (const Refusal& refusal) {
        touch->error(refusal.what());
      }
    }
  }
  value.finish("field of attached (link, pose, touch)");
  obstacle.attached = std::move(attached);
}

void readObstacle(ParamValue& element, const Params& params, ObstacleParams& obstacle) {
  if (auto frame = element.get("frame")) frame->string(obstacle.body.frame);
  obstacle.body.frame = withoutSlash(obstacle.body.frame);
  if (auto pose = element.get("pose")) obstacle.body.frame_from_body = readPose(*pose);
  if (auto shapes = element.require("shapes")) readShapes(*shapes, params, obstacle.body.shapes);
  if (auto given = element.get("moving")) given->flag(obstacle.moving);
  if (auto given = element.get("margin")) given->number(obstacle.margin, 0.0, 1e3, "m");
  if (auto given = element.get("max_speed")) given->number(obstacle.max_speed, 0.0, 1e6, "m/s");
  if (auto given = element.get("lifetime")) given->number(obstacle.lifetime, 0.0, 1e9, "s");
  if (auto given = element.get("lost_at_end")) given->flag(obstacle.lost_at_end);
  if (auto given = element.get("owner")) {
    given->string(obstacle.owner);
    if (obstacle.owner.size() > kLongestOwner || printable(obstacle.owner, kLongestOwner) != obstacle.owner) {
      given->error("is '" + printable(obstacle.owner, 48) +
                   "'; it must be UTF-8 without control characters, of at most " + std::to_string(kLongestOwner) +
                   " bytes");
    }
  }
  if (auto given = element.get("group")) {
    given->string(obstacle.body.group);
    try {
      if (!obstacle.body.group.empty()) checkLocal(obstacle.body.group, "it");
    } catch (const Refusal& refusal) {
      given->error(std::string("is not a valid name: ") + refusal.what());
    }
  }
  if (auto given = element.get("attached")) readAttached(*given, element, obstacle);
  element.finish(
      "field of an obstacle (name, frame, pose, shapes, moving, margin, max_speed, lifetime, lost_at_end, owner, "
      "group, attached)");
}

}  // namespace

void readShapes(ParamValue value, const Params& params, std::vector<BodyShape>& shapes) {
  const std::vector<ParamValue> list = value.elements();
  if (list.empty()) value.error("has no shape; it must have at least one");
  for (const ParamValue& shape : list) readShape(shape, params, shapes);
}

Pose readPose(ParamValue value) {
  Pose pose = Pose::Identity();
  if (!value.requireStruct()) return pose;
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero(), rpy = Eigen::Vector3d::Zero();
  if (auto given = value.get("xyz")) given->vector(xyz, kFarthest);
  const auto quaternion = value.get("quaternion");
  if (auto given = value.get("rpy")) {
    given->vector(rpy, kFarthest);
    if (quaternion) value.error("has rpy and quaternion; it must have only one of them");
  }
  value.finish("field of a pose (xyz, rpy, quaternion)");
  pose.translation() = xyz;
  if (quaternion) {
    pose.linear() = readQuaternion(*quaternion).toRotationMatrix();
    return pose;
  }
  pose.linear() = rotationOf(rpy).toRotationMatrix();
  return pose;
}

void readLocalName(ParamValue& element, std::string& name, std::set<std::string>& names) {
  auto given = element.require("name");
  if (!given) return;
  given->string(name);
  try {
    checkLocal(name, "it");
  } catch (const Refusal& refusal) {
    given->error(std::string("is not a valid name: ") + refusal.what());
  }
  if (!names.insert(name).second)
    given->error("is '" + printable(name) + "', which is already used; names must differ");
}

std::vector<ObstacleParams> readObstacles(ParamValue value, const Params& params) {
  std::vector<ObstacleParams> obstacles;
  std::set<std::string> names;
  for (ParamValue& element : value.elements()) {
    if (!element.requireStruct()) continue;
    ObstacleParams obstacle;
    std::string name;
    readLocalName(element, name, names);
    obstacle.body.name = joined("obstacle", name);
    readObstacle(element, params, obstacle);
    obstacles.push_back(std::move(obstacle));
  }
  return obstacles;
}

std::vector<PairRule> readRules(ParamValue value) {
  std::vector<PairRule> rules;
  for (ParamValue& element : value.elements()) {
    if (!element.requireStruct()) continue;
    PairRule rule;
    if (auto given = element.require("first")) given->string(rule.first);
    if (auto given = element.require("second")) given->string(rule.second);
    if (auto given = element.get("reason")) given->string(rule.reason);
    if (auto given = element.get("allowed")) given->flag(rule.allowed);
    element.finish("field of an allowed pair (first, second, reason, allowed)");
    rules.push_back(std::move(rule));
  }
  return rules;
}

}  // namespace hgrid
