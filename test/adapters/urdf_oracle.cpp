// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/adapters/urdf_oracle.h"

#include <console_bridge/console.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>

#include "test/adapters/urdf_texts.h"
#include "test/support/sentences.h"

namespace hgrid {
namespace test {
namespace {

std::string flawOfShapes(const RobotLink& link) {
  for (const BodyShape& shape : link.shapes) {
    if (!shape.body_from_shape.matrix().allFinite()) return "a shape has a pose that is not finite";
    if (!isValid(boxOf(shape.shape, shape.body_from_shape, 0.0, Eigen::Vector3d::Zero()))) {
      return "a shape has an invalid box";
    }
  }
  for (const Refusal& refusal : link.unreadable) {
    const std::string flaw = flawOfRefusal(refusal);
    if (!flaw.empty()) return flaw;
  }
  const bool has_any = !link.shapes.empty() || !link.unreadable.empty();
  return link.hasGeometry() == has_any ? "" : "has_collision contradicts the number of shapes";
}

std::string flawOfLink(const RobotLink& link, int index) {
  if (index == 0 ? link.parent != -1 : link.parent < 0 || link.parent >= index) return "its parent does not precede it";
  if (!link.parent_from_joint.matrix().allFinite() || !link.group_from_link.matrix().allFinite()) {
    return "a pose is not finite";
  }
  if (std::abs(link.axis.norm() - 1.0) > 1e-9) return "its axis is not a unit vector";
  if (!std::isfinite(link.lower) || !std::isfinite(link.upper)) return "a joint limit is not finite";
  if (!(link.max_velocity >= 0.0)) return "its velocity limit is negative";
  return flawOfShapes(link);
}

/// Counts the errors that urdfdom reports, and prints none of them.
struct ErrorCount : console_bridge::OutputHandler {
  ErrorCount() { console_bridge::useOutputHandler(this); }
  ~ErrorCount() override { console_bridge::restorePreviousOutputHandler(); }
  void log(const std::string&, console_bridge::LogLevel level, const char*, int) override {
    count += level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR ? 1 : 0;
  }
  int count = 0;
};

/// Compares a link with the same link as urdfdom reads it from the whole text.
std::string differenceOf(const RobotModel& model, const RobotLink& link, const urdf::Link& other) {
  const bool is_root = other.parent_joint == nullptr;
  if (is_root != (link.parent < 0)) return "one of the two is the root";
  if (!is_root) {
    if (other.parent_joint->name != link.joint) return "its joint has another name";
    if (other.getParent()->name != model.links[static_cast<std::size_t>(link.parent)].name) return "another parent";
    const urdf::Vector3& at = other.parent_joint->parent_to_joint_origin_transform.position;
    if (link.parent_from_joint.translation() != Eigen::Vector3d(at.x, at.y, at.z)) return "its joint is elsewhere";
  }
  if (link.uses_visual || !link.unreadable.empty()) return {};
  return other.collision_array.size() == link.shapes.size() ? "" : "another number of shapes";
}

}  // namespace

std::string flawOf(const RobotModel& model, const std::string& urdf) {
  if (model.links.empty()) return "the model has no link";
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const std::string flaw = flawOfLink(model.links[i], static_cast<int>(i));
    if (!flaw.empty()) return "link '" + model.links[i].name + "': " + flaw;
  }
  for (const std::string& warning : model.warnings) {
    if (!flawOfSentence(warning).empty()) return flawOfSentence(warning);
  }
  if (accountedFor(model) != collisionElements(urdf)) return "not every <collision> is accounted for";

  // The XML parser of urdfdom reads malformed entities and broken UTF-8 in another way than tinyxml2.
  const bool plain = std::all_of(urdf.begin(), urdf.end(), [](char c) { return c > 0 && c != '&'; });
  if (!plain) return {};
  const ErrorCount errors;
  const urdf::ModelInterfaceSharedPtr whole = urdf::parseURDF(urdf);
  // Errors in tags that do not matter here, such as <inertial>, also make urdfdom drop shapes or refuse the text.
  if (!whole || errors.count > 0) return {};
  if (whole->links_.size() != model.links.size()) return "urdfdom finds another number of links";
  if (whole->joints_.size() + 1 != model.links.size()) return "urdfdom finds another number of joints";
  for (const RobotLink& link : model.links) {
    const urdf::LinkConstSharedPtr other = whole->getLink(link.name);
    const std::string difference = other ? differenceOf(model, link, *other) : "urdfdom does not find it";
    if (!difference.empty()) return "link '" + link.name + "' is not as urdfdom reads it: " + difference;
  }
  return {};
}

}  // namespace test
}  // namespace hgrid
