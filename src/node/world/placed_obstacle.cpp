// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/placed_obstacle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bodies/nearest_names.h"
#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/pairs/pair_rule.h"
#include "hgrid_proximity/refusal.h"
#include "node/wire/poses_message.h"

namespace hgrid {
namespace {

bool isSamePose(const Pose& a, const Pose& b) { return a.matrix() == b.matrix(); }

bool isSameMesh(const std::shared_ptr<const TriangleMesh>& a, const std::shared_ptr<const TriangleMesh>& b) {
  if (!a || !b) return a == b;
  return a->vertices == b->vertices && a->triangles == b->triangles;
}

bool isSameShape(const BodyShape& a, const BodyShape& b) {
  return a.shape.kind() == b.shape.kind() && a.shape.dimensions() == b.shape.dimensions() && a.padding == b.padding &&
         a.resource == b.resource && a.scale == b.scale && isSamePose(a.body_from_shape, b.body_from_shape) &&
         isSameMesh(a.shape.mesh(), b.shape.mesh());
}

/// Returns where `frame` is in `target`. @throws Refusal unknown_frame; extrapolation if its newest pose is old
Pose presentPose(const std::string& target, const std::string& frame, const std::string& what,
                 const Surroundings& around) {
  return around.lookup.atOrNewest(target, frame, around.now, around.params.stale_after, what);
}

/// Returns where `frame` was in the world. @throws Refusal unknown_frame, extrapolation
Pose poseAt(Time time, const std::string& frame, const std::string& what, const Surroundings& around) {
  std::string why_not;
  const std::optional<FramePose> pose = around.lookup.at(around.world_frame, frame, time, &why_not);
  if (pose) return checkedPose(pose->translation, pose->rotation.coeffs(), what);
  const bool is_known = around.lookup.newest(around.world_frame, frame).has_value();
  throw Refusal(is_known ? Code::extrapolation : Code::unknown_frame,
                what + " has no pose at " + text(seconds(time)) + " s: " + printable(why_not, 300) +
                    "; send another stamp, or 0 for its present pose");
}

std::string frameOf(const PlacedObstacle& obstacle) {
  return "the frame '" + printable(obstacle.frame) + "' of '" + printable(obstacle.what->body.name) + "'";
}

void checkPlace(const PlacedObstacle& obstacle, const Surroundings& around) {
  checkWithin(obstacle.frame_from_body.translation(), around.params.world_limit,
              "the pose of '" + printable(obstacle.what->body.name) + "'");
}

/// Returns the end of a sentence about a link that no robot has, see similarNames(). Empty if there are many links.
std::string similarLinks(const std::string& link, const RobotEntries& robots) {
  NameList names;
  for (const auto& robot : robots) {
    if (!robot.second.inWorld()) continue;
    for (const auto& known : robot.second.model->links) names.push_back(&known.first);
  }
  return names.size() <= kQuicklyCompared ? similarNames(link, names) : std::string();
}

/// Returns the full name of the link that an obstacle is attached to. @throws Refusal unknown_id, conflict
std::string linkOf(const Attachment& attachment, const std::string& what, const RobotEntries& robots) {
  if (findLink(robots, attachment.link) != nullptr) return attachment.link;
  std::vector<std::string> links;
  if (attachment.without_robot) links = linksNamed(robots, attachment.link);
  if (links.size() == 1) return links.front();
  if (links.empty()) {
    throw Refusal(Code::unknown_id, what +
                                        ": no robot in the world has this link; give the name of the robot and of "
                                        "its link, as in robot/tool0" +
                                        similarLinks(attachment.link, robots));
  }
  throw Refusal(Code::conflict, what + ": " + std::to_string(links.size()) +
                                    " robots have a link of this name, as in '" + printable(links[0]) + "' and '" +
                                    printable(links[1]) + "'; give the name of the robot, too");
}

bool isFixed(const PlacedObstacle& obstacle, const std::string& world_frame) {
  // Nobody knows where an obstacle is after it was lost. It must then have pairs with fixed bodies, so it is not fixed.
  return obstacle.frame == world_frame && !obstacle.what->moving && !obstacle.what->lost_at_end;
}

bool moveTogether(const PlacedObstacle& a, const PlacedObstacle& b) {
  if (!a.attachment != !b.attachment) return false;
  return a.attachment ? a.attachment->link == b.attachment->link : a.frame == b.frame;
}

/// Returns the largest speed [m/s] that is expected of the points of an obstacle that moves with a link.
double speedWith(const LoadedRobot& robot, const std::string& link, const Pose& link_from_body,
                 const PlacedObstacle& obstacle, const Params& params) {
  const LoadedRobot::Group& group = robot.groups[robot.links.at(link).group];
  double speed = group.members.empty() ? params.default_max_speed : 0.0;
  if (robot.read) {  // the obstacle may reach farther out than the link, and so be faster
    const RobotModel& model = robot.read->model;
    const int index = model.find(link.substr(robot.name.size() + 1));
    const double reach = link_from_body.translation().norm() + reachOf(obstacle.what->body.shapes);
    speed = expectedSpeed(robot, model, static_cast<std::uint32_t>(index), reach, params);
  }
  for (const auto& member : group.members) speed = std::max(speed, robot.bodies[member.first].max_speed);
  return speed;
}

void setCarrierSpeed(PlacedObstacle& obstacle, const Surroundings& around) {
  obstacle.carrier_speed = carrierSpeedOf(obstacle, around.robots, around.world_frame, around.params);
}

void checkNoGlob(const std::string& name) {
  if (!isGlob(name)) return;
  throw Refusal(Code::bad_id,
                "'" + printable(name) + "' contains *; the names of attached obstacles and of their links must not");
}

}  // namespace

std::string followedFrame(const std::string& frame, const std::string& obstacle, const std::string& world_frame) {
  if (frame.empty()) return world_frame;
  return frame == kPosesFrame ? posesFrameOf(obstacle) : frame;
}

Time endOf(const RequestedObstacle& obstacle, Time now) {
  if (obstacle.lifetime == std::chrono::nanoseconds(0)) return Time::max();
  return obstacle.lifetime > Time::max() - now ? Time::max() : now + obstacle.lifetime;
}

Body bodyOf(const PlacedObstacle& obstacle, const std::string& world_frame) {
  Body body = obstacle.what->body;
  body.frame = obstacle.frame;
  body.frame_from_body = obstacle.frame_from_body;
  body.mobility = isFixed(obstacle, world_frame) ? Mobility::fixed : Mobility::moving;
  if (obstacle.restored) {
    body.note = "RESTORED: stored by an earlier run of the node; add it again unchanged, or change it, to confirm it";
  }
  if (obstacle.attachment) {
    body.max_speed = std::max(body.max_speed, obstacle.carrier_speed);
    body.speed_bound = std::numeric_limits<double>::infinity();  // its points may be faster than those of the link
  } else if (!std::isfinite(body.speed_bound)) {                 // otherwise somebody has said how fast it can be
    body.max_speed = std::max(body.max_speed, obstacle.carrier_speed);
  }
  return body;
}

bool isSame(const RequestedObstacle& a, const RequestedObstacle& b) {
  return a.moving == b.moving && a.body.group == b.body.group && a.lifetime == b.lifetime &&
         a.lost_at_end == b.lost_at_end && a.body.margin == b.body.margin && a.body.max_speed == b.body.max_speed &&
         std::equal(a.body.shapes.begin(), a.body.shapes.end(), b.body.shapes.begin(), b.body.shapes.end(),
                    isSameShape);
}

bool isSame(const ObstaclePlace& first, const ObstaclePlace& second) {
  const bool is_present = second.at && second.at->count() == 0;  // the frame may have moved since
  return !is_present && first.at == second.at && first.frame == second.frame &&
         isSamePose(first.frame_from_body, second.frame_from_body);
}

bool isAtSamePlace(const PlacedObstacle& a, const PlacedObstacle& b) {
  return a.frame == b.frame && isSamePose(a.frame_from_body, b.frame_from_body);
}

void put(PlacedObstacle& obstacle, const ObstaclePlace& place, const Surroundings& around) {
  obstacle.asked = place;
  obstacle.frame = followedFrame(place.frame, obstacle.what->body.name, around.world_frame);
  obstacle.frame_from_body = place.frame_from_body;
  if (place.at && obstacle.frame != around.world_frame) {
    const std::string what = frameOf(obstacle);
    const Pose world_from_frame = place.at->count() == 0 ? presentPose(around.world_frame, obstacle.frame, what, around)
                                                         : poseAt(*place.at, obstacle.frame, what, around);
    obstacle.frame_from_body = world_from_frame * place.frame_from_body;
    obstacle.frame = around.world_frame;
  }
  checkPlace(obstacle, around);
  setCarrierSpeed(obstacle, around);
}

void attach(PlacedObstacle& obstacle, const Attachment& attachment, const Surroundings& around) {
  checkNoGlob(obstacle.what->body.name);
  checkNoGlob(attachment.link);
  const std::string what =
      "'" + printable(obstacle.what->body.name) + "' cannot be attached to '" + printable(attachment.link) + "'";
  auto resolved = std::make_shared<Attachment>(attachment);
  resolved->link = linkOf(attachment, what, around.robots);
  const LoadedRobot* robot = findLink(around.robots, resolved->link);
  if (!resolved->link_from_body) {
    const LoadedRobot::Seat& seat = robot->links.at(resolved->link);
    const std::string& frame = robot->groups[seat.group].frame;
    Pose frame_from_body = obstacle.frame_from_body;
    if (obstacle.frame != frame) {
      frame_from_body = presentPose(frame, obstacle.frame,
                                    what + " at its present pose: frame '" + printable(obstacle.frame) +
                                        "', relative to '" + printable(frame) + "',",
                                    around) *
                        frame_from_body;
    }
    resolved->link_from_body = seat.frame_from_link.inverse() * frame_from_body;
  }
  obstacle.attachment = std::move(resolved);
  follow(obstacle, around.robots, around.params);
  checkPlace(obstacle, around);
}

void append(PlacedObstacle& obstacle, const RequestedObstacle& added, const Surroundings& around) {
  PlacedObstacle apart = obstacle;
  put(apart, added.place, around);
  Pose frame_from_added = apart.frame_from_body;
  if (apart.frame != obstacle.frame) {
    frame_from_added = presentPose(obstacle.frame, apart.frame, frameOf(apart), around) * frame_from_added;
  }
  const Pose body_from_added = obstacle.frame_from_body.inverse() * frame_from_added;
  const std::size_t count = obstacle.what->body.shapes.size() + added.body.shapes.size();
  if (count > kMostShapes) {
    throw Refusal(Code::limit, "'" + printable(added.body.name) + "' would have " + std::to_string(count) +
                                   " shapes; at most " + std::to_string(kMostShapes) + " are allowed");
  }
  auto what = std::make_shared<RequestedObstacle>(*obstacle.what);
  for (BodyShape shape : added.body.shapes) {
    shape.body_from_shape = body_from_added * shape.body_from_shape;
    what->body.shapes.push_back(std::move(shape));
  }
  obstacle.what = std::move(what);
  // It may reach farther out now.
  obstacle.attachment ? follow(obstacle, around.robots, around.params) : setCarrierSpeed(obstacle, around);
}

void checkPlanes(const PlacedObstacle& obstacle, const std::string& world_frame) {
  if (isFixed(obstacle, world_frame)) return;
  const Body& body = obstacle.what->body;
  const bool has_plane = std::any_of(body.shapes.begin(), body.shapes.end(),
                                     [](const BodyShape& shape) { return shape.shape.kind() == ShapeKind::plane; });
  if (!has_plane) return;
  throw Refusal(Code::unsupported,
                "'" + printable(body.name) + "' has a plane, so it must be fixed in the world frame '" +
                    printable(world_frame) + "'; it " +
                    (obstacle.attachment ? "is attached to a link"
                     : obstacle.frame != world_frame
                         ? "follows the frame '" + printable(obstacle.frame) + "': give a stamp to place it once"
                     : obstacle.what->moving ? std::string("is declared moving")
                                             : "would become LOST at the end of its lifetime"));
}

void placeShapes(PlacedObstacle& obstacle, const std::vector<Pose>& poses) {
  const std::vector<BodyShape>& shapes = obstacle.what->body.shapes;
  if (poses.size() != shapes.size()) {
    throw Refusal(Code::bad_geometry, "'" + printable(obstacle.what->body.name) + "' has " +
                                          std::to_string(shapes.size()) + " shapes, but " +
                                          std::to_string(poses.size()) + " poses of shapes are given");
  }
  auto what = std::make_shared<RequestedObstacle>(*obstacle.what);
  for (std::size_t i = 0; i < poses.size(); ++i) what->body.shapes[i].body_from_shape = poses[i];
  obstacle.what = std::move(what);
}

void detach(PlacedObstacle& obstacle, const Surroundings& around) {
  if (!obstacle.attachment) {
    throw Refusal(Code::conflict,
                  "'" + printable(obstacle.what->body.name) + "' is not attached to a link, so it cannot be detached");
  }
  ObstaclePlace place{"", obstacle.frame_from_body, std::nullopt};
  if (obstacle.frame != around.world_frame) {
    place.frame_from_body =
        presentPose(around.world_frame, obstacle.frame, frameOf(obstacle), around) * obstacle.frame_from_body;
  }
  obstacle.attachment.reset();
  obstacle.touch.clear();
  put(obstacle, place, around);
}

void checkMoveTogether(const PlacedObstacle& added, const PlacedObstacle& other) {
  if (moveTogether(added, other)) return;
  const std::string where = other.attachment ? "is attached to '" + printable(other.attachment->link) + "'"
                                             : "follows the frame '" + printable(other.frame) + "'";
  throw Refusal(Code::conflict, "'" + printable(added.what->body.name) + "' cannot be in the group '" +
                                    printable(added.what->body.group) + "', because '" +
                                    printable(other.what->body.name) + "' " + where +
                                    "; obstacles of one group must follow the same frame or link");
}

void carry(PlacedObstacle& obstacle, const PlacedObstacle& before, const PlacedObstacle& after,
           const Surroundings& around) {
  const Pose other_from_body = before.frame_from_body.inverse() * obstacle.frame_from_body;
  obstacle.frame = after.frame;
  obstacle.frame_from_body = after.frame_from_body * other_from_body;
  obstacle.asked = {after.frame == around.world_frame ? "" : after.frame, obstacle.frame_from_body, std::nullopt};
  obstacle.attachment.reset();
  if (after.attachment) {
    checkNoGlob(obstacle.what->body.name);
    auto attachment = std::make_shared<Attachment>(*after.attachment);
    attachment->link_from_body = *after.attachment->link_from_body * other_from_body;
    obstacle.attachment = std::move(attachment);
  }
  obstacle.touch = after.touch;
  obstacle.carrier_speed = after.carrier_speed;
  obstacle.attachment ? follow(obstacle, around.robots, around.params) : setCarrierSpeed(obstacle, around);
  checkPlace(obstacle, around);
}

void follow(PlacedObstacle& obstacle, const RobotEntries& robots, const Params& params) {
  const Attachment& attachment = *obstacle.attachment;
  const LoadedRobot* robot = findLink(robots, attachment.link);
  if (robot == nullptr) return;
  const LoadedRobot::Seat& seat = robot->links.at(attachment.link);
  const LoadedRobot::Group& group = robot->groups[seat.group];
  obstacle.frame = group.frame;
  obstacle.frame_from_body = seat.frame_from_link * *attachment.link_from_body;
  obstacle.asked = {obstacle.frame, obstacle.frame_from_body, std::nullopt};
  obstacle.touch = attachment.touch;
  obstacle.touch.push_back(attachment.link);
  for (const std::string& link : attachment.touch_links) {
    if (!isGlob(link)) obstacle.touch.push_back(joined(robot->name, link));
  }
  obstacle.carrier_speed = speedWith(*robot, attachment.link, *attachment.link_from_body, obstacle, params);
  for (const auto& member : group.members) {
    const Body& rigid = robot->bodies[member.first];  // it never moves relative to the obstacle
    if (rigid.name != attachment.link && !isGlob(rigid.name)) obstacle.touch.push_back(rigid.name);
  }
}

double carrierSpeedOf(const PlacedObstacle& obstacle, const RobotEntries& robots, const std::string& world_frame,
                      const Params& params) {
  double speed = 0.0;
  if (obstacle.frame == world_frame) return speed;
  for (const std::string& link : linksAt(robots, obstacle.frame)) {
    speed = std::max(speed, speedWith(*findLink(robots, link), link, obstacle.frame_from_body, obstacle, params));
  }
  return speed;
}

}  // namespace hgrid
