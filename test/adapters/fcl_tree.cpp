// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/adapters/fcl_tree.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/distance.h>

#include <map>

#include "test/adapters/fcl_witness.h"

namespace hgrid {
namespace test {

struct FclTree::State {
  struct Part {
    std::size_t body;
    Pose body_from_part;
    std::unique_ptr<fcl::CollisionObjectd> object;
  };
  std::vector<std::unique_ptr<Part>> parts;
  fcl::DynamicAABBTreeCollisionManagerd manager;
  std::size_t bodies = 0;
  bool set_up = false;
};

namespace {

struct Question {
  double bound;
  const std::function<bool(std::size_t, std::size_t)>& allowed;
  std::map<std::pair<std::size_t, std::size_t>, double> least;  // [m] least distance, by pair of bodies
};

bool onPair(fcl::CollisionObjectd* first, fcl::CollisionObjectd* second, void* data, double& distance) {
  Question& question = *static_cast<Question*>(data);
  distance = question.bound;  // the tree skips pairs that are farther apart
  const auto bodyOf = [](const fcl::CollisionObjectd& object) {
    return *static_cast<const std::size_t*>(object.getUserData());
  };
  const std::size_t a = bodyOf(*first), b = bodyOf(*second);
  if (a == b || question.allowed(a, b)) return false;
  double& least = question.least.emplace(std::minmax(a, b), question.bound).first->second;
  fcl::DistanceRequestd request;
  request.enable_nearest_points = true;
  request.distance_tolerance = 1e-10;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  fcl::DistanceResultd result;
  result.min_distance = least;
  fcl::distance(first, second, request, result);
  least = std::min(least, result.min_distance);
  return false;
}

}  // namespace

FclTree::FclTree() : state_(std::make_unique<State>()) {}
FclTree::~FclTree() = default;

void FclTree::add(const Body& body) {
  for (const BodyShape& shape : body.shapes) {
    auto part = std::make_unique<State::Part>();
    part->body = state_->bodies;
    part->body_from_part = shape.body_from_shape;
    part->object = std::make_unique<fcl::CollisionObjectd>(fclGeometry(shape.shape));
    part->object->setUserData(&part->body);
    state_->parts.push_back(std::move(part));
  }
  ++state_->bodies;
}

std::size_t FclTree::distances(const std::vector<Pose>& world_from_bodies, double bound,
                               const std::function<bool(std::size_t, std::size_t)>& allowed) {
  for (const auto& part : state_->parts) {
    part->object->setTransform(fcl::Transform3d((world_from_bodies[part->body] * part->body_from_part).matrix()));
    part->object->computeAABB();
  }
  if (!state_->set_up) {
    std::vector<fcl::CollisionObjectd*> objects;
    for (const auto& part : state_->parts) objects.push_back(part->object.get());
    state_->manager.registerObjects(objects);
    state_->manager.setup();
    state_->set_up = true;
  } else {
    state_->manager.update();
  }
  Question question{bound, allowed, {}};
  state_->manager.distance(&question, onPair);
  std::size_t near = 0;
  for (const auto& pair : question.least) near += pair.second < bound;
  return near;
}

}  // namespace test
}  // namespace hgrid
