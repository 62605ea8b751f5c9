// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase_reader.h"

namespace hgrid {
namespace book {

/// Removes an id from a list that contains it once. The last id takes its place. Searches the list from its beginning.
inline void eraseUnordered(std::vector<ProxyId>& ids, ProxyId id) {
  *std::find(ids.begin(), ids.end(), id) = ids.back();
  ids.pop_back();
}

/// A set of ids in a dense array. A second array holds the index of each id, so adding and removing take constant time.
///
/// The grids use it for lists of special boxes, such as boxes that are too large for the cells.
class IdSet {
 public:
  void clear() {
    ids_.clear();
    place_.clear();
  }
  bool contains(ProxyId id) const { return id < place_.size() && place_[id] != kNone; }
  /// Adds an id, which must not be in the set.
  void add(ProxyId id) {
    if (id >= place_.size()) place_.resize(id + std::size_t{1}, kNone);
    ids_.push_back(id);
    place_[id] = static_cast<std::uint32_t>(ids_.size() - 1);
  }
  /// Removes an id, which must be in the set. The last id takes its place.
  void remove(ProxyId id) {
    const std::uint32_t place = place_[id];
    ids_[place] = ids_.back();
    place_[ids_[place]] = place;
    place_[id] = kNone;
    ids_.pop_back();
  }
  std::size_t size() const { return ids_.size(); }
  std::vector<ProxyId>::const_iterator begin() const { return ids_.begin(); }
  std::vector<ProxyId>::const_iterator end() const { return ids_.end(); }
  std::size_t bytes() const { return ids_.capacity() * sizeof(ProxyId) + place_.capacity() * sizeof(std::uint32_t); }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<ProxyId> ids_;
  std::vector<std::uint32_t> place_;  // for each id: its index in ids_; kNone: it is not in the set
};

}  // namespace book
}  // namespace hgrid
