// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/adapters/urdf.h"

#include <console_bridge/console.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <map>
#include <mutex>

#include "adapters/urdf/urdf_tree.h"
#include "adapters/urdf/xml.h"
#include "geometry/rotation.h"
#include "hgrid_proximity/bodies/name.h"

namespace hgrid {
namespace {

/// Keeps the first error that urdfdom reports during the lifetime of this object, so that it is not printed.
///
/// urdfdom reports errors to a global log that has a single handler. So a lock allows only one object of this class at
/// a time.
class UrdfdomErrors : private console_bridge::OutputHandler {
 public:
  UrdfdomErrors() : lock_(mutex()) { console_bridge::useOutputHandler(this); }
  ~UrdfdomErrors() override { console_bridge::restorePreviousOutputHandler(); }
  const std::string& first() const { return first_; }

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_.empty()) first_ = printable(text, 200);
  }

  std::lock_guard<std::mutex> lock_;
  std::string first_;
};

std::string printed(const tinyxml2::XMLNode& node) {
  tinyxml2::XMLPrinter printer(nullptr, true);
  node.Accept(&printer);
  return printer.CStr();
}

Eigen::Vector3d vectorOf(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

/// Returns the origin that urdfdom has read from a <joint>, <collision> or <visual>. The rotation is computed anew,
/// because that of urdfdom depends on the C library: the same URDF would give other poses on another system.
Pose poseOf(const urdf::Pose& pose, const tinyxml2::XMLElement& element, const std::string& what) {
  Eigen::Vector4d xyzw;
  pose.rotation.getQuaternion(xyzw[0], xyzw[1], xyzw[2], xyzw[3]);
  const tinyxml2::XMLElement* const origin = element.FirstChildElement("origin");
  if (const char* const rpy = origin == nullptr ? nullptr : origin->Attribute("rpy")) {
    urdf::Vector3 angles;
    angles.init(rpy);
    xyzw = rotationOf(vectorOf(angles)).coeffs();
  }
  return checkedPose(vectorOf(pose.position), xyzw, what + ": origin");
}

/// Returns the XML text of a <collision> that has the origin and the geometry of a <collision> or <visual> element.
std::string asCollision(const tinyxml2::XMLElement& element) {
  tinyxml2::XMLDocument document;
  tinyxml2::XMLElement* collision = document.NewElement("collision");
  document.InsertEndChild(collision);
  for (auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    const std::string tag = child->Name();
    if (tag == "origin" || tag == "geometry") collision->InsertEndChild(child->DeepClone(&document));
  }
  return printed(document);
}

/// Reads one <collision> or <visual> with urdfdom, as the only element of a separate robot. So this function detects
/// elements that urdfdom drops silently, and a broken element does not affect the other elements of the link.
urdf::CollisionSharedPtr parseShape(const tinyxml2::XMLElement& element, const std::string& what) {
  const tinyxml2::XMLElement* geometry = element.FirstChildElement("geometry");
  const std::string shown = printable(printed(element), 200);
  const tinyxml2::XMLElement* shape = geometry == nullptr ? nullptr : geometry->FirstChildElement();
  if (shape == nullptr || shape->NextSiblingElement() != nullptr ||
      geometry->NextSiblingElement("geometry") != nullptr) {
    throw Refusal(Code::parse, what + " must have one <geometry> that contains one shape, but it reads " + shown);
  }
  const UrdfdomErrors errors;
  const auto robot = urdf::parseURDF("<robot name=\"r\"><link name=\"l\">" + asCollision(element) + "</link></robot>");
  const auto link = robot ? robot->getRoot() : nullptr;
  if (!link || link->collision_array.size() != 1 || !link->collision_array.front()->geometry) {
    throw Refusal(Code::parse,
                  what + " cannot be read: " + shown + (errors.first().empty() ? "" : ": " + errors.first()));
  }
  return link->collision_array.front();
}

BodyShape bodyShapeOf(const urdf::Collision& collision, const tinyxml2::XMLElement& element, const std::string& what,
                      const MeshSource& meshes, const ShapeLimits& limits) {
  const Pose origin = poseOf(collision.origin, element, what);
  checkWithin(origin.translation(), limits.max_size, what + ": origin");
  const urdf::Geometry& geometry = *collision.geometry;
  switch (geometry.type) {
    case urdf::Geometry::SPHERE:
      return {Shape::sphere(dynamic_cast<const urdf::Sphere&>(geometry).radius, limits),
              origin,
              0.0,
              {},
              Eigen::Vector3d::Ones()};
    case urdf::Geometry::BOX:
      return {Shape::box(vectorOf(dynamic_cast<const urdf::Box&>(geometry).dim), limits),
              origin,
              0.0,
              {},
              Eigen::Vector3d::Ones()};
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
      return {Shape::cylinder(cylinder.length, cylinder.radius, limits), origin, 0.0, {}, Eigen::Vector3d::Ones()};
    }
    case urdf::Geometry::MESH: {
      const auto& mesh = dynamic_cast<const urdf::Mesh&>(geometry);
      const Eigen::Vector3d scale = vectorOf(mesh.scale);
      return {Shape::mesh(meshes(mesh.filename, scale), limits), origin, 0.0, mesh.filename, scale};
    }
  }
  throw Refusal(Code::unsupported,
                what + " has a kind of shape that is not supported; it must be a sphere, box, cylinder or mesh");
}

