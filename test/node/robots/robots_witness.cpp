// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "robots_witness.h"

#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace hgrid {
namespace test {
namespace {

using tinyxml2::XMLElement;

constexpr double kPi = 3.14159265358979323846;

template <class Visit>
void forEach(const XMLElement* parent, const char* tag, Visit&& visit) {
  for (auto* child = parent->FirstChildElement(tag); child; child = child->NextSiblingElement(tag)) visit(*child);
}

Eigen::Vector3d numbers(const XMLElement* element, const char* attribute, Eigen::Vector3d otherwise) {
  if (element && element->Attribute(attribute)) {
    std::istringstream text(element->Attribute(attribute));
    text >> otherwise[0] >> otherwise[1] >> otherwise[2];
  }
  return otherwise;
}

Eigen::Isometry3d originOf(const XMLElement& element) {
  const XMLElement* origin = element.FirstChildElement("origin");
  const Eigen::Vector3d rpy = numbers(origin, "rpy", Eigen::Vector3d::Zero());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(numbers(origin, "xyz", Eigen::Vector3d::Zero()));
  pose.rotate(Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()));
  pose.rotate(Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()));
  pose.rotate(Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()));
  return pose;
}

/// Reads the vertices of a binary STL file. The file has a header of 80 bytes and a count. Then each triangle has a
/// normal, three vertices and two more bytes.
std::vector<Eigen::Vector3d> verticesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  std::uint32_t triangles = 0;
  if (bytes.size() >= 84) std::memcpy(&triangles, &bytes[80], sizeof(triangles));
  if (triangles == 0 || bytes.size() != 84 + 50 * std::size_t(triangles)) {
    throw std::runtime_error(path + " is not a binary STL file");
  }
  std::vector<Eigen::Vector3d> vertices;
  for (std::size_t at = 84; at < bytes.size(); at += 50) {
    float numbers[12];
    std::memcpy(numbers, &bytes[at], sizeof(numbers));
    for (int i = 3; i < 12; i += 3) vertices.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  }
  return vertices;
}

std::vector<Eigen::Vector3d> pointsOf(const XMLElement& collision,
                                      const std::function<std::string(const std::string& uri)>& file_of) {
  const XMLElement* geometry = collision.FirstChildElement("geometry");
  std::vector<Eigen::Vector3d> points;
  if (const XMLElement* box = geometry->FirstChildElement("box")) {
    const Eigen::Vector3d half = 0.5 * numbers(box, "size", Eigen::Vector3d::Zero());
    for (int bits = 0; bits < 8; ++bits) {
      points.emplace_back(bits & 1 ? half.x() : -half.x(), bits & 2 ? half.y() : -half.y(),
                          bits & 4 ? half.z() : -half.z());
    }
  } else if (const XMLElement* mesh = geometry->FirstChildElement("mesh")) {
    points = verticesOf(file_of(mesh->Attribute("filename")));
    const Eigen::Vector3d scale = numbers(mesh, "scale", Eigen::Vector3d::Ones());
    for (Eigen::Vector3d& point : points) point = point.cwiseProduct(scale);
  } else {
    throw std::runtime_error("the witness reads only boxes and meshes");
  }
  const Eigen::Isometry3d link_from_shape = originOf(collision);
  for (Eigen::Vector3d& point : points) point = link_from_shape * point;
  return points;
}

void parse(tinyxml2::XMLDocument& document, const std::string& text) {
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) throw std::runtime_error("not XML");
}

}  // namespace

WitnessBox grown(const WitnessBox& box, double by) { return {box.min.array() - by, box.max.array() + by}; }

double gap(const WitnessBox& a, const WitnessBox& b) {
  return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0).norm();
}

double gap(const WitnessBox& box, const Eigen::Vector3d& point) { return gap(box, WitnessBox{point, point}); }

double firstTouch(const WitnessBox& box, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius) {
  const auto at = [&](double t) { return gap(box, from + t * (to - from)); };
  double low = 0.0, high = 1.0;  // a ternary search finds the minimum, because the distance is convex in t
  for (int i = 0; i < 100; ++i) {
    const double third = (high - low) / 3.0;
    if (at(low + third) <= at(high - third)) {
      high -= third;
    } else {
      low += third;
    }
  }
  if (at(0.0) <= radius) return 0.0;
  if (at(high) > radius) return std::numeric_limits<double>::infinity();
  for (low = 0.0; high - low > 1e-12;) {
    const double middle = 0.5 * (low + high);
    (at(middle) <= radius ? high : low) = middle;
  }
  return high * (to - from).norm();
}

WitnessRobot::WitnessRobot(const std::string& urdf, const std::string& srdf,
                           const std::function<std::string(const std::string& uri)>& file_of) {
  tinyxml2::XMLDocument robot, semantic;
  parse(robot, urdf);
  parse(semantic, srdf);
  std::set<std::string> roots;
  forEach(robot.RootElement(), "link", [&](const XMLElement& link) {
    const std::string name = link.Attribute("name");
    roots.insert(name);
    forEach(&link, "collision",
            [&](const XMLElement& collision) { shapes_[name].push_back(pointsOf(collision, file_of)); });
  });
  forEach(robot.RootElement(), "joint", [&](const XMLElement& joint) {
    readJoint(joint);
    roots.erase(joint.FirstChildElement("child")->Attribute("link"));
  });
  root_ = *roots.begin();
  forEach(semantic.RootElement(), "disable_collisions",
          [&](const XMLElement& rule) { may_touch_.emplace(rule.Attribute("link1"), rule.Attribute("link2")); });
}

