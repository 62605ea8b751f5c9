// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <gtest/gtest.h>
#include <hgrid_proximity/LifetimeEnd.h>
#include <hgrid_proximity/ObstacleOperation.h>
#include <hgrid_proximity/ShapeKind.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "src/node/messages/obstacle_messages.h"
#include "src/node/world/world.h"
#include "test/node/support/settings.h"
#include "test/node/support/transform_views.h"

namespace hgrid {
namespace test {

namespace msg = ::hgrid_proximity;
using Operation = msg::ObstacleOperation;

/// Returns the moment `time` [s] after the start of both clocks.
inline Moment momentAt(double time) {
  Moment moment;
  moment.ros = Time(std::int64_t(1e9 * (1000.0 + time)));
  moment.steady = std::chrono::steady_clock::time_point(std::chrono::milliseconds(std::int64_t(1e3 * (50.0 + time))));
  return moment;
}

inline msg::Shape sphere(double radius) {
  msg::Shape shape;
  shape.kind = msg::ShapeKind::SPHERE;
  shape.dimensions = {radius};
  return shape;
}

inline msg::Obstacle adding(const std::string& name, double x, double radius = 0.1, const std::string& frame = "") {
  msg::Obstacle change;
  change.operation = Operation::ADD;
  change.name = name;
  change.header.frame_id = frame;
  change.pose.position.x = x;
  change.shapes = {sphere(radius)};
  return change;
}

inline msg::Obstacle moving(const std::string& name, double x, const std::string& frame = "") {
  msg::Obstacle change;
  change.operation = Operation::MOVE;
  change.name = name;
  change.header.frame_id = frame;
  change.pose.position.x = x;
  return change;
}

inline msg::Obstacle removing(const std::string& name) {
  msg::Obstacle change;
  change.operation = Operation::REMOVE;
  change.name = name;
  return change;
}

inline msg::Obstacle attaching(const std::string& name, const std::string& link,
                               std::optional<double> x = std::nullopt) {
  msg::Obstacle change;
  change.operation = Operation::ATTACH;
  change.name = name;
  change.link = link;
  change.at_attach_pose = x.has_value();
  change.attach_pose.position.x = x.value_or(0.0);
  return change;
}

inline msg::Obstacle detaching(const std::string& name) {
  msg::Obstacle change;
  change.operation = Operation::DETACH;
  change.name = name;
  return change;
}

inline Body linkOf(const std::string& name, const std::string& frame) {
  Body link;
  link.name = "arm/" + name;
  link.frame = frame;
  link.kind = BodyKind::link;
  link.robot = "arm";
  link.shapes.push_back({Shape::sphere(0.05), Pose::Identity(), 0.0, {}, Eigen::Vector3d::Ones()});
  return link;
}

/// Returns an arm whose link "base" is fixed. Its links "hand" and "tool" are in the frame "cart"; the tool is at x =
/// 0.25 m of the hand and has no geometry.
inline LoadedRobot arm() {
  LoadedRobot robot;
  robot.name = "arm";
  robot.root_frame = "world";
  robot.bodies = {linkOf("base", "world"), linkOf("hand", "cart")};
  robot.groups = {{"world", {{0, Pose::Identity()}}}, {"cart", {{1, Pose::Identity()}}}};
  robot.links["arm/base"] = {0, Pose::Identity()};
  robot.links["arm/hand"] = {1, Pose::Identity()};
  robot.links["arm/tool"] = {1, Pose::Identity()};
  robot.links["arm/tool"].frame_from_link.translation().x() = 0.25;
  robot.without_collision = {"arm/tool"};
  return robot;
}

/// A world with the frame "cart", which moves along x, the configured obstacle "post" at x = 3, and an arm.
class Obstacles : public ::testing::Test {
 protected:
  Obstacles() : phase_(makeCoreNarrowPhase()), world_(settingsOf(params()), false, 1, ledger_, phase_) {
    world_.setRobot(std::make_shared<const LoadedRobot>(arm()));
    tick();
  }

  static const Params& params() {
    static const Params params = [] {
      Params value;
      value.world_frame = "world";
      value.robots.push_back({"arm", "", "", ""});
      value.state_folder = "/not/used";  // so that the world lists its changes
      ObstacleParams post;
      post.body.name = "obstacle/post";
      post.body.frame_from_body.translation().x() = 3.0;
      post.body.shapes.push_back({Shape::sphere(0.1), Pose::Identity(), 0.0, {}, Eigen::Vector3d::Ones()});
      value.obstacles.push_back(post);
      value.max_bodies = 22;  // 20 obstacles
      value.max_rules = 40;
      return value;
    }();
    return params;
  }

