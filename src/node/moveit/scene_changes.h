// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <vector>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/moveit/scene_types.h"
#include "node/params/params.h"
#include "node/sources/obstacle_change.h"

namespace hgrid {

/// Owner of the obstacles that messages of MoveIt add and attach.
inline constexpr const char* kSceneOwner = "moveit";

/// Returns the names of the parts of a planning scene that have an effect in MoveIt, but not in this node.
template <moveit::Release release>
std::vector<const char*> unusedPartsOf(const moveit::PlanningScene<release>& scene) {
  std::vector<const char*> parts;
  const auto differs = [](const std::vector<moveit::LinkNumber>& numbers, double usual) {
    return std::any_of(numbers.begin(), numbers.end(), [usual](const auto& number) { return number.value != usual; });
  };
  if (differs(scene.link_padding, 0.0)) parts.push_back("link_padding");
  if (differs(scene.link_scale, 1.0)) parts.push_back("link_scale");
  if (!scene.allowed_collision_matrix.entry_names.empty()) parts.push_back("allowed_collision_matrix");
  return parts;
}

/// Converts messages of MoveIt into changes of obstacles, as MoveIt's planning scene understands them. An object is
/// placed where its frame is at present, and stays there in the world. doc/moveit.md lists what is different.
///
/// All functions prepare the shapes for exact distances, which may take long. Nothing is compared with the world.
/// @throws ChangeRefusal or Refusal if the message is not valid; unsupported if an attached object has planes
class SceneReader {
 public:
  /// Both parameters must outlive this object.
  SceneReader(const Params& params, NarrowPhase& narrow_phase) : params_(params), narrow_phase_(narrow_phase) {}

  ObstacleChanges changesOf(const moveit::CollisionObjectFields& object) const;
  template <moveit::Release release>
  ObstacleChanges changesOf(const moveit::AttachedCollisionObject<release>& attached) const;
  template <moveit::Release release>
  ObstacleChanges changesOf(const moveit::PlanningScene<release>& scene) const;

 private:
  ObstacleChange added(const moveit::CollisionObjectFields& object, bool placed_now) const;
  void appendObject(const moveit::CollisionObjectFields& object, ObstacleChanges& changes) const;
  template <moveit::Release release>
  void appendAttached(const moveit::AttachedCollisionObject<release>& attached, ObstacleChanges& changes) const;

  const Params& params_;
  NarrowPhase& narrow_phase_;
};

}  // namespace hgrid
