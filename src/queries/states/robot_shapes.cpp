// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/states/robot_shapes.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "hgrid_proximity/refusal.h"
#include "narrow/inner_spheres.h"

namespace hgrid {
namespace {

constexpr float kUnit = 6e-8f;  // relative rounding error of one float operation
// Bound of the rounding errors of a vector that is turned in floats, relative to its length.
constexpr double kTurnRounding = 1e-6;
// Limit of: volume of the box of a cluster / sum of the volumes of the boxes of its shapes.
constexpr float kMaxVolumeRatio = 8.0f;

/// Returns the axis-aligned box around a tilted one.
Eigen::AlignedBox3f boundsOf(const TiltedBox<float>& box) {
  Eigen::Vector3f center, reach;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    center[row] = box.center[k];
    reach[row] = reachAlong(box, k);
  }
  return {center - reach, center + reach};
}

/// Returns the volume [m^3] of a box.
float volume(const TiltedBox<float>& box) { return 8.0f * box.half[0] * box.half[1] * box.half[2]; }

/// Prepares a mesh of the robot, because it will be measured again and again.
void makeHulls(const BodyShape& shape) {
  const auto* const mesh = dynamic_cast<const MeshSolid*>(shape.solid.get());
  if (mesh != nullptr) mesh->tree().makeHulls();
}

/// Returns the part of a frame's name that comes before the name of the link; empty if there is none.
std::string prefixOf(const std::string& frame, const std::string& link) {
  if (frame.size() <= link.size() || frame.compare(frame.size() - link.size(), link.size(), link) != 0) return {};
  return frame.substr(0, frame.size() - link.size());
}

/// Returns the center of four groups relative to the origin, as floats.
Four rounded(const FourDoubles& value, double less) {
  return Four{static_cast<float>(value.low[0] - less), static_cast<float>(value.low[1] - less),
              static_cast<float>(value.high[0] - less), static_cast<float>(value.high[1] - less)};
}

/// The pose of a rigid group in four states, in floats.
struct GroupFloats {
  GroupFloats(const FourPoses& group, const Eigen::Vector3d& origin) {
    for (std::size_t i = 0; i < 9; ++i) turn[i] = rounded(group.turn[i], 0.0);
    for (std::size_t k = 0; k < 3; ++k) shift[k] = rounded(group.shift[k], origin[static_cast<Eigen::Index>(k)]);
    rounding = (absolute(shift[0]) + absolute(shift[1]) + absolute(shift[2])) * (4.0f * kUnit);
  }
  /// Rotates a vector of the group.
  Four turned(const float (&vector)[3], std::size_t row) const {
    return turn[3 * row] * allFour(vector[0]) + turn[3 * row + 1] * allFour(vector[1]) +
           turn[3 * row + 2] * allFour(vector[2]);
  }
  Four turn[9], shift[3];
  Four rounding;  // [m] bound of the rounding errors of a point that is near the origin of the group
};

}  // namespace

TiltedBox<float> tiltedBoxOf(const BodyShape& shape, const Pose& frame_from_shape, double relative_rounding) {
  const Eigen::AlignedBox3d local =
      inDouble(boxOf(shape.shape, Pose::Identity(), shape.padding, Eigen::Vector3d::Zero()));
  const Eigen::Vector3d center = frame_from_shape * local.center(), half = 0.5 * local.sizes();
  const double rounding = relative_rounding * center.norm();
  TiltedBox<float> box;
  box.is_ball = shape.shape.kind() == ShapeKind::sphere;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) box.axes[i][k] = static_cast<float>(frame_from_shape.linear()(k, i));
    box.center[i] = static_cast<float>(center[i]);
    box.half[i] = roundedUp(half[i] + rounding + kTurnRounding * half.sum());
  }
  return box;
}

std::vector<Sphere> spheresInside(const BodyShape& shape, const Pose& frame_from_shape) {
  if (!shape.solid) return {};
  std::vector<Sphere> spheres = innerSpheresOf(shape.shape, *shape.solid);
  for (Sphere& sphere : spheres) {
    sphere.center = frame_from_shape * sphere.center;
    sphere.radius += shape.padding;
  }
  return spheres;
}

RobotShapes::RobotShapes(const Snapshot& snapshot, const Kinematics& kinematics, const std::string& robot,
                         const StateCheckerOptions& options, const QueryScope& scope)
    : is_own_(snapshot.structure().bodies.size()) {
  addLinks(snapshot, kinematics, robot);
  addAttached(snapshot, kinematics, robot.empty(), options.world_frame);
  chooseGroup(kinematics, options.group);
  chooseRobots(snapshot, options.robots);
  addShapes(snapshot, scope);
  findCarriers(kinematics);
  addClusters();
  addSelfPairs(snapshot.structure().filter);
}

