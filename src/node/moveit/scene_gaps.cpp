// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/moveit/scene_gaps.h"

#include <algorithm>
#include <iterator>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"
#include "node/world/world.h"

namespace hgrid {
namespace {

/// Length of the longest name that an obstacle can have. Longer names are not stored.
const std::size_t kLongestFullName = joined("obstacle", std::string(kLongestName, 'x')).size();

}  // namespace

void SceneGaps::noteRefused(const std::vector<Object>& objects, const std::string& why) {
  if (!objects.empty()) why_ = why;
  for (const Object& object : objects) {
    const auto known = lacks_.find(object.name);
    if (known != lacks_.end()) {
      known->second.lack = std::min(known->second.lack, object.lack);
      known->second.attached = known->second.attached || object.attached;
    } else if (object.name.empty() || object.name.size() > kLongestFullName || lacks_.size() >= kMostNames) {
      others_ = true;
    } else {
      lacks_.emplace(object.name, Gap{object.lack, object.attached});
    }
  }
}

void SceneGaps::noteApplied(const ObstacleChanges& changes) {
  for (const ObstacleChange& change : changes.changes) note(change);
  if (!changes.complete_set_of) return;
  eraseFreeShapes();
  if (changes.spare_attached) return;  // it says nothing about attached objects
  lacks_.clear();
  others_ = false;
}

void SceneGaps::noteDetached(const std::string& name) {
  const auto known = lacks_.find(name);
  if (known != lacks_.end()) known->second.attached = false;
}

void SceneGaps::note(const ObstacleChange& change) {
  using Kind = ObstacleChange::Kind;
  const auto known = lacks_.find(change.name);
  if (change.kind == Kind::remove_all_free) return eraseFreeShapes();
  if (known == lacks_.end()) return;
  switch (change.kind) {
    case Kind::add:
      if (!change.free_only) known->second.attached = false;
      return eraseFree(known);
    case Kind::remove:
      return eraseFree(known);
    case Kind::move:
      if (known->second.lack == Lack::place) eraseFree(known);
      return;
    case Kind::attach:
    case Kind::detach:
      if (known->second.lack == Lack::place) {
        lacks_.erase(known);
      } else {
        known->second.attached = change.kind == Kind::attach;
      }
      return;
    case Kind::append:
    case Kind::remove_all_free:
    case Kind::detach_all:
      return;
  }
}

/// Erases a gap, if there is one, unless it is of an attached object.
void SceneGaps::eraseFree(Gaps::iterator gap) {
  if (gap != lacks_.end() && !gap->second.attached) lacks_.erase(gap);
}

/// Erases the gaps of free objects whose shapes are missing.
void SceneGaps::eraseFreeShapes() {
  for (auto gap = lacks_.begin(); gap != lacks_.end();) {
    const auto next = std::next(gap);
    if (gap->second.lack == Lack::shapes) eraseFree(gap);
    gap = next;
  }
}

std::optional<std::string> SceneGaps::sentence() const {
  if (lacks_.empty() && !others_) return std::nullopt;
  const std::string count = others_ ? "" : std::to_string(lacks_.size()) + " ";
  const std::string of = lacks_.empty() ? "" : ", among them '" + printable(lacks_.begin()->first) + "',";
  return "REFUSED " + count + (lacks_.size() == 1 && !others_ ? "object" : "objects") + " of MoveIt" + of +
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
