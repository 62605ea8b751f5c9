// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/states/state_doubts.h"

#include <algorithm>

#include "hgrid_proximity/queries/query.h"
#include "maps/map_gap.h"
#include "queries/doubtful_body.h"
#include "queries/question.h"
#include "queries/states/robot_in_state.h"
#include "world/body_gap.h"

namespace hgrid {
namespace {

/// Returns whether the pair filter switches off a body with all bodies of the robot that count.
bool isAllowed(const Snapshot& snapshot, const RobotShapes& robot, std::uint32_t body) {
  return std::all_of(robot.bodies().begin(), robot.bodies().end(), [&](const RobotBody& own) {
    return !own.counts || snapshot.structure().filter.allowed(own.body, body);
  });
}

/// Returns whether a shape of the robot may touch a sphere [m, world].
bool touchesSphere(const RobotInState& robot, const Sphere& sphere, double clearance) {
  const Sphere local{sphere.center - robot.snapshot.origin(), sphere.radius + clearance};
  for (std::size_t i = 0; i < robot.robot.counting(); ++i) {
    if (touches(local, robot.boundsOf(i))) return true;
  }
  return false;
}

/// Returns whether a shape of the robot is at most `reach` [m] from a body that has cells.
bool comesNearCells(const RobotInState& robot, const PlacedMap& map, double reach) {
  const Eigen::Vector3d& origin = robot.snapshot.origin();
  for (std::size_t i = 0; i < robot.robot.counting(); ++i) {
    if (robot.allowed(i, map.body)) continue;
    if (gapTo(*map.cells.grid, boxInMap(map.map_from_world, robot.boundsOf(i), origin), reach) <= reach) return true;
  }
  return false;
}

/// Returns whether a shape of the robot is at most `reach` [m] from a shape of a body.
bool comesNear(const RobotInState& robot, std::uint32_t body, double reach) {
  if (!(reach <= kQueryReach)) return true;
  const Structure& structure = robot.snapshot.structure();
  for (std::uint32_t proxy = structure.first_proxy[body]; proxy < structure.first_proxy[body + 1]; ++proxy) {
    const Aabb grown_box = grown(robot.snapshot.boxes()[proxy], reach);
    for (std::size_t i = 0; i < robot.robot.counting(); ++i) {
      if (robot.allowed(i, body) || !overlap(grown_box, robot.boundsOf(i))) continue;
      const Proximity found = robot.measureBody(i, body, structure.shapeOf(proxy), reach);
      if (found.status == Measure::not_measured || found.lower_bound <= reach) return true;
    }
  }
  return false;
}

/// Returns the worst state of the links of its robot that move together with an attached obstacle; late, if no link has
/// shapes.
Freshness worstOfLinks(const Snapshot& snapshot, const RobotShapes& robot, std::uint32_t attached) {
  const BodyList& bodies = snapshot.structure().bodies;
  Freshness worst = Freshness::late;
  const auto own = std::find_if(robot.bodies().begin(), robot.bodies().end(),
                                [&](const RobotBody& one) { return one.body == attached; });
  for (const RobotBody& other : robot.bodies()) {
    const Body& link = bodies[other.body];
    const bool is_of_robot = link.kind == BodyKind::link && link.robot == bodies[own->own_link].robot;
    if (is_of_robot && other.group == own->group) worst = std::max(worst, snapshot.poses()[other.body].state);
  }
  return worst;
}

}  // namespace

StateDoubts::StateDoubts(const Snapshot& snapshot, const RobotShapes& robot, const WorldShapes& world,
                         const QueryScope& scope, std::uint32_t root_body)
    : world_(world) {
  if (root_body != Structure::kNone) {
    const Body& body = snapshot.structure().bodies[root_body];
    const BodyPose& pose = snapshot.poses()[root_body];
    if (pose.reach > 0.0 || pose.state >= Freshness::frozen) {
      doubts_.push_back({Unknown::stale_body, doubtOf(body, pose)});
      by_snapshot_ = 1;
    }
  }
  addGaps(snapshot, robot, scope);
  addBodies(snapshot, robot, scope);
  asks_maps_ = snapshot.reportsUnmapped() && asksMaps(snapshot, scope);
  if (!asks_maps_) return;
  doubts_.push_back({Unknown::unmapped, "a shape of the robot is in space that no map knows to be free"});
}

void StateDoubts::addGaps(const Snapshot& snapshot, const RobotShapes& robot, const QueryScope& scope) {
  for (const SourceGap& gap : snapshot.gaps()) {
    if (!inScope(snapshot, scope, gap)) continue;
    const std::uint32_t body = snapshot.structure().find(gap.bodies);
    if (body != Structure::kNone) {
      // The joints place the links. If one of their shapes is not known, addBodies() adds a doubt.
      if (robot.moves(body) || isAllowed(snapshot, robot, body)) continue;
    }
    StateDoubt doubt{Unknown::incomplete, "source '" + gap.source + "' is not complete: " + gap.sentence};
    if (gap.within) {
      doubt.where = StateDoubt::Where::sphere;
      doubt.within = *gap.within;
    }
    doubts_.push_back(std::move(doubt));
  }
}

void StateDoubts::addBodies(const Snapshot& snapshot, const RobotShapes& robot, const QueryScope& scope) {
  for (const std::uint32_t i : snapshot.doubtful()) {
    const Body& body = snapshot.structure().bodies[i];
    const BodyPose& pose = snapshot.poses()[i];
    if (!inScope(snapshot, scope, i)) continue;
    if (robot.moves(i)) {
      if (!body.covered && !body.waived) {
        doubts_.push_back({Unknown::incomplete, "UNCOVERED " + body.name + ": " + body.note});
      } else if (body.kind != BodyKind::link && pose.state > worstOfLinks(snapshot, robot, i)) {
        doubts_.push_back({Unknown::stale_body, doubtOf(body, pose)});
      }
      continue;
    }
    if (isAllowed(snapshot, robot, i)) continue;
    if (canBeAnywhere(body, pose)) {
      if (snapshot.hasGap(body.name)) continue;  // addGaps() has added a doubt that says where the body can be
      const bool stale = pose.state < Freshness::lost && body.covered;
      doubts_.push_back({stale ? Unknown::stale_body : Unknown::incomplete, doubtOf(body, pose)});
    } else if (pose.reach > 0.0) {
      StateDoubt doubt{Unknown::stale_body, doubtOf(body, pose), StateDoubt::Where::near_body};
      doubt.body = i;
      doubt.reach = pose.reach;
      doubts_.push_back(std::move(doubt));
    }
  }
}

std::optional<std::uint32_t> StateDoubts::findAnywhere(bool by_snapshot) const {
  for (std::size_t i = by_snapshot ? 0 : by_snapshot_; i < doubts_.size(); ++i) {
    if (isAnywhere(doubts_[i])) return static_cast<std::uint32_t>(i);
  }
  return std::nullopt;
}

std::optional<std::uint32_t> StateDoubts::findNear(const RobotInState& robot, double clearance) const {
  for (std::size_t i = by_snapshot_; i < doubts_.size(); ++i) {
    const StateDoubt& doubt = doubts_[i];
    bool applies = false;
    if (doubt.because == Unknown::unmapped) {
      applies = !isFree(robot, clearance);
    } else if (doubt.where == StateDoubt::Where::sphere) {
      applies = touchesSphere(robot, doubt.within, clearance);
    } else if (doubt.where == StateDoubt::Where::near_body) {
      const double reach = doubt.reach + clearance;
      applies = comesNear(robot, doubt.body, reach) ||
                std::any_of(world_.maps().begin(), world_.maps().end(), [&](const PlacedMap& map) {
                  return map.body == doubt.body && comesNearCells(robot, map, reach);
                });
    }
    if (applies) return static_cast<std::uint32_t>(i);
  }
  return std::nullopt;
}

/// Returns whether for each shape of the robot, a map knows the space around the shape to be free.
bool StateDoubts::isFree(const RobotInState& robot, double clearance) const {
  for (std::size_t i = 0; i < robot.robot.counting(); ++i) {
    const bool free = std::any_of(world_.maps().begin(), world_.maps().end(), [&](const PlacedMap& map) {
      if (!map.cells.unmapped) return false;
      const Eigen::AlignedBox3d box = boxInMap(map.map_from_world, robot.boundsOf(i), robot.snapshot.origin());
      const double distance = map.reach + clearance + touchSlack(box.center(), 0.0);
      return map.cells.unmapped->extent.contains(grown(box, distance)) &&
             !(gapTo(map.cells.unmapped->cells, box, distance) <= distance);
    });
    if (!free) return false;
  }
  return true;
}

}  // namespace hgrid
