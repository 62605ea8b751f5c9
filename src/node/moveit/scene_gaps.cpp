// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/moveit/scene_gaps.h"

#include <algorithm>
#include <iterator>

#include "hgrid_proximity/refusal.h"
#include "node/world/world.h"

namespace hgrid {

void SceneGaps::noteRefused(const std::vector<Object>& objects, const std::string& why) {
  if (!objects.empty()) why_ = why;
  for (const Object& object : objects) {
    const auto known = lacks_.find(object.name);
    if (known != lacks_.end()) {
      known->second = std::min(known->second, object.lack);
    } else if (object.name.empty() || lacks_.size() >= kMostNames) {
      others_ = true;
    } else {
      lacks_.emplace(object.name, object.lack);
    }
  }
}

void SceneGaps::noteApplied(const ObstacleChanges& changes) {
  for (const ObstacleChange& change : changes.changes) note(change);
  if (!changes.complete_set_of) return;
  eraseAll(Lack::shapes);
  if (!changes.spare_attached) eraseAll(Lack::place);
  others_ = false;
}

void SceneGaps::note(const ObstacleChange& change) {
  using Kind = ObstacleChange::Kind;
  const auto known = lacks_.find(change.name);
  switch (change.kind) {
    case Kind::add:
    case Kind::remove:
      lacks_.erase(change.name);
      return;
    case Kind::move:
    case Kind::attach:
    case Kind::detach:
      if (known != lacks_.end() && known->second == Lack::place) lacks_.erase(known);
      return;
    case Kind::remove_all_free:
      eraseAll(Lack::shapes);
      return;
    case Kind::append:
    case Kind::detach_all:
      return;
  }
}

void SceneGaps::eraseAll(Lack lack) {
  for (auto one = lacks_.begin(); one != lacks_.end();) one = one->second == lack ? lacks_.erase(one) : std::next(one);
}

std::optional<std::string> SceneGaps::sentence() const {
  if (lacks_.empty() && !others_) return std::nullopt;
  const std::string count = others_ ? "" : std::to_string(lacks_.size()) + " ";
  const std::string of = lacks_.empty() ? "" : ", among them '" + printable(lacks_.begin()->first) + "',";
  return "REFUSED " + count + "objects of MoveIt" + of +
         " may be missing or at a wrong place, because messages about them could not be used (the newest: " + why_ +
         "); send each of them again, or a complete planning scene (is_diff: false)";
}

void showGaps(const SceneGaps& gaps, World& world) {
  static const SourceId source = SourceId::ofObstacles("moveit");
  if (const auto sentence = gaps.sentence()) {
    world.setMissing(source, *sentence);
  } else {
    world.clearMissing(source);
  }
}

}  // namespace hgrid
