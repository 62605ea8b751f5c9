// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/adapters/srdf.h"

#include "adapters/urdf/xml.h"

namespace hgrid {
namespace {

std::string attribute(const tinyxml2::XMLElement& element, const char* name) {
  const char* value = element.Attribute(name);
  if (value == nullptr) {
    throw Refusal(Code::parse, std::string("the SRDF's <") + element.Name() + "> in line " +
                                   std::to_string(element.GetLineNum()) + " has no attribute '" + name +
                                   "'; it must have one");
  }
  return value;
}

/// Calls `work` with each child element that has this tag.
template <class Work>
void forEach(const tinyxml2::XMLElement& parent, const char* tag, const Work& work) {
  for (auto* child = parent.FirstChildElement(tag); child != nullptr; child = child->NextSiblingElement(tag)) {
    work(*child);
  }
}

std::vector<LinkRules::Pair> pairsOf(const tinyxml2::XMLElement& robot, const char* tag) {
  std::vector<LinkRules::Pair> pairs;
  forEach(robot, tag, [&](const auto& element) {
    const char* reason = element.Attribute("reason");
    pairs.push_back({attribute(element, "link1"), attribute(element, "link2"), reason == nullptr ? "" : reason});
  });
  return pairs;
}

JointGroup groupOf(const tinyxml2::XMLElement& element) {
  JointGroup group;
  group.name = attribute(element, "name");
  forEach(element, "joint", [&](const auto& child) { group.joints.push_back(attribute(child, "name")); });
  forEach(element, "link", [&](const auto& child) { group.links.push_back(attribute(child, "name")); });
  forEach(element, "group", [&](const auto& child) { group.groups.push_back(attribute(child, "name")); });
  forEach(element, "chain", [&](const auto& child) {
    group.chains.push_back({attribute(child, "base_link"), attribute(child, "tip_link")});
  });
  return group;
}

VirtualJoint virtualJointOf(const tinyxml2::XMLElement& element) {
  VirtualJoint joint;
  joint.name = attribute(element, "name");
  joint.parent_frame = attribute(element, "parent_frame");
  joint.child_link = attribute(element, "child_link");
  const std::string type = attribute(element, "type");
  if (type == "planar") {
    joint.kind = JointKind::planar;
  } else if (type == "floating") {
    joint.kind = JointKind::floating;
  } else if (type != "fixed") {
    throw Refusal(Code::parse, "the SRDF's virtual joint '" + printable(joint.name) + "' has the type '" +
                                   printable(type) + "'; it must be fixed, planar or floating");
  }
  return joint;
}

}  // namespace

JointGroups readJointGroups(const std::string& xml, const DescriptionLimits& limits) {
  tinyxml2::XMLDocument document;
  parseXml(xml, limits, "the SRDF", "robot", document);
  const tinyxml2::XMLElement& robot = *document.RootElement();
  JointGroups all;
  forEach(robot, "group", [&](const auto& element) { all.groups.push_back(groupOf(element)); });
  forEach(robot, "virtual_joint", [&](const auto& element) { all.virtual_joints.push_back(virtualJointOf(element)); });
  return all;
}

LinkRules readSrdf(const std::string& xml, const DescriptionLimits& limits) {
  tinyxml2::XMLDocument document;
  parseXml(xml, limits, "the SRDF", "robot", document);
  const tinyxml2::XMLElement& robot = *document.RootElement();
  LinkRules rules;
  rules.disabled = pairsOf(robot, "disable_collisions");
  rules.enabled = pairsOf(robot, "enable_collisions");
  forEach(robot, "disable_default_collisions",
          [&](const auto& element) { rules.disabled_default.push_back(attribute(element, "link")); });
  return rules;
}

}  // namespace hgrid
