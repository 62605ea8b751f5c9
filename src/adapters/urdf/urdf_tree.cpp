// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "adapters/urdf/urdf_tree.h"

#include <cstring>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

[[noreturn]] void refuse(const std::string& sentence) { throw Refusal(Code::parse, sentence); }

/// Returns the name of a link or joint. @throws Refusal with code parse if the element has no name
std::string nameOf(const tinyxml2::XMLElement& element) {
  const char* name = element.Attribute("name");
  if (name == nullptr || *name == '\0') {
    refuse(std::string("a <") + element.Name() + "> in line " + std::to_string(element.GetLineNum()) +
           " has no name; it must have one");
  }
  return name;
}

/// Returns the name of the parent or child link of a joint. @throws Refusal with code parse if there is no such link
std::string linkOf(const tinyxml2::XMLElement& joint, const char* end, const std::set<std::string>& links) {
  const tinyxml2::XMLElement* element = joint.FirstChildElement(end);
  const char* link = element == nullptr ? nullptr : element->Attribute("link");
  const std::string what = "joint '" + printable(nameOf(joint)) + "'";
  if (link == nullptr) refuse(what + " has no " + end + " link; it must have one");
  if (links.count(link) == 0)
    refuse(what + " names " + end + " link '" + printable(link) + "', but there is no such link");
  return link;
}

bool isXacro(const tinyxml2::XMLElement& element) { return std::strncmp(element.Name(), "xacro:", 6) == 0; }

std::string xacroText(const tinyxml2::XMLElement& element) {
  return "the URDF contains <" + printable(element.Name()) + "> in line " + std::to_string(element.GetLineNum());
}

/// Refuses elements that only xacro understands. A parser of URDF would silently leave them out.
void refuseXacro(const tinyxml2::XMLElement& parent) {
  for (auto* child = parent.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    if (isXacro(*child)) {
      refuse(xacroText(*child) +
             ": it is a xacro file that was not expanded; use the output of the command xacro instead");
    }
    refuseXacro(*child);
  }
}

/// Returns whether an element holds a link or a joint, at any depth.
bool holdsParts(const tinyxml2::XMLElement& element) {
  for (auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    const bool is_part = std::strcmp(child->Name(), "link") == 0 || std::strcmp(child->Name(), "joint") == 0;
    if (is_part || holdsParts(*child)) return true;
  }
  return false;
}

/// Beside links, an element of xacro that holds none is left over, and ignored with a warning. Anywhere else, it is
/// refused.
void checkXacro(const tinyxml2::XMLElement& robot, std::vector<std::string>& warnings) {
  if (robot.FirstChildElement("link") == nullptr) return refuseXacro(robot);
  for (auto* child = robot.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    if (isXacro(*child) && !holdsParts(*child)) {
      warnings.push_back(xacroText(*child) + " beside its links; it is ignored, as by other readers of URDF");
    } else if (isXacro(*child)) {
      refuseXacro(robot);
    } else {
      refuseXacro(*child);
    }
  }
}

}  // namespace

void checkTree(const tinyxml2::XMLElement& robot, std::vector<std::string>& warnings) {
  checkXacro(robot, warnings);
  std::set<std::string> links, joints;
  for (auto* link = robot.FirstChildElement("link"); link != nullptr; link = link->NextSiblingElement("link")) {
    const std::string name = nameOf(*link);
    if (!links.insert(name).second) refuse("link '" + printable(name) + "' is defined twice; names must be unique");
  }
  if (links.empty()) refuse("the URDF has no <link>; it must have at least one");

  std::map<std::string, std::string> joint_of_child;
  std::map<std::string, std::vector<std::string>> children;
  for (auto* joint = robot.FirstChildElement("joint"); joint != nullptr; joint = joint->NextSiblingElement("joint")) {
    const std::string name = nameOf(*joint);
    if (!joints.insert(name).second) refuse("joint '" + printable(name) + "' is defined twice; names must be unique");
    const std::string parent = linkOf(*joint, "parent", links), child = linkOf(*joint, "child", links);
    if (parent == child)
      refuse("joint '" + printable(name) + "' connects link '" + printable(child) +
             "' to itself; it must connect two links");
    const auto added = joint_of_child.emplace(child, name);
    if (!added.second) {
      refuse("link '" + printable(child) + "' is the child of joint '" + printable(added.first->second) +
             "' and of joint '" + printable(name) + "'; a link must have only one parent");
    }
    children[parent].push_back(child);
  }

  std::vector<std::string> reached;
  for (const std::string& link : links) {
    if (joint_of_child.count(link) != 0) continue;
    if (!reached.empty()) {
      refuse("links '" + printable(reached.front()) + "' and '" + printable(link) +
             "' both have no parent; only one link, the root, may have no parent");
    }
    reached.push_back(link);
  }
  const std::string root = reached.empty() ? "" : reached.front();
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const std::vector<std::string> next = children[reached[i]];
    reached.insert(reached.end(), next.begin(), next.end());
  }
  const std::set<std::string> hanging(reached.begin(), reached.end());
  for (const std::string& link : links) {
    if (hanging.count(link) != 0) continue;
    refuse("link '" + printable(link) + "' " +
           (root.empty() ? "is part of a loop of joints, and there is no root link"
                         : "is not reachable from the root link '" + printable(root) + "'") +
           "; joints must form a tree");
  }
}

}  // namespace hgrid
