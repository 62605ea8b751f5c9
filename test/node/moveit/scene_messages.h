// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "src/node/moveit/scene_changes.h"
#include "test/node/world/obstacle_world.h"

namespace hgrid {
namespace test {

using moveit::CollisionObject;
using NoeticObject = moveit::CollisionObject;
using NoeticAttached = moveit::AttachedCollisionObject;
using NoeticScene = moveit::PlanningScene;

inline geometry_msgs::Pose poseAt(double x) {
  geometry_msgs::Pose pose;
  pose.position.x = x;
  pose.orientation.w = 1.0;
  return pose;
}

/// Returns a message with an operation, without shapes.
template <class Object = NoeticObject>
Object sceneObject(std::int8_t operation, const std::string& id) {
  Object object;
  object.operation = operation;
  object.id = id;
  return object;
}

template <class Object>
void appendSphere(Object& object, double x, double radius = 0.1) {
  shape_msgs::SolidPrimitive sphere;
  sphere.type = shape_msgs::SolidPrimitive::SPHERE;
  sphere.dimensions = {radius};
  object.primitives.push_back(sphere);
  object.primitive_poses.push_back(poseAt(x));
}

/// Returns a message that adds or appends a sphere in `frame`.
inline NoeticObject sceneSphere(std::int8_t operation, const std::string& id, double x, const std::string& frame = "") {
  NoeticObject object = sceneObject(operation, id);
  object.header.frame_id = frame;
  object.pose = poseAt(x);
  appendSphere(object, 0.0);
  return object;
}

inline NoeticObject sceneMove(const std::string& id, double x, const std::string& frame = "") {
  NoeticObject object = sceneObject(CollisionObject::MOVE, id);
  object.header.frame_id = frame;
  object.pose = poseAt(x);
  return object;
}

/// Returns a message that adds the plane a x + b y + c z + d = 0.
inline NoeticObject scenePlane(const std::string& id, const boost::array<double, 4>& coefficients) {
  NoeticObject object = sceneObject(CollisionObject::ADD, id);
  object.planes.resize(1);
  object.planes[0].coef = coefficients;
  return object;
}

inline NoeticAttached attachedTo(const std::string& link, const NoeticObject& object) {
  NoeticAttached attached;
  attached.link_name = link;
  attached.object = object;
  return attached;
}

/// A world with a moving robot (see Obstacles) that takes messages of MoveIt.
class SceneWorld : public Obstacles {
 protected:
  SceneWorld() : reader_(params(), *phase_) {}

  template <class Message>
  void take(const Message& message) {
    const ObstacleChanges changes = reader_.changesOf(message);
    prepares_ = !prepares_;
    std::shared_ptr<PreparedObstacles> prepared;
    if (prepares_) prepared = world_.prepareObstacles(changes, tick_, momentAt(time_).ros);
    world_.applyObstacles(changes, momentAt(time_).ros, prepared.get());
  }
  /// Returns the code with which a message is refused; nullopt if it is applied.
  template <class Message>
  std::optional<Code> refusedScene(const Message& message) {
    try {
      take(message);
    } catch (const Refusal& refusal) {
      return refusal.code();
    }
    return std::nullopt;
  }

  SceneReader reader_;
};

}  // namespace test
}  // namespace hgrid
