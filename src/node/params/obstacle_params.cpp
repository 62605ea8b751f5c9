// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/params/obstacle_params.h"

#include <cmath>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"
#include "node/tf/frame_names.h"

namespace hgrid {
namespace {

constexpr double kFarthest = 1e6;  // largest coordinate [m] and angle [rad] of a pose

void readLength(ParamValue& shape, const char* key, double& length) {
  // Accept any number here. Shape checks the value and explains what is wrong with it.
  if (auto value = shape.require(key)) value->number(length, -HUGE_VAL, HUGE_VAL, "m");
}

Shape readPrimitive(ParamValue& value, const std::string& type, const ShapeLimits& limits) {
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
  if (type != "cylinder" && type != "cone" && type != "capsule") {
    throw Refusal(Code::unsupported,
                  "has type '" + printable(type, 48) + "'; it must be box, sphere, cylinder, cone or capsule");
  }
  readLength(value, "height", height);
  readLength(value, "radius", radius);
  if (type == "cylinder") return Shape::cylinder(height, radius, limits);
  return type == "cone" ? Shape::cone(height, radius, limits) : Shape::capsule(height, radius, limits);
}

void readShape(ParamValue value, const ShapeLimits& limits, std::vector<BodyShape>& shapes) {
  if (!value.requireStruct()) return;
  std::string type;
  if (auto named = value.require("type")) named->string(type);
  Pose pose = Pose::Identity();
  if (auto given = value.get("pose")) pose = readPose(*given);
  try {
    shapes.push_back({readPrimitive(value, type, limits), pose, 0.0, {}, Eigen::Vector3d::Ones()});
  } catch (const Refusal& refusal) {
    value.error(std::string(refusal.code() == Code::unsupported ? "" : "is not a valid shape: ") + refusal.what());
  }
  value.finish("field of a shape");
}

}  // namespace

Pose readPose(ParamValue value) {
  Pose pose = Pose::Identity();
  if (!value.requireStruct()) return pose;
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero(), rpy = Eigen::Vector3d::Zero();
  if (auto given = value.get("xyz")) given->vector(xyz, kFarthest);
  if (auto given = value.get("rpy")) given->vector(rpy, kFarthest);
  value.finish("field of a pose (xyz, rpy)");
  pose.translation() = xyz;
  pose.linear() =
      (Eigen::AngleAxisd(rpy[2], Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy[1], Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(rpy[0], Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
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

std::vector<ObstacleParams> readObstacles(ParamValue value, const ShapeLimits& limits) {
  std::vector<ObstacleParams> obstacles;
  std::set<std::string> names;
  for (ParamValue& element : value.elements()) {
    if (!element.requireStruct()) continue;
    ObstacleParams obstacle;
    std::string name;
    readLocalName(element, name, names);
    obstacle.body.name = joined("obstacle", name);
    if (auto frame = element.get("frame")) frame->string(obstacle.body.frame);
    obstacle.body.frame = withoutSlash(obstacle.body.frame);
    if (auto pose = element.get("pose")) obstacle.body.frame_from_body = readPose(*pose);
    if (auto shapes = element.require("shapes")) {
      const std::vector<ParamValue> list = shapes->elements();
      if (list.empty()) shapes->error("has no shape; it must have at least one");
      for (const ParamValue& shape : list) readShape(shape, limits, obstacle.body.shapes);
    }
    element.finish("field of an obstacle (name, frame, pose, shapes)");
    obstacles.push_back(std::move(obstacle));
  }
  return obstacles;
}

}  // namespace hgrid
