// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/states/fcl_states.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>

#include <stdexcept>

namespace hgrid {
namespace bench {
namespace {

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

Geometry geometryOf(const Shape& shape) {
  const std::vector<double> size = shape.dimensions();
  if (shape.kind() == ShapeKind::sphere) return std::make_shared<fcl::Sphered>(size[0]);
  if (shape.kind() == ShapeKind::box) return std::make_shared<fcl::Boxd>(size[0], size[1], size[2]);
  if (shape.kind() == ShapeKind::cylinder) return std::make_shared<fcl::Cylinderd>(size[1], size[0]);
  if (shape.kind() != ShapeKind::mesh) throw std::invalid_argument("FclStates: unexpected kind of shape");
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  model->beginModel();
  for (const auto& t : shape.mesh()->triangles) {
    const auto& vertices = shape.mesh()->vertices;
    model->addTriangle(vertices[t[0]], vertices[t[1]], vertices[t[2]]);
  }
  model->endModel();
  return model;
}

/// A shape of the robot or of the world. FCL's object points to it.
struct Placed {
  int link = -1;  // -1: a box of the world
  Eigen::Isometry3d link_from_shape = Eigen::Isometry3d::Identity();
  std::unique_ptr<fcl::CollisionObjectd> object;
};

Eigen::Isometry3d isometry(const Pose& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.matrix() = pose.matrix();
  return result;
}

}  // namespace

struct FclStates::State {
  State(const StateRobot& robot, const LinkMatrix& allowed) : model(robot.model), matrix(allowed) {}

  static bool touch(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
    State& self = *static_cast<State*>(data);
    const auto *first = static_cast<const Placed*>(a->getUserData()),
               *second = static_cast<const Placed*>(b->getUserData());
    if (first->link >= 0 && second->link >= 0 &&
        self.matrix.allowed(std::uint32_t(first->link), std::uint32_t(second->link))) {
      return false;
    }
    ++self.exact_tests;
    const fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    self.in_contact = fcl::collide(a, b, request, result) > 0;
    return self.in_contact;
  }

  void placeLink(std::size_t index) {
    const RobotLink& link = model.links[index];
    if (link.parent < 0) return;
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    const double position =
        joints[index] < 0 ? 0.0 : multipliers[index] * values[std::size_t(joints[index])] + offsets[index];
    if (link.joint_kind == JointKind::revolute) motion.linear() = Eigen::AngleAxisd(position, link.axis).matrix();
    if (link.joint_kind == JointKind::prismatic) motion.translation() = position * link.axis;
    poses[index] = poses[std::size_t(link.parent)] * origins[index] * motion;
  }
  void placeShape(Placed& shape) {
    shape.object->setTransform(poses[std::size_t(shape.link)] * shape.link_from_shape);
    shape.object->computeAABB();
  }

  const RobotModel& model;
  const LinkMatrix& matrix;
  std::vector<int> joints;                   // for each link: index of its variable; -1: it does not move
  std::vector<double> multipliers, offsets;  // of the variables
  std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>> origins, poses;
  std::vector<std::size_t> moving_links, columns;
  std::vector<double> values;
  std::vector<std::unique_ptr<Placed>> moving, resting;
  fcl::DynamicAABBTreeCollisionManagerd moving_tree, resting_tree, world_tree;
  bool in_contact = false;
  std::size_t exact_tests = 0;
};

FclStates::FclStates(const StateRobot& robot, const LinkMatrix& matrix, const std::vector<OrientedBox>& boxes,
                     const std::vector<double>& rest)
    : state_(std::make_unique<State>(robot, matrix)) {
  State& self = *state_;
  const Kinematics kinematics(robot.model);
  self.values = rest;
  for (const std::string& name : robot.group) self.columns.push_back(std::size_t(kinematics.find(name)));
  std::vector<bool> moves(robot.model.links.size());
  for (std::size_t i = 0; i < robot.model.links.size(); ++i) {
    const RobotLink& link = robot.model.links[i];
    const bool mimics = !link.mimic.empty();
    self.joints.push_back(kinematics.find(mimics ? link.mimic : link.joint));
    self.multipliers.push_back(mimics ? link.mimic_multiplier : 1.0);
    self.offsets.push_back(mimics ? link.mimic_offset : 0.0);
    self.origins.push_back(isometry(link.parent_from_joint));
    self.poses.push_back(Eigen::Isometry3d::Identity());
    self.placeLink(i);
    moves[i] = link.parent >= 0 && moves[std::size_t(link.parent)];
    for (const std::size_t column : self.columns) moves[i] = moves[i] || self.joints[i] == int(column);
    if (moves[i]) self.moving_links.push_back(i);
    for (const BodyShape& shape : link.shapes) {
      auto placed = std::make_unique<Placed>();
      placed->link = int(i);
      placed->link_from_shape = isometry(shape.body_from_shape);
      placed->object = std::make_unique<fcl::CollisionObjectd>(geometryOf(shape.shape));
      placed->object->setUserData(placed.get());
      self.placeShape(*placed);
      (moves[i] ? self.moving_tree : self.resting_tree).registerObject(placed->object.get());
      (moves[i] ? self.moving : self.resting).push_back(std::move(placed));
    }
  }
  for (const OrientedBox& box : boxes) {
    auto placed = std::make_unique<Placed>();
    placed->object = std::make_unique<fcl::CollisionObjectd>(
        std::make_shared<fcl::Boxd>(box.size.x(), box.size.y(), box.size.z()), isometry(box.world_from_box));
    placed->object->setUserData(placed.get());
    self.world_tree.registerObject(placed->object.get());
    self.resting.push_back(std::move(placed));
  }
  for (auto* tree : {&self.moving_tree, &self.resting_tree, &self.world_tree}) tree->setup();
}

FclStates::~FclStates() = default;

bool FclStates::isInContact(const double* state) {
  State& self = *state_;
  for (std::size_t i = 0; i < self.columns.size(); ++i) self.values[self.columns[i]] = state[i];
  for (const std::size_t link : self.moving_links) self.placeLink(link);
  for (const auto& shape : self.moving) self.placeShape(*shape);
  self.moving_tree.update();
  self.in_contact = false;
  self.moving_tree.collide(&self, State::touch);
  if (!self.in_contact) self.moving_tree.collide(&self.resting_tree, &self, State::touch);
  if (!self.in_contact) self.moving_tree.collide(&self.world_tree, &self, State::touch);
  return self.in_contact;
}

std::size_t FclStates::exactTests() const { return state_->exact_tests; }

}  // namespace bench
}  // namespace hgrid