void WitnessRobot::readJoint(const XMLElement& element) {
  Joint joint;
  joint.name = element.Attribute("name");
  joint.type = element.Attribute("type");
  joint.parent = element.FirstChildElement("parent")->Attribute("link");
  joint.child = element.FirstChildElement("child")->Attribute("link");
  joint.origin = originOf(element);
  joint.axis = numbers(element.FirstChildElement("axis"), "xyz", joint.axis).normalized();
  const XMLElement* limit = element.FirstChildElement("limit");
  if (joint.type == "continuous") {
    joint.lower = -kPi;
    joint.upper = kPi;
  } else if (joint.type == "revolute" || joint.type == "prismatic") {
    joint.lower = limit->DoubleAttribute("lower");
    joint.upper = limit->DoubleAttribute("upper");
  } else if (joint.type != "fixed") {
    throw std::runtime_error("the witness does not know joints of type " + joint.type);
  }
  if (const XMLElement* mimic = element.FirstChildElement("mimic")) {
    joint.mimics = mimic->Attribute("joint");
    mimic->QueryDoubleAttribute("multiplier", &joint.multiplier);
    mimic->QueryDoubleAttribute("offset", &joint.offset);
  }
  joints_[joint.child] = joint;
}

std::string WitnessRobot::rigidGroup(std::string link) const {
  while (link != root_ && joints_.at(link).type == "fixed") link = joints_.at(link).parent;
  return link;
}

/// Returns whether one moving joint connects two rigid groups, with `upper` as the parent. A chain of joints counts as
/// one joint if the groups between them have no shapes and successive joint origins are at most 1 cm apart.
bool WitnessRobot::isAdjacent(const std::string& upper, std::string group) const {
  while (group != root_) {
    const Joint& joint = joints_.at(group);
    const std::string parent = rigidGroup(joint.parent);
    if (parent == upper) return true;
    Eigen::Isometry3d group_from_joint = joint.origin;
    for (std::string link = joint.parent; link != parent; link = joints_.at(link).parent) {
      group_from_joint = joints_.at(link).origin * group_from_joint;
    }
    const bool has_shapes = std::any_of(shapes_.begin(), shapes_.end(),
                                        [&](const auto& named) { return rigidGroup(named.first) == parent; });
    if (has_shapes || group_from_joint.translation().norm() > 0.01) return false;
    group = parent;
  }
  return false;
}

/// Returns whether the way between two links through the tree meets no other link with shapes.
bool WitnessRobot::isWayBare(const std::string& first, const std::string& second) const {
  const auto wayUp = [&](std::string link) {
    std::vector<std::string> way{link};
    while (link != root_) way.push_back(link = joints_.at(link).parent);
    return way;
  };
  std::vector<std::string> up = wayUp(first), down = wayUp(second);
  std::string top;  // the lowest link that is above both, or one of them
  while (!up.empty() && !down.empty() && up.back() == down.back()) {
    top = up.back();
    up.pop_back();
    down.pop_back();
  }
  up.insert(up.end(), down.begin(), down.end());
  up.push_back(top);
  return std::none_of(up.begin(), up.end(), [&](const std::string& link) {
    return link != first && link != second && shapes_.count(link) > 0;
  });
}

bool WitnessRobot::mayTouch(const std::string& first, const std::string& second) const {
  const std::string a = rigidGroup(first), b = rigidGroup(second);
  const bool adjacent = (isAdjacent(a, b) || isAdjacent(b, a)) && isWayBare(first, second);
  return a == b || adjacent || may_touch_.count({first, second}) > 0 || may_touch_.count({second, first}) > 0;
}

std::vector<WitnessRobot::Joint> WitnessRobot::driven() const {
  std::vector<Joint> driven;
  for (const auto& named : joints_) {
    if (named.second.type != "fixed" && named.second.mimics.empty()) driven.push_back(named.second);
  }
  return driven;
}

double WitnessRobot::position(const Joint& joint, const Positions& positions) const {
  if (joint.mimics.empty()) return positions.at(joint.name);
  return joint.multiplier * positions.at(joint.mimics) + joint.offset;
}

WitnessRobot::Poses WitnessRobot::posesAt(const Positions& positions, const Eigen::Isometry3d& world_from_root) const {
  Poses poses{{root_, world_from_root}};
  const std::function<Eigen::Isometry3d(const std::string&)> poseOf = [&](const std::string& link) {
    const auto known = poses.find(link);
    if (known != poses.end()) return known->second;
    const Joint& joint = joints_.at(link);
    Eigen::Isometry3d pose = poseOf(joint.parent) * joint.origin;
    if (joint.type == "prismatic") {
      pose.translate(position(joint, positions) * joint.axis);
    } else if (joint.type != "fixed") {
      pose.rotate(Eigen::AngleAxisd(position(joint, positions), joint.axis));
    }
    return poses[link] = pose;
  };
  for (const auto& named : joints_) poseOf(named.first);
  return poses;
}

std::map<std::string, WitnessBody> WitnessRobot::bodiesAt(const Poses& world_from_links) const {
  std::map<std::string, WitnessBody> bodies;
  for (const auto& named : shapes_) {
    const Eigen::Isometry3d& world_from_link = world_from_links.at(named.first);
    for (const Points& points : named.second) {
      WitnessBox box{world_from_link * points.front(), world_from_link * points.front()};
      for (const Eigen::Vector3d& point : points) {
        const Eigen::Vector3d in_world = world_from_link * point;
        box.min = box.min.cwiseMin(in_world);
        box.max = box.max.cwiseMax(in_world);
      }
      bodies[named.first].push_back(box);
    }
  }
  return bodies;
}

std::size_t WitnessRobot::shapeCount() const {
  std::size_t count = 0;
  for (const auto& named : shapes_) count += named.second.size();
  return count;
}

}  // namespace test
}  // namespace hgrid
