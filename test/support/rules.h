// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/pairs/pair_rule.h"
#include "test/support/models.h"

namespace hgrid {
namespace test {

/// Returns a rule that allows the pair, as ~set_allowed creates it.
inline PairRule allow(const std::string& first, const std::string& second, const std::string& reason = "") {
  PairRule rule;
  rule.first = first;
  rule.second = second;
  rule.reason = reason;
  rule.origin = Origin::service;
  return rule;
}

/// Returns a rule that reports the pair, as ~set_allowed creates it.
inline PairRule enable(const std::string& first, const std::string& second, const std::string& reason = "") {
  PairRule rule = allow(first, second, reason);
  rule.allowed = false;
  return rule;
}

/// Returns a copy of the rule that ends at `end`.
inline PairRule until(PairRule rule, PairRule::Clock::time_point end) {
  rule.ends = end;
  return rule;
}

/// Returns the bodies of an arm: base, shoulder, elbow and hand, each a sphere. A fixed joint connects base and
/// shoulder. The URDF names the robot "arm".
/// @param robot  name of the robot in the scene
inline std::vector<Body> armBodies(const std::string& robot, const LinkRules& srdf = {}) {
  RobotModel model;
  model.name = "arm";
  const int base = addLink(model, "base", -1), shoulder = addLink(model, "shoulder", base, JointKind::fixed);
  addLink(model, "hand", addLink(model, "elbow", shoulder));
  findRigidGroups(model);
  const auto matrix = std::make_shared<const LinkMatrix>(matrixOf(model, srdf));
  std::vector<Body> bodies;
  for (std::uint32_t i = 0; i < model.links.size(); ++i) {
    Body body;
    body.name = robot + "/" + model.links[i].name;
    body.frame = model.links[i].name;
    body.kind = BodyKind::link;
    body.shapes = model.links[i].shapes;
    body.robot = robot;
    body.link = i;
    body.links = matrix;
    bodies.push_back(body);
  }
  return bodies;
}

}  // namespace test
}  // namespace hgrid
