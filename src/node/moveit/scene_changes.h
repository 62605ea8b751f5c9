// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/params/params.h"
#include "node/sources/obstacle_change.h"
#include "node/wire/scene_types.h"
#include "node/world/link_paddings.h"
#include "node/world/matrix_rules.h"

namespace hgrid {

/// Owner of the obstacles that messages of MoveIt add and attach.
inline constexpr const char* kSceneOwner = "moveit";

/// Returns the names of the parts of a planning scene that have an effect in MoveIt, but not in this node.
std::vector<const char*> unusedPartsOf(const moveit::PlanningScene& scene, const Params& params) {
  std::vector<const char*> parts;
  const auto is_scaled = [](const moveit::LinkNumber& scale) { return scale.value != 1.0; };
  if (std::any_of(scene.link_scale.begin(), scene.link_scale.end(), is_scaled)) parts.push_back("link_scale");
  const moveit::AllowedCollisionMatrix& matrix = scene.allowed_collision_matrix;
  const bool has_matrix = !matrix.entry_names.empty() || !matrix.default_entry_names.empty();
  if (has_matrix && !params.moveit_matrix) parts.push_back("allowed_collision_matrix");
  return parts;
}

/// What a planning scene says about robots and allowed pairs.
struct SceneExtras {
  bool complete = false;                          ///< whether `paddings` replaces all earlier paddings
  LinkPaddings paddings;                          ///< paddings of links; 0: the link has none any more
  std::optional<std::vector<MatrixRule>> matrix;  ///< the allowed collision matrix; nullopt: the earlier one stays
};

/// Returns the paddings after those of a planning scene.
/// @throws Refusal limit if there would be more than `most`
LinkPaddings paddingsAfter(const SceneExtras& extras, const LinkPaddings& before, std::size_t most);

/// Converts messages of MoveIt into changes of obstacles, as MoveIt's planning scene understands them. An object is
/// placed where its frame is at present, and stays there in the world. doc/moveit.md lists what is different.
///
/// All functions prepare the shapes for exact distances, which may take long. Nothing is compared with the world.
/// @throws ChangeRefusal or Refusal if the message is not valid; unsupported if an attached object has planes
class SceneReader {
 public:
  /// Both parameters must outlive this object.
  SceneReader(const Params& params, NarrowPhase& narrow_phase) : params_(params), narrow_phase_(narrow_phase) {}

  ObstacleChanges changesOf(const moveit::CollisionObject& object) const;
  ObstacleChanges changesOf(const moveit::AttachedCollisionObject& attached) const;
  ObstacleChanges changesOf(const moveit::PlanningScene& scene) const;
  /// Returns what a planning scene says about robots and allowed pairs.
  /// @throws Refusal for a name, a padding or a matrix that is not valid, see also matrixRulesOf()
  SceneExtras extrasOf(const moveit::PlanningScene& scene) const;
  const Params& params() const { return params_; }

 private:
  ObstacleChange added(const moveit::CollisionObject& object, bool placed_now) const;
  void appendObject(const moveit::CollisionObject& object, ObstacleChanges& changes) const;
  void appendAttached(const moveit::AttachedCollisionObject& attached, ObstacleChanges& changes) const;

  const Params& params_;
  NarrowPhase& narrow_phase_;
};

}  // namespace hgrid