/// Lets a shape without any extent, by which some URDFs mark a place, be the smallest shape of its kind.
/// @returns whether it has no extent
bool growFromPoint(urdf::Geometry& geometry, const ShapeLimits& limits) {
  if (geometry.type == urdf::Geometry::SPHERE) {
    double& radius = dynamic_cast<urdf::Sphere&>(geometry).radius;
    if (radius != 0.0) return false;
    radius = limits.min_size;
    return true;
  }
  if (geometry.type != urdf::Geometry::BOX) return false;
  urdf::Vector3& size = dynamic_cast<urdf::Box&>(geometry).dim;
  if (size.x != 0.0 || size.y != 0.0 || size.z != 0.0) return false;
  size.x = size.y = size.z = limits.min_size;
  return true;
}

/// Reads all elements of a link that have the given tag, <collision> or <visual>. @returns whether there are any
bool readShapes(const tinyxml2::XMLElement& element, const char* tag, RobotLink& link, const MeshSource& meshes,
                const ShapeLimits& limits, std::vector<std::string>& warnings) {
  int number = 0;
  for (auto* shape = element.FirstChildElement(tag); shape != nullptr; shape = shape->NextSiblingElement(tag)) {
    const std::string what =
        "<" + std::string(tag) + "> " + std::to_string(++number) + " of link '" + printable(link.name) + "'";
    try {
      const urdf::CollisionSharedPtr read = parseShape(*shape, what);
      if (growFromPoint(*read->geometry, limits)) {
        warnings.push_back(what + " has size 0; it counts as a point of " + text(limits.min_size) + " m");
      }
      link.shapes.push_back(bodyShapeOf(*read, *shape, what, meshes, limits));
    } catch (const Refusal& refusal) {
      const std::string sentence = refusal.what();
      link.unreadable.emplace_back(refusal.code(), sentence.rfind(what, 0) == 0 ? sentence : what + ": " + sentence);
    }
  }
  return number > 0;
}

/// Refuses too many links or joints. This check comes before urdfdom, because urdfdom needs seconds for a hundred
/// thousand links or joints.
void checkCounts(const tinyxml2::XMLElement& robot, const DescriptionLimits& limits) {
  for (const char* tag : {"link", "joint"}) {
    std::size_t count = 0;
    for (auto* child = robot.FirstChildElement(tag); child != nullptr; child = child->NextSiblingElement(tag)) ++count;
    if (count <= limits.max_links) continue;
    throw Refusal(Code::limit, "the URDF has " + std::to_string(count) + " " + tag + "s; at most " +
                                   std::to_string(limits.max_links) + " are allowed");
  }
}

/// Throws a Refusal that names the joint that urdfdom cannot read. The error text of urdfdom does not always name the
/// joint, so this function reads each joint separately.
/// @param reason  what urdfdom said first; may be empty
[[noreturn]] void nameUnreadableJoint(const tinyxml2::XMLElement& robot, const std::string& reason) {
  for (auto* joint = robot.FirstChildElement("joint"); joint != nullptr; joint = joint->NextSiblingElement("joint")) {
    tinyxml2::XMLDocument alone;
    tinyxml2::XMLElement* root = alone.NewElement("robot");
    alone.InsertEndChild(root);
    root->SetAttribute("name", "r");
    for (const char* end : {"parent", "child"}) {
      tinyxml2::XMLElement* link = alone.NewElement("link");
      link->SetAttribute("name", joint->FirstChildElement(end)->Attribute("link"));
      root->InsertEndChild(link);
    }
    root->InsertEndChild(joint->DeepClone(&alone));
    if (urdf::parseURDF(printed(alone))) continue;
    throw Refusal(Code::parse, "joint '" + printable(joint->Attribute("name")) +
                                   "' cannot be read: " + printable(printed(*joint), 300));
  }
  throw Refusal(Code::parse, "the URDF's links and joints cannot be read" + (reason.empty() ? "" : ": " + reason));
}

/// Reads the links and joints of the robot with urdfdom. urdfdom gets a copy of the robot without all other elements.
urdf::ModelInterfaceSharedPtr parseTree(const tinyxml2::XMLElement& robot) {
  const UrdfdomErrors errors;
  tinyxml2::XMLDocument bare;
  tinyxml2::XMLElement* root = robot.ShallowClone(&bare)->ToElement();
  bare.InsertEndChild(root);
  for (auto* child = robot.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    const std::string tag = child->Name();
    if (tag == "link") root->InsertEndChild(child->ShallowClone(&bare));
    if (tag == "joint") root->InsertEndChild(child->DeepClone(&bare));
  }
  if (const auto model = urdf::parseURDF(printed(bare))) {
    if (model->getRoot()) return model;
  }
  const std::string reason = errors.first();
  nameUnreadableJoint(*root, reason);
}

