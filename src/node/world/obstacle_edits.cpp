// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/obstacle_edits.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "bodies/nearest_names.h"
#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

/// Notes that an obstacle has changed: its lifetime begins again, and it is neither lost nor only restored.
void renew(PlacedObstacle& obstacle, Time now) {
  obstacle.ends = endOf(*obstacle.what, now);
  obstacle.lost = false;
  obstacle.restored = false;
}

/// Returns whether the obstacle of a change belongs to the complete set of the request.
bool belongsToSet(const ObstacleChange& change) {
  using Kind = ObstacleChange::Kind;
  return change.kind == Kind::add || change.kind == Kind::append || (change.kind == Kind::attach && change.in_set);
}

/// Computes the edits of one request, change by change. Its functions throw as editsOf().
class ObstacleEditor {
 public:
  ObstacleEditor(const PlacedObstacles& present, const Surroundings& around, bool without_groups)
      : present_(present), around_(around), without_groups_(without_groups) {}

  void edit(const ObstacleChange& change);
  /// Removes the obstacles that a complete set lacks.
  /// @param owner         whose obstacles are removed; null: those of all owners
  /// @param complete_set  names of the obstacles that stay
  void removeOthers(const std::string* owner, const std::set<std::string>& complete_set, bool spare_attached);
  /// Checks that the obstacles of each group that changes move together.
  void checkGroups();
  ObstacleEdits result() && { return std::move(edits_); }

 private:
  using Groups = std::map<std::string, std::set<std::string>>;  // full names of the obstacles of each group

  const PlacedObstacle* find(const std::string& name) const;
  const PlacedObstacle& known(const std::string& name) const;
  PlacedObstacle added(const ObstacleChange& change) const;
  PlacedObstacle changed(const ObstacleChange& change) const;
  void remove(const std::string& name);
  void detachAll(const ObstacleChange& change);
  std::vector<std::string> chosen(const std::function<bool(const PlacedObstacle&)>& is_chosen) const;
  const std::set<std::string>& groupOf(const PlacedObstacle& obstacle);
  void checkGroup(const PlacedObstacle& added);
  void carryGroup(const PlacedObstacle& before, const PlacedObstacle& after);
  void regroup(const PlacedObstacle* before, const PlacedObstacle* after);

  const PlacedObstacles& present_;
  const Surroundings& around_;
  const bool without_groups_;  // ObstacleChanges::without_groups
  ObstacleEdits edits_;
  std::optional<Groups> groups_;  // all groups after the edits; nullopt: no change needed them yet
  std::size_t carried_ = 0;       // number of obstacles that moved with another one of their group
};

const PlacedObstacle* ObstacleEditor::find(const std::string& name) const {
  if (edits_.removed.count(name) != 0) return nullptr;
  const auto edit = edits_.set.find(name);
  if (edit != edits_.set.end()) return &edit->second;
  const auto found = present_.find(name);
  return found == present_.end() ? nullptr : &found->second;
}

const PlacedObstacle& ObstacleEditor::known(const std::string& name) const {
  const PlacedObstacle* found = find(name);
  if (found != nullptr) return *found;
  NameList names;
  for (const auto& entry : present_) {
    if (present_.size() <= kQuicklyCompared) names.push_back(&entry.first);
  }
  throw Refusal(Code::unknown_id, "there is no '" + printable(name) + "'; only an existing obstacle can be changed" +
                                      similarNames(name, names) + " (see ~bodies)");
}

/// Returns the obstacle that a change adds, or the present one if it is equal.
PlacedObstacle ObstacleEditor::added(const ObstacleChange& change) const {
  PlacedObstacle next;
  next.what = change.added;
  next.owner = change.added->owner;
  const PlacedObstacle* old = find(change.name);
  const bool is_same = old != nullptr && !old->attachment && isSame(*old->what, *next.what);
  // The transform for an old stamp may be forgotten, so a repeated request is not placed again.
  const bool is_repeated = is_same && isSame(old->asked, change.added->place);
  if (!is_repeated) put(next, change.added->place, around_);
  if (old == nullptr) return next;
  if (is_repeated || (is_same && isAtSamePlace(*old, next))) {
    next = *old;
    next.owner = change.added->owner;
  } else if (!change.replace) {
    throw Refusal(Code::dup_id, "'" + printable(change.name) +
                                    "' exists already, and is different, elsewhere or attached; remove it first, "
                                    "or set replace = true");
  }
  return next;
}

