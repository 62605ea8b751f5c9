// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "node/moveit/scene_changes.h"
#include "node/moveit/scene_gaps.h"
#include "node/moveit/scene_queue.h"
#include "node/tick/change_world.h"
#include "node/wire/scene_types.h"

namespace hgrid {

/// A message of MoveIt that was read, and what became of it.
class ReadScene {
 public:
  /// Reads a message. If it is not valid, refused() says why.
  ReadScene(const ReceivedScene& scene, const SceneReader& reader);
  /// Reads the request of a service.
  ReadScene(const moveit::PlanningScene& scene, const SceneReader& reader);
  /// Takes the place of messages that were dropped, so that noteIn() notes a gap in the order of the messages.
  /// @param dropped   why they were dropped; its code is limit
  /// @param is_scene  whether one of them may have been a planning scene
  ReadScene(const Refusal& dropped, bool is_scene);

  /// Prepares applyTo() on the calling thread. See PrepareObstacles. @param newest  null: there is no tick yet
  std::shared_ptr<PreparedObstacles> prepare(const PrepareObstacles& prepare_obstacles, const Tick* newest) const;
  /// Applies the message to the world. If this fails, refused() says why. Only the tick thread may call this.
  /// @param prepared  result of prepare(); null: none
  void applyTo(World& world, Time now, PreparedObstacles* prepared = nullptr);
  /// Notes what the world lacks after applyTo(). Only the tick thread may call this.
  void noteIn(SceneGaps& gaps) const;

  /// Whether the message was applied, or will never be.
  bool isDone() const { return applied_ || (refused_ && refused_->code() != Code::not_ready); }
  /// Whether the world shows the changes.
  bool applied() const { return applied_; }
  /// Returns why the message could not be read or applied.
  const std::optional<Refusal>& refused() const { return refused_; }
  /// Whether this takes the place of dropped messages, so there is nothing to apply or to count.
  bool standsForDropped() const { return what_.empty(); }
  /// Returns a description of the message for error sentences.
  const std::string& what() const { return what_; }
  /// Returns the octomap of the message. Null: the message says nothing about it.
  const std::shared_ptr<const moveit::OctomapWithPose>& octomap() const { return octomap_; }
  /// Whether nobody knows if the message has an octomap, because it could not be read.
  bool hidesOctomap() const { return hides_octomap_; }
  /// Returns the same as unusedPartsOf().
  const std::vector<const char*>& unused() const { return unused_; }
  const ObstacleChanges& changes() const { return changes_; }

 private:
  template <class Message>
  void readAs(const ReceivedScene& scene, const SceneReader& reader);
  void noteObject(const moveit::CollisionObject& object);
  void noteAttached(const moveit::CollisionObject& object);
  void note(const moveit::CollisionObject& object, const SceneReader&) { noteObject(object); }
  void note(const moveit::AttachedCollisionObject& attached, const SceneReader&) { noteAttached(attached.object); }
  void note(const moveit::PlanningScene& scene, const SceneReader& reader);

  std::string what_;
  std::vector<SceneGaps::Object> placed_;    // objects that the message adds, moves or attaches
  std::vector<SceneGaps::Object> detached_;  // objects that it detaches
  std::vector<std::string> removed_;         // full names of the objects that it removes
  ObstacleChanges changes_;
  std::vector<const char*> unused_;
  std::optional<SceneExtras> extras_;  // nullopt: the message is no planning scene
  std::size_t most_paddings_ = 0;
  std::shared_ptr<const moveit::OctomapWithPose> octomap_;
  bool hides_octomap_ = false;
  bool applied_ = false;
  std::optional<Refusal> refused_;
};

}  // namespace hgrid
