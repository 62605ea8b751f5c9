// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/robots/robot_source.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "hgrid_proximity/adapters/mesh.h"
#include "hgrid_proximity/adapters/srdf.h"
#include "hgrid_proximity/adapters/urdf.h"
#include "hgrid_proximity/bodies/name.h"
#include "node/params/body_params.h"
#include "node/params/mesh_policy.h"
#include "node/robots/state_publisher.h"
#include "node/text/frame_names.h"

namespace hgrid {
namespace {

/// Returns the last waiver whose pattern matches the name, or null.
const Waiver* waiverOf(const std::vector<Waiver>& waivers, const std::string& name) {
  const auto found = std::find_if(waivers.rbegin(), waivers.rend(),
                                  [&](const Waiver& waiver) { return matches(waiver.pattern, name); });
  return found == waivers.rend() ? nullptr : &*found;
}

/// Returns whether the root of a robot is the world frame, so that only its joints move it.
bool rests(const LoadedRobot& robot, const Params& params) {
  return robot.root_frame == params.world_frame || params.world_frame.empty();
}

Body bodyOf(const LoadedRobot& robot, std::uint32_t index, const std::string& tf_prefix, const Params& params) {
  const RobotModel& model = robot.read->model;
  Body body = linkBody(model, index, robot.name, robot.read->links);
  body.frame = prefixed(tf_prefix, body.frame);
  const Waiver* waiver = body.covered ? nullptr : waiverOf(params.accept_uncovered, body.name);
  if (waiver != nullptr) {
    body.waived = true;
    body.note = waiver->reason + " (" + body.note + ")";
  }
  applyPatterns(params, body);
  setSpeeds(robot, model, params, body);
  return body;
}

/// Sets `gap` if the robot has no geometry at all, or `waived_gap` if ~accept_uncovered waives all of its links.
void findGap(LoadedRobot& robot, const Params& params) {
  if (!robot.bodies.empty()) return;
  const std::string sentence = "robot '" + robot.name + "' has no collision geometry on any of its " +
                               std::to_string(robot.without_collision.size()) + " links";
  std::set<std::string> reasons;
  for (const std::string& link : robot.without_collision) {
    const Waiver* waiver = waiverOf(params.accept_uncovered, link);
    if (waiver == nullptr) {
      robot.gap = sentence + "; set ~use_visual or waive all of its links with ~accept_uncovered";
      return;
    }
    reasons.insert(waiver->reason);
  }
  robot.waived_gap = sentence;
  for (const std::string& reason : reasons) robot.waived_gap += (reason == *reasons.begin() ? ": " : "; ") + reason;
}

}  // namespace

double expectedSpeed(const LoadedRobot& robot, const RobotModel& model, std::uint32_t link, double reach,
                     const Params& params) {
  const LinkSpeed joints = linkSpeed(model, link, reach);
  return joints.limited + (joints.is_bound && rests(robot, params) ? 0.0 : params.default_max_speed);
}

void setSpeeds(const LoadedRobot& robot, const RobotModel& model, const Params& params, Body& link) {
  const double reach = reachOf(link.shapes);  // with the padding, which the shapes of the model do not have
  link.max_speed = lastMatch(params.max_speed, link.name, expectedSpeed(robot, model, link.link, reach, params));
  if (!rests(robot, params)) return;
  link.speed_bound = lastMatch(params.max_speed, link.name, speedBound(model, link.link, reach));
}

RobotSource::RobotSource(ros::NodeHandle node, const Params& params, std::shared_ptr<NarrowPhase> narrow_phase,
                         std::function<bool()> cancelled)
    : node_(std::move(node)),
      params_(params),
      narrow_phase_(std::move(narrow_phase)),
      cancelled_(std::move(cancelled)) {}

std::string RobotSource::parameter(const std::string& name) const {
  std::string key;
  XmlRpc::XmlRpcValue value;
  if (!node_.searchParam(name, key) || !node_.getParam(key, value)) {
    throw Refusal(Code::not_ready, "parameter '" + printable(name) + "' is not set; it must hold a robot's URDF");
  }
  if (value.getType() != XmlRpc::XmlRpcValue::TypeString || static_cast<std::string&>(value).empty()) {
    throw Refusal(Code::not_ready, "parameter '" + printable(key) + "' is empty or not a string; it must hold XML");
  }
  return value;
}

RobotDescription RobotSource::describe(const RobotSpec& robot) const {
  if (robot.text) return *robot.text;
  std::string urdf = parameter(robot.params.description);
  std::optional<std::string> srdf;
  const std::string& semantic = robot.params.semantic;
  std::string key;
  if (!semantic.empty() && node_.searchParam(semantic, key)) srdf = parameter(semantic);
  return RobotDescription(std::move(urdf), std::move(srdf));
}

std::shared_ptr<const ReadDescription> RobotSource::read(const RobotSpec& robot,
                                                         const RobotDescription& description) const {
  const std::string& name = robot.params.name;
  const std::string& semantic = robot.params.semantic;
  const DescriptionLimits limits{static_cast<std::size_t>(params_.max_description_bytes),
                                 static_cast<std::size_t>(params_.max_description_depth),
                                 static_cast<std::size_t>(params_.max_links)};
  MeshLoader meshes(meshPolicy(params_, cancelled_));
  const auto read = std::make_shared<ReadDescription>();
  read->model = readUrdf(
      description.urdf(), [&](const std::string& uri, const Eigen::Vector3d& scale) { return meshes.load(uri, scale); },
      limits, params_.shapeLimits(),
      [&](const std::string& link) { return matchesAny(params_.use_visual, joined(name, link)); });
  read->warnings = read->model.warnings;
  LinkRules rules;
  if (description.srdf()) {
    rules = readSrdf(*description.srdf(), limits);
  } else if (!robot.text && !semantic.empty() && semantic != RobotParams{}.semantic) {
    read->warnings.push_back("parameter '" + printable(semantic) + "' is not set; it should hold the robot's SRDF");
  }
  read->links = std::make_shared<const LinkMatrix>(read->model, rules, read->warnings);
  read->self_pairs = countSelfPairs(read->model, *read->links);
  read->joints =
      std::make_shared<const RobotJoints>(read->model, description.srdf() ? &*description.srdf() : nullptr, limits);
  if (!read->joints->flaw.empty()) {
    read->warnings.push_back("states of robot '" + name + "' cannot be checked: " + read->joints->flaw);
  }
  if (!read->joints->group_flaw.empty()) {
    read->warnings.push_back("the groups of robot '" + name + "' cannot be used: " + read->joints->group_flaw);
  }
  for (RobotLink& link : read->model.links) {
    if (cancelled_())
      throw Refusal(Code::busy, "robot '" + name + "' was not loaded, because the node is shutting down");
    read->use_visual.push_back(matchesAny(params_.use_visual, joined(name, link.name)));
    for (BodyShape& shape : link.shapes) shape.solid = narrow_phase_->solidOf(shape.shape);
  }
  return read;
}

bool RobotSource::fits(const ReadDescription& read, const std::string& robot) const {
  for (std::size_t i = 0; i < read.model.links.size(); ++i) {
    if (matchesAny(params_.use_visual, joined(robot, read.model.links[i].name)) != read.use_visual[i]) return false;
  }
  return true;
}

LoadedRobot RobotSource::make(const RobotSpec& spec, const std::shared_ptr<const ReadDescription>& read) const {
  const RobotModel& model = read->model;
  const std::string& tf_prefix = spec.params.tf_prefix;
  LoadedRobot robot;
  robot.name = spec.params.name;
  robot.root_frame = prefixed(tf_prefix, model.links.front().name);
  robot.warnings = read->warnings;
  robot.self_pairs = read->self_pairs;
  robot.read = read;
  robot.free_frames = freeFrames(model, tf_prefix);
  robot.unsent_frames = unsentFrames(model, tf_prefix);
  robot.groups.resize(model.group_roots.size());
  for (std::size_t group = 0; group < robot.groups.size(); ++group) {
    robot.groups[group].frame = prefixed(tf_prefix, model.links[model.group_roots[group]].name);
  }
  for (std::uint32_t i = 0; i < model.links.size(); ++i) {
    const RobotLink& link = model.links[i];
    robot.links[joined(robot.name, link.name)] = {link.rigid_group, link.group_from_link};
    if (!link.hasGeometry()) {
      robot.without_collision.push_back(joined(robot.name, link.name));
      continue;
    }
    robot.groups[link.rigid_group].members.emplace_back(robot.bodies.size(), link.group_from_link);
    robot.bodies.push_back(bodyOf(robot, i, tf_prefix, params_));
    if (link.uses_visual) robot.uses_visual.push_back(robot.bodies.back().name);
  }
  findGap(robot, params_);
  return robot;
}

}  // namespace hgrid