void RobotShapes::addLinks(const Snapshot& snapshot, const Kinematics& kinematics, const std::string& robot) {
  const BodyList& bodies = snapshot.structure().bodies;
  const std::vector<std::string>& links = kinematics.links();
  std::map<std::string, std::uint32_t> link_of_body;  // by the name of the body
  std::map<std::string, std::size_t> links_of_robot;  // number of links, by the name of the robot
  std::set<std::string> present;                      // names of the robots that have bodies
  for (std::uint32_t link = 0; link < links.size(); ++link) {
    const std::string name = robot.empty() ? links[link] : robot + "/" + links[link];
    link_of_body[name] = link;
    ++links_of_robot[robot.empty() ? name.substr(0, name.find('/')) : robot];
  }
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    const auto of_robot = links_of_robot.find(body.robot);
    if (body.kind != BodyKind::link || of_robot == links_of_robot.end()) continue;
    const auto found = link_of_body.find(body.name);
    const bool is_same = found != link_of_body.end() && (robot.empty() || found->second == body.link) &&
                         (!body.links || body.links->size() == of_robot->second);
    if (!is_same) {
      throw Refusal(Code::conflict, "'" + printable(body.name) +
                                        "' is not the same link in the snapshot and in the model of the joints; use "
                                        "the model from which the robot of the snapshot was loaded");
    }
    const std::uint32_t link = found->second;
    bodies_.push_back({i, i, kinematics.groupOfLink()[link], true, kinematics.groupFromLink()[link]});
    is_own_[i] = true;
    present.insert(body.robot);
  }
  for (const auto& [name, count] : links_of_robot) {
    if (name.empty() || present.count(name) > 0) continue;  // the world link of joined robots has no name
    throw Refusal(Code::unknown_id, "robot '" + printable(name) +
                                        "' has no links in the snapshot; it must be loaded before its states "
                                        "can be checked");
  }
}

/// Adds the obstacles that follow the frame of a link. An obstacle in the frame of a fixed link rests in the world.
void RobotShapes::addAttached(const Snapshot& snapshot, const Kinematics& kinematics, bool joined,
                              const std::string& world_frame) {
  struct LinkOfFrame {
    std::uint32_t link;  // index into Kinematics::links()
    std::uint32_t body;  // index into Structure::bodies of a link of the same robot
  };
  const BodyList& bodies = snapshot.structure().bodies;
  const std::vector<std::string>& links = kinematics.links();
  std::map<std::string, LinkOfFrame> link_of_frame;
  std::set<std::string> seen;
  std::set<std::pair<std::string, std::uint32_t>> fixed;  // names of robots with the rigid groups that cannot move
  for (const RobotBody& own : bodies_) {
    const Body& body = bodies[own.body];
    if (body.mobility == Mobility::fixed) fixed.emplace(body.robot, own.group);
    if (!seen.insert(body.robot).second) continue;
    const std::string robot = body.robot + "/", before = joined ? robot : "";
    const std::string prefix = prefixOf(body.frame, body.name.substr(robot.size()));
    for (std::uint32_t link = 0; link < links.size(); ++link) {
      if (links[link].rfind(before, 0) != 0) continue;
      link_of_frame[prefix + links[link].substr(before.size())] = {link, own.body};
    }
  }
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    if (body.kind != BodyKind::obstacle || body.mobility == Mobility::fixed || body.frame == world_frame) continue;
    const auto found = link_of_frame.find(body.frame);
    if (found == link_of_frame.end()) continue;
    const LinkOfFrame& frame = found->second;
    const std::uint32_t group = kinematics.groupOfLink()[frame.link];
    if (fixed.count({bodies[frame.body].robot, group}) > 0) continue;
    bodies_.push_back({i, frame.body, group, true, kinematics.groupFromLink()[frame.link] * body.frame_from_body});
    is_own_[i] = true;
  }
}

/// Lets the bodies of all robots except these not count. An empty list changes nothing.
void RobotShapes::chooseRobots(const Snapshot& snapshot, const std::vector<std::string>& robots) {
  if (robots.empty()) return;
  const auto robotOf = [&](const RobotBody& own) -> const std::string& {
    return snapshot.structure().bodies[own.own_link].robot;
  };
  for (const std::string& name : robots) {
    const auto is_of = [&](const RobotBody& own) { return robotOf(own) == name; };
    if (std::any_of(bodies_.begin(), bodies_.end(), is_of)) continue;
    throw Refusal(Code::unknown_id, "robot '" + printable(name) + "' is not among the robots that are checked");
  }
  for (RobotBody& own : bodies_) {
    if (std::find(robots.begin(), robots.end(), robotOf(own)) == robots.end()) own.counts = false;
  }
}

