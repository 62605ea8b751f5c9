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

std::vector<LinkRules::Pair> pairsOf(const tinyxml2::XMLElement& robot, const char* tag) {
  std::vector<LinkRules::Pair> pairs;
  for (auto* element = robot.FirstChildElement(tag); element != nullptr; element = element->NextSiblingElement(tag)) {
    const char* reason = element->Attribute("reason");
    pairs.push_back({attribute(*element, "link1"), attribute(*element, "link2"), reason == nullptr ? "" : reason});
  }
  return pairs;
}

}  // namespace

LinkRules readSrdf(const std::string& xml, const DescriptionLimits& limits) {
  tinyxml2::XMLDocument document;
  const tinyxml2::XMLElement& robot = parseXml(xml, limits, "the SRDF", "robot", document);
  LinkRules rules;
  rules.disabled = pairsOf(robot, "disable_collisions");
  rules.enabled = pairsOf(robot, "enable_collisions");
  const char* tag = "disable_default_collisions";
  for (auto* element = robot.FirstChildElement(tag); element != nullptr; element = element->NextSiblingElement(tag)) {
    rules.disabled_default.push_back(attribute(*element, "link"));
  }
  return rules;
}

}  // namespace hgrid
