// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <gtest/gtest.h>
#include <tf2_msgs/TFMessage.h>

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "src/node/sources/obstacle_change.h"
#include "src/node/world/robot_edits.h"
#include "src/node/world/world.h"
#include "test/node/support/settings.h"
#include "test/node/support/transform_views.h"
#include "test/node/world/obstacle_world.h"

namespace hgrid {
namespace test {

/// Returns a robot of two spheres of radius 0.1 m: "name/base" at the origin of the frame "name/base", and "name/top"
/// at z = 1 m.
inline LoadedRobot cartNamed(const std::string& name) {
  LoadedRobot robot;
  robot.name = name;
  robot.root_frame = name + "/base";
  robot.groups = {{robot.root_frame, {}}};
  for (const char* link : {"base", "top"}) {
    Body body;
    body.name = name + "/" + link;
    body.frame = body.name;
    body.kind = BodyKind::link;
    body.robot = name;
    body.link = static_cast<std::uint32_t>(robot.bodies.size());
    body.shapes.push_back({Shape::sphere(0.1), Pose::Identity(), 0.0, {}, Eigen::Vector3d::Ones()});
    Pose group_from_link = Pose::Identity();
    group_from_link.translation().z() = static_cast<double>(robot.bodies.size());
    robot.groups[0].members.emplace_back(robot.bodies.size(), group_from_link);
    robot.links[body.name] = {0, group_from_link};
    robot.bodies.push_back(body);
  }
  return robot;
}

inline RobotChange robotChange(RobotOperation operation, const std::string& name, std::size_t index = 0) {
  RobotChange change;
  change.operation = operation;
  change.index = index;
  change.name = name;
  if (operation != RobotOperation::add) return change;
  RobotSpec spec;
  spec.params = {name, "cart_description", "", name};
  change.spec = std::make_shared<const RobotSpec>(spec);
  change.model = std::make_shared<const LoadedRobot>(cartNamed(name));
  return change;
}
inline RobotChange joins(const std::string& name, std::size_t index = 0) {
  return robotChange(RobotOperation::add, name, index);
}
inline RobotChange leaves(const std::string& name, std::size_t index = 0) {
  return robotChange(RobotOperation::remove, name, index);
}
inline RobotChange isAbsent(const std::string& name, std::size_t index = 0) {
  return robotChange(RobotOperation::declare_absent, name, index);
}
inline RobotChange isPresent(const std::string& name, std::size_t index = 0) {
  return robotChange(RobotOperation::declare_present, name, index);
}

/// A world with the configured robot "boss". The frame of each robot that moves() is sent in each tick.
class Fleet : public ::testing::Test {
 protected:
  using Places = std::map<std::string, double>;  // x [m] of the frame "name/base" of each robot that sends
  using Refused = std::pair<Code, std::size_t>;
  using Names = std::vector<std::string>;

  Fleet() : Fleet(params()) {}
  explicit Fleet(const Params& params)
      : params_(params), phase_(makeCoreNarrowPhase()), world_(settingsOf(params_), false, 1, ledger_, phase_) {}

  static Params params() {
    Params value;
    value.world_frame = "world";
    value.robots.push_back({"boss", "boss_description", "", "boss"});
    value.max_robots = 30;
    value.max_bodies = 70;
    return value;
  }

  /// Returns the next tick, 1/8 s later. All robots in `sending` are at their places then.
  const Tick& tick() {
    time_ += 0.125;
    tf2_msgs::TFMessage message;
    for (const auto& [robot, x] : sending) {
      message.transforms.emplace_back();
      geometry_msgs::TransformStamped& transform = message.transforms.back();
      transform.header.frame_id = "world";
      transform.header.stamp.fromNSec(std::uint64_t(momentAt(time_).ros.count()));
      transform.child_frame_id = robot + "/base";
      transform.transform.rotation.w = 1.0;
      transform.transform.translation.x = x;
    }
    if (!message.transforms.empty()) world_.transforms().take(viewsOf(message), false, "/driver", momentAt(time_));
    tick_ = world_.tick(momentAt(time_));
    return *tick_;
  }
  void tickFor(double duration) {
    for (const double end = time_ + duration; time_ < end;) tick();
  }
  const Snapshot& snapshot() const { return *tick_->snapshot; }

  std::shared_ptr<PreparedRobotBodies> prepare(const RobotChanges& changes) const {
    return world_.prepareRobots(
        [&](RobotEntries& robots) {
          for (const RobotChange& change : changes) edit(change, params_, robots);
        },
        tick_);
  }
  /// Applies the changes. Every second call prepares them before. @returns code and index of a refusal
  std::optional<Refused> refused(const RobotChanges& changes) {
    try {
      std::shared_ptr<PreparedRobotBodies> prepared;
      prepares_ = !prepares_;
      if (prepares_) prepared = prepare(changes);
      world_.applyRobots(changes, prepared.get());
    } catch (const ChangeRefusal& refusal) {
      sentence_ = refusal.what();
      return Refused(refusal.code(), refusal.index());
    }
    return std::nullopt;
  }
  Names bodies() const {
    Names names;
    for (const Body& body : snapshot().structure().bodies) names.push_back(body.name);
    return names;
  }
  /// Returns the pairs of the newest tick as "first|second", sorted.
  static std::set<std::string> pairsOf(const Snapshot& snapshot) {
    std::set<std::string> pairs;
    const BodyList& bodies = snapshot.structure().bodies;
    for (const NearPair& pair : snapshot.pairs())
      pairs.insert(bodies[pair.first].name + "|" + bodies[pair.second].name);
    return pairs;
  }

  Places sending;
  Params params_;
  Ledger ledger_;
  std::shared_ptr<NarrowPhase> phase_;
  World world_;
  double time_ = 0.0;
  std::shared_ptr<const Tick> tick_;
  std::string sentence_;   // of the last refusal
  bool prepares_ = false;  // whether the last refused() prepared its changes
};

}  // namespace test
}  // namespace hgrid