/// Lets only the bodies count that a variable of the group moves. An empty list changes nothing.
void RobotShapes::chooseGroup(const Kinematics& kinematics, const std::vector<std::string>& group) {
  if (group.empty()) return;
  std::vector<bool> is_chosen(kinematics.variables().size());
  for (const std::string& name : group) {
    const int variable = kinematics.find(name);
    if (variable < 0) {
      throw Refusal(Code::unknown_id, "'" + printable(name) + "' of the group is not a variable of robot '" +
                                          printable(kinematics.name()) +
                                          "'; fixed joints and joints that mimic others have none");
    }
    is_chosen[static_cast<std::size_t>(variable)] = true;
  }
  const std::vector<JointMotion>& joints = kinematics.state().groups;
  std::vector<bool> moves(joints.size());
  for (std::size_t i = 1; i < joints.size(); ++i) {
    const std::uint32_t first = joints[i].variable;
    moves[i] = moves[joints[i].parent];
    for (std::uint32_t variable = first; variable < first + joints[i].variables(); ++variable) {
      if (is_chosen[variable]) moves[i] = true;
    }
  }
  for (RobotBody& own : bodies_) own.counts = moves[own.group];
}

void RobotShapes::addShapes(const Snapshot& snapshot, const QueryScope& scope) {
  for (const bool counts : {true, false}) {
    addShapesOf(snapshot, scope, counts);
    if (counts) counting_ = shapes_.size();
  }
}

/// Adds the shapes of the bodies that count, or those of the others, sorted by rigid group.
void RobotShapes::addShapesOf(const Snapshot& snapshot, const QueryScope& scope, bool counts) {
  const auto before = static_cast<std::ptrdiff_t>(shapes_.size());
  for (const RobotBody& own : bodies_) {
    if (own.counts != counts || !inScope(snapshot, scope, own.body)) continue;
    const std::vector<BodyShape>& shapes = snapshot.structure().bodies[own.body].shapes;
    for (std::uint32_t i = 0; i < shapes.size(); ++i) {
      const Pose group_from_shape = own.group_from_body * shapes[i].body_from_shape;
      const TiltedBox<float> box = tiltedBoxOf(shapes[i], group_from_shape, kTurnRounding);
      makeHulls(shapes[i]);
      const bool is_straight = group_from_shape.linear() == Eigen::Matrix3d::Identity();
      shapes_.push_back({own.body, i, own.group, group_from_shape, &shapes[i], box, is_straight, coverOf(box),
                         FourSpheres(spheresInside(shapes[i], group_from_shape)), MeshClearance(shapes[i])});
    }
  }
  std::stable_sort(shapes_.begin() + before, shapes_.end(),
                   [](const RobotShape& a, const RobotShape& b) { return a.group < b.group; });
}

void RobotShapes::findCarriers(const Kinematics& kinematics) {
  const std::vector<JointMotion>& joints = kinematics.state().groups;
  carries_shapes_.resize(joints.size());
  for (const RobotShape& shape : shapes_) carries_shapes_[shape.group] = true;
  for (std::size_t i = joints.size(); i-- > 1;) {
    if (carries_shapes_[i]) carries_shapes_[joints[i].parent] = true;
  }
}

/// Divides the shapes into clusters. A shape joins the cluster of the shape before it, unless the box of the cluster
/// would become much larger than the boxes of its shapes.
void RobotShapes::addClusters() {
  Eigen::AlignedBox3f bounds;  // of the last cluster, in the frame of its group
  float volumes = 0.0f;        // [m^3] sum of the volumes of the boxes of its shapes
  for (std::uint32_t i = 0; i < shapes_.size(); ++i) {
    const Eigen::AlignedBox3f shape = boundsOf(shapes_[i].in_group);
    const bool joins = i > 0 && i != counting_ && shapes_[i].group == shapes_[i - 1].group &&
                       i - clusters_.back().first < ShapeCluster::kMost &&
                       bounds.merged(shape).volume() <= kMaxVolumeRatio * (volumes + shape.volume());
    if (!joins) {
      clusters_.push_back({i, i});
      bounds.setEmpty();
      volumes = 0.0f;
    }
    clusters_.back().last = i + 1;
    if (i < counting_) counting_clusters_ = clusters_.size();
    bounds.extend(shape);
    volumes += shape.volume();
  }
}