/// Returns the obstacle after a change.
PlacedObstacle ObstacleEditor::changed(const ObstacleChange& change) const {
  using Kind = ObstacleChange::Kind;
  const bool is_new = change.kind == Kind::add || (change.kind == Kind::append && find(change.name) == nullptr);
  PlacedObstacle next = is_new ? added(change) : known(change.name);
  if (change.kind == Kind::append && !is_new) append(next, *change.added, around_);
  if (change.kind == Kind::attach) attach(next, *change.attachment, around_);
  if (change.kind == Kind::detach) detach(next, around_);
  if (change.kind == Kind::move) {
    if (next.attachment) {
      throw Refusal(Code::conflict, "'" + printable(change.name) + "' is attached to '" +
                                        printable(next.attachment->link) +
                                        "'; detach it before you move it, or attach it again at another attach_pose");
    }
    if (!change.shape_poses.empty()) placeShapes(next, change.shape_poses);
    put(next, change.place, around_);
  }
  checkPlanes(next, around_.world_frame);
  renew(next, around_.now);
  return next;
}

/// Adds one change to the edits.
void ObstacleEditor::edit(const ObstacleChange& change) {
  using Kind = ObstacleChange::Kind;
  const PlacedObstacle* old = find(change.name);
  if (change.free_only && old != nullptr && old->attachment) {
    throw Refusal(Code::conflict, "'" + printable(change.name) + "' is attached to '" +
                                      printable(old->attachment->link) + "'; detach it first");
  }
  switch (change.kind) {
    case Kind::remove:
      known(change.name);
      return remove(change.name);
    case Kind::remove_all_free:
      for (const std::string& name : chosen([&](const PlacedObstacle& obstacle) {
             return !obstacle.attachment && obstacle.owner == change.owner;
           })) {
        remove(name);
      }
      return;
    case Kind::detach_all:
      return detachAll(change);
    case Kind::add:
    case Kind::append:
    case Kind::move:
    case Kind::attach:
    case Kind::detach:
      break;
  }
  PlacedObstacle next = changed(change);
  const bool is_placed_alone = change.kind == Kind::add || change.kind == Kind::append;
  if (!next.what->body.group.empty() && !without_groups_) {
    if (is_placed_alone) {
      checkGroup(next);
    } else {
      carryGroup(*old, next);
    }
  }
  if (groups_) regroup(find(change.name), &next);
  edits_.set.insert_or_assign(change.name, std::move(next));
  edits_.removed.erase(change.name);
}

void ObstacleEditor::remove(const std::string& name) {
  if (groups_) regroup(find(name), nullptr);
  edits_.removed.insert(name);
  edits_.set.erase(name);
}

/// Detaches the obstacles of Kind::detach_all, and with each of them those of its group.
void ObstacleEditor::detachAll(const ObstacleChange& change) {
  const auto is_chosen = [&](const PlacedObstacle& obstacle) {
    return obstacle.attachment && obstacle.attachment->owner == change.owner &&
           (change.link.empty() || isNameOfLink(change.link, obstacle.attachment->link));
  };
  for (const std::string& name : chosen(is_chosen)) {
    if (!find(name)->attachment) continue;  // it was detached with another one of its group
    ObstacleChange one;
    one.kind = ObstacleChange::Kind::detach;
    one.name = name;
    edit(one);
  }
}

