// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>

#include "node/state/state_edit.h"

namespace hgrid {

/// A change that is not written yet.
struct WaitingChange {
  std::string key;                  ///< key of the edit
  std::function<StateEdit()> edit;  ///< makes the edit; its text may take long
  bool of_kind = false;             ///< whether it is an edit of StateEdit::Kind::erase_kind
};

/// Changes that wait until the disk takes them. A newer change of an item replaces the older one. So while a disk does
/// not answer, the memory is bounded by the number of items, however often they change.
class WaitingChanges {
 public:
  /// Adds a change that comes after all changes before. If this throws, the change was not added.
  void add(WaitingChange change) {
    auto& waiting = changes_[change.key];  // throws, if anything does
    waiting = std::move(change.edit);
    if (!change.of_kind) return;
    auto next = changes_.upper_bound(change.key);
    while (next != changes_.end() && next->first.compare(0, change.key.size(), change.key) == 0) {
      next = changes_.erase(next);
    }
  }
  bool empty() const { return changes_.empty(); }
  void clear() noexcept { changes_.clear(); }
  void swap(WaitingChanges& other) noexcept { changes_.swap(other.changes_); }

  /// Calls act(edit) for the edits, in an order that gives the same as the order in which they were added.
  template <class Act>
  void forEach(const Act& act) const {
    // The key of an erase_kind is the beginning of the keys of its items, so it sorts before them. They are newer.
    for (const auto& change : changes_) act(change.second());
  }

 private:
  std::map<std::string, std::function<StateEdit()>> changes_;  // by key
};

}  // namespace hgrid