void RobotShapes::addSelfPairs(const PairFilter& filter) {
  std::vector<SelfPair> few;
  for (std::uint32_t a = 0; a < counting_clusters_; ++a) {
    for (std::uint32_t b = a; b < clusters_.size(); ++b) {
      const std::vector<SelfPair> pairs = pairsOf(filter, clusters_[a], clusters_[b]);
      if (pairs.size() < SelfBlock::kFew) {
        few.insert(few.end(), pairs.begin(), pairs.end());
      } else {
        addSelfBlock(a, b, pairs);
      }
    }
  }
  if (!few.empty()) addSelfBlock(Structure::kNone, Structure::kNone, few);
}

/// Returns the self pairs of the shapes of two clusters, which may be the same.
std::vector<SelfPair> RobotShapes::pairsOf(const PairFilter& filter, const ShapeCluster& a,
                                           const ShapeCluster& b) const {
  std::vector<SelfPair> pairs;
  for (std::uint32_t i = a.first; i < a.last; ++i) {
    for (std::uint32_t k = std::max(i + 1, b.first); k < b.last; ++k) {
      if (!filter.allowed(shapes_[i].body, shapes_[k].body)) pairs.push_back({i, k, meshOf(i, k)});
    }
  }
  return pairs;
}

void RobotShapes::addSelfBlock(std::uint32_t first_cluster, std::uint32_t second_cluster,
                               const std::vector<SelfPair>& pairs) {
  const auto first = static_cast<std::uint32_t>(self_pairs_.size());
  self_pairs_.insert(self_pairs_.end(), pairs.begin(), pairs.end());
  self_blocks_.push_back({first_cluster, second_cluster, first, static_cast<std::uint32_t>(self_pairs_.size())});
}

/// Returns SelfPair::mesh of two shapes.
std::uint32_t RobotShapes::meshOf(std::uint32_t first, std::uint32_t second) const {
  const RobotShape &a = shapes_[first], &b = shapes_[second];
  if (!a.what->solid || !b.what->solid) return Structure::kNone;
  if (!a.clearance.exists()) return b.clearance.exists() ? second : Structure::kNone;
  return b.clearance.exists() && volume(b.in_group) > volume(a.in_group) ? second : first;
}

void RobotShapes::place(const std::vector<FourPoses>& groups, const GroupChange* changes, const Eigen::Vector3d& origin,
                        std::vector<FourShapes>& placed) const {
  for (std::size_t i = 0; i < shapes_.size();) {
    const std::uint32_t group = shapes_[i].group;
    if (changeOf(changes, group) == GroupChange::none) {
      ++i;
      continue;
    }
    const GroupFloats pose(groups[group], origin);
    for (; i < shapes_.size() && shapes_[i].group == group; ++i) {
      const TiltedBox<float>& local = shapes_[i].in_group;
      const bool is_straight = shapes_[i].is_straight;
      FourShapes& result = placed[i];
      result.box.is_ball = local.is_ball;
      float size = 0.0f;
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (local.is_ball) {  // any axes do; these make the axis-aligned box small
            result.box.axes[axis][k] = allFour(axis == k ? 1.0f : 0.0f);
          } else {
            result.box.axes[axis][k] = is_straight ? pose.turn[3 * k + axis] : pose.turned(local.axes[axis], k);
          }
        }
        result.box.center[k] = pose.turned(local.center, k) + pose.shift[k];
        result.box.half[k] = allFour(local.half[k]) + pose.rounding;
        size += std::abs(local.center[k]);
      }
      result.rounding = pose.rounding + allFour(size * (8.0f * kUnit));
      for (std::size_t k = 0; k < 3; ++k) {
        const Four reach = pose.rounding + reachAlong(result.box, k);
        result.bounds.min[k] = result.box.center[k] - reach;
        result.bounds.max[k] = result.box.center[k] + reach;
      }
    }
  }
}

void RobotShapes::boundClusters(const std::vector<FourShapes>& placed, std::vector<FourBounds>& bounds) const {
  for (std::size_t i = 0; i < clusters_.size(); ++i) {
    FourBounds all = placed[clusters_[i].first].bounds;
    for (std::size_t k = clusters_[i].first + 1; k < clusters_[i].last; ++k) all = around(all, placed[k].bounds);
    bounds[i] = all;
  }
}

}  // namespace hgrid