JointKind kindOf(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::REVOLUTE:
    case urdf::Joint::CONTINUOUS:
      return JointKind::revolute;
    case urdf::Joint::PRISMATIC:
      return JointKind::prismatic;
    case urdf::Joint::PLANAR:
      return JointKind::planar;
    case urdf::Joint::FLOATING:
      return JointKind::floating;
    default:
      return JointKind::fixed;
  }
}

/// @param joint_element  the <joint> above the link; not read if there is none
RobotLink linkOf(const urdf::Link& source, const tinyxml2::XMLElement* joint_element, int parent,
                 const ShapeLimits& limits, std::vector<std::string>& warnings) {
  checkLocal(source.name, "link name");
  RobotLink link;
  link.name = source.name;
  link.parent = parent;
  if (!source.parent_joint) return link;
  const urdf::Joint& joint = *source.parent_joint;
  const std::string what = "joint '" + printable(joint.name) + "'";
  link.joint = joint.name;
  link.joint_kind = kindOf(joint);
  link.continuous = joint.type == urdf::Joint::CONTINUOUS;
  if (joint.mimic) {
    link.mimic = joint.mimic->joint_name;
    link.mimic_multiplier = joint.mimic->multiplier;
    link.mimic_offset = joint.mimic->offset;
  }
  link.parent_from_joint = poseOf(joint.parent_to_joint_origin_transform, *joint_element, what);
  checkWithin(link.parent_from_joint.translation(), limits.max_size, what + ": origin");
  const Eigen::Vector3d axis = vectorOf(joint.axis);
  const bool has_axis = link.joint_kind != JointKind::fixed && link.joint_kind != JointKind::floating;
  const double largest = axis.cwiseAbs().maxCoeff();
  if (has_axis && axis.allFinite() && largest > 0.0) {
    link.axis = (axis / largest).normalized();  // the squared norm of `axis` itself may overflow
  } else if (has_axis) {
    link.has_axis = false;
    warnings.push_back(what + " has an axis of length " + text(axis.norm()) +
                       ", so nobody knows how it moves; states of the robot cannot be checked");
  }
  if (joint.limits) {
    link.max_velocity = std::max(joint.limits->velocity, 0.0);
    if (joint.limits->velocity < 0.0) {
      warnings.push_back(what + " has the velocity limit " + text(joint.limits->velocity) +
                         "; it must not be negative and is not used");
    }
    link.lower = joint.limits->lower;
    link.upper = joint.limits->upper;
  }
  const bool is_limited = joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::PRISMATIC;
  const bool unlimited = (link.lower == 0.0 && link.upper == 0.0) || link.lower > link.upper;
  if (is_limited && joint.mimic == nullptr && unlimited) {
    warnings.push_back(what + " may go from " + text(link.lower) + " to " + text(link.upper) +
                       " by its <limit>, so other tools do not let it move at all; here it moves without limits" +
                       (joint.type == urdf::Joint::REVOLUTE ? ", but turns are counted: a full turn is a way" : ""));
    link.lower = link.upper = 0.0;
  }
  return link;
}

}  // namespace

RobotModel readUrdf(const std::string& xml, const MeshSource& meshes, const DescriptionLimits& limits,
                    const ShapeLimits& shape_limits, const VisualChoice& takes_visual) {
  tinyxml2::XMLDocument document;
  parseXml(xml, limits, "the URDF", "robot", document);
  const tinyxml2::XMLElement& robot = *document.RootElement();
  checkCounts(robot, limits);
  RobotModel model;
  checkTree(robot, model.warnings);
  const urdf::ModelInterfaceSharedPtr tree = parseTree(robot);

  model.name = tree->getName();
  std::vector<urdf::LinkConstSharedPtr> open = {tree->getRoot()};
  std::map<std::string, int> index;
  std::map<std::string, const tinyxml2::XMLElement*> joints;
  for (auto* element = robot.FirstChildElement("joint"); element != nullptr;
       element = element->NextSiblingElement("joint")) {
    joints.emplace(element->Attribute("name"), element);
  }
  for (std::size_t i = 0; i < open.size(); ++i) {  // breadth first, so parents come before children
    const urdf::LinkConstSharedPtr link = open[i];
    const int parent = link->getParent() ? index.at(link->getParent()->name) : -1;
    index.emplace(link->name, static_cast<int>(i));
    const auto* const joint = link->parent_joint ? joints.at(link->parent_joint->name) : nullptr;
    model.links.push_back(linkOf(*link, joint, parent, shape_limits, model.warnings));
    open.insert(open.end(), link->child_links.begin(), link->child_links.end());
  }
  for (auto* element = robot.FirstChildElement("link"); element != nullptr;
       element = element->NextSiblingElement("link")) {
    RobotLink& link = model.links[static_cast<std::size_t>(index.at(element->Attribute("name")))];
    link.has_collision = readShapes(*element, "collision", link, meshes, shape_limits, model.warnings);
    if (link.has_collision || !takes_visual || !takes_visual(link.name)) continue;
    link.uses_visual = readShapes(*element, "visual", link, meshes, shape_limits, model.warnings);
  }
  findRigidGroups(model);
  return model;
}

}  // namespace hgrid