  /// Returns the tick after `time` has advanced by 1/8 s and the cart has moved there.
  const Snapshot& tick() {
    time_ += 0.125;
    tf2_msgs::TFMessage message;
    message.transforms.resize(1);
    message.transforms[0].header.frame_id = "world";
    message.transforms[0].header.stamp.fromNSec(std::uint64_t(momentAt(time_).ros.count()));
    message.transforms[0].child_frame_id = "cart";
    message.transforms[0].transform.rotation.w = 1.0;
    message.transforms[0].transform.translation.x = cart(time_);
    world_.transforms().take(viewsOf(message), false, "/driver", momentAt(time_));
    tick_ = world_.tick(momentAt(time_));
    return *tick_->snapshot;
  }
  static double cart(double time) { return 10.0 + time; }

  ObstacleChanges changesOf(const std::vector<msg::Obstacle>& changes, const std::string& complete_set_of) const {
    msg::ApplyObstacles::Request request;
    request.changes = changes;
    request.owner = complete_set_of;
    request.complete_set = !complete_set_of.empty();
    return obstacleChangesOf(request, "/caller", params(), *phase_, &readFile);
  }
  /// Applies the changes. Every second call prepares them before.
  void apply(const std::vector<msg::Obstacle>& changes, const std::string& complete_set_of = "") {
    const ObstacleChanges all = changesOf(changes, complete_set_of);
    std::shared_ptr<PreparedObstacles> prepared;
    prepares_ = !prepares_;
    if (prepares_) prepared = world_.prepareObstacles(all, tick_, momentAt(time_).ros);
    if (between_) std::exchange(between_, nullptr)();
    world_.applyObstacles(all, momentAt(time_).ros, prepared.get());
  }
  /// Stands for reading mesh files: knows one file, a tetrahedron.
  static std::shared_ptr<const TriangleMesh> readFile(const std::string& uri, const Eigen::Vector3d& scale) {
    if (uri != "package://parts/wedge.stl") throw Refusal(Code::resource_missing, "there is no file '" + uri + "'");
    const auto mesh = std::make_shared<TriangleMesh>();
    mesh->vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (Eigen::Vector3d& vertex : mesh->vertices) vertex = vertex.cwiseProduct(scale);
    mesh->triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    return mesh;
  }
  /// Returns the code and the index with which the changes are refused; nullopt if they are applied.
  std::optional<std::pair<Code, std::size_t>> refused(const std::vector<msg::Obstacle>& changes,
                                                      const std::string& complete_set_of = "") {
    try {
      apply(changes, complete_set_of);
    } catch (const ChangeRefusal& refusal) {
      return std::pair(refusal.code(), refusal.index());
    }
    return std::nullopt;
  }
  /// Returns the x of each obstacle [m], by its local name. Obstacles without a pose have NaN.
  static std::map<std::string, double> placesIn(const Snapshot& snapshot) {
    std::map<std::string, double> places;
    for (std::size_t i = 0; i < snapshot.structure().bodies.size(); ++i) {
      if (snapshot.structure().bodies[i].kind != BodyKind::obstacle) continue;
      const BodyPose& pose = snapshot.poses()[i];
      const double x = pose.state == Freshness::unplaced ? std::nan("") : pose.world_from_body.translation().x();
      places[snapshot.structure().bodies[i].name.substr(9)] = std::round(1e6 * x) / 1e6;
    }
    return places;
  }
  static std::uint32_t indexOf(const Snapshot& snapshot, const std::string& name) {
    return snapshot.structure().find(name);
  }
  static const Body& bodyOf(const Snapshot& snapshot, const std::string& name) {
    return snapshot.structure().bodies[indexOf(snapshot, name)];
  }
  /// Returns whether the two bodies may touch.
  static bool mayTouch(const Snapshot& snapshot, const std::string& first, const std::string& second) {
    return snapshot.structure().filter.allowed(indexOf(snapshot, first), indexOf(snapshot, second));
  }
  using Places = std::map<std::string, double>;
  using Refused = std::pair<Code, std::size_t>;

  Ledger ledger_;
  std::shared_ptr<NarrowPhase> phase_;
  World world_;
  double time_ = 0.0;
  std::shared_ptr<const Tick> tick_;
  bool prepares_ = false;          ///< whether the last apply() prepared its changes
  std::function<void()> between_;  ///< the next apply() calls this once, before it applies its changes
};

}  // namespace test
}  // namespace hgrid