/// Returns the names of the obstacles in the group of an obstacle, after the edits.
const std::set<std::string>& ObstacleEditor::groupOf(const PlacedObstacle& obstacle) {
  if (!groups_) {
    groups_.emplace();
    for (const std::string& name : chosen([](const PlacedObstacle& one) { return !one.what->body.group.empty(); })) {
      (*groups_)[find(name)->what->body.group].insert(name);
    }
  }
  return (*groups_)[obstacle.what->body.group];
}

/// Keeps groups_, which must exist, up to date when an obstacle is about to change. Null: there is no such obstacle.
void ObstacleEditor::regroup(const PlacedObstacle* before, const PlacedObstacle* after) {
  if (before != nullptr) (*groups_)[before->what->body.group].erase(before->what->body.name);
  if (after != nullptr) (*groups_)[after->what->body.group].insert(after->what->body.name);
}

/// @throws Refusal conflict if the obstacle would not move together with the others of its group
void ObstacleEditor::checkGroup(const PlacedObstacle& added) {
  for (const std::string& name : groupOf(added)) {
    if (name == added.what->body.name) continue;
    return checkMoveTogether(added, *find(name));  // the others move together with this one
  }
}

/// Lets the other obstacles of a group move with one of them.
/// @throws Refusal limit if the changes of a request move too many obstacles in this way, or as carry()
void ObstacleEditor::carryGroup(const PlacedObstacle& before, const PlacedObstacle& after) {
  const std::size_t most = 4 * static_cast<std::size_t>(around_.params.max_bodies);
  for (const std::string& name : groupOf(after)) {
    if (name == after.what->body.name) continue;
    if (++carried_ > most) {
      throw Refusal(Code::limit, "the changes would move more than " + std::to_string(most) +
                                     " obstacles with their groups (4 * ~limits/max_bodies); move each group only once");
    }
    PlacedObstacle next = *find(name);
    carry(next, before, after, around_);
    checkPlanes(next, around_.world_frame);
    renew(next, around_.now);
    edits_.set.insert_or_assign(name, std::move(next));
  }
}

/// Returns the names of the obstacles, after the edits, for which `is_chosen` returns true.
std::vector<std::string> ObstacleEditor::chosen(const std::function<bool(const PlacedObstacle&)>& is_chosen) const {
  std::vector<std::string> names;
  for (const auto& [name, obstacle] : present_) {
    if (edits_.removed.count(name) == 0 && edits_.set.count(name) == 0 && is_chosen(obstacle)) names.push_back(name);
  }
  for (const auto& [name, obstacle] : edits_.set) {
    if (is_chosen(obstacle)) names.push_back(name);
  }
  return names;
}

void ObstacleEditor::removeOthers(const std::string* owner, const std::set<std::string>& complete_set,
                                  bool spare_attached) {
  for (const auto& [name, obstacle] : present_) {
    if ((owner != nullptr && obstacle.owner != *owner) || complete_set.count(name) != 0) continue;
    const PlacedObstacle* next = find(name);
    if (spare_attached && next != nullptr && next->attachment) continue;
    remove(name);
  }
}

void ObstacleEditor::checkGroups() {
  for (const auto& [name, obstacle] : edits_.set) {
    if (!obstacle.what->body.group.empty()) checkGroup(obstacle);
  }
}

}  // namespace

ObstacleEdits editsOf(const ObstacleChanges& changes, const PlacedObstacles& present, const Surroundings& around) {
  ObstacleEditor editor(present, around, changes.without_groups);
  std::set<std::string> complete_set;
  for (std::size_t i = 0; i < changes.changes.size(); ++i) {
    const ObstacleChange& change = changes.changes[i];
    try {
      editor.edit(change);
      if (belongsToSet(change)) complete_set.insert(change.name);
    } catch (const Refusal& refusal) {
      throw ChangeRefusal(i, refusal);
    }
  }
  if (changes.complete_set_of) editor.removeOthers(&*changes.complete_set_of, complete_set, changes.spare_attached);
  if (changes.complete) editor.removeOthers(nullptr, complete_set, false);
  if (changes.without_groups) editor.checkGroups();
  return std::move(editor).result();
}

}  // namespace hgrid
