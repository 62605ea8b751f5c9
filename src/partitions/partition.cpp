// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The checks, the table and the building of Partition. Its changes and searches have files of their own.
#include "partitions/partition.h"

#include <stdexcept>

namespace hgrid {
namespace book {

// ---- the checks of what callers pass

void Partition::requireValid(const Aabb& box) const {
  if (!isValid(box)) {
    throw std::invalid_argument(std::string(name_) +
                                ": a box has min > max or a coordinate that is not finite; correct it");
  }
}

void Partition::requireStored(ProxyId id) const {
  if (!isStored(id)) {
    throw std::invalid_argument(std::string(name_) + ": box " + std::to_string(id) + " is not stored; insert it first");
  }
}

void Partition::requireAscending(const std::vector<ProxyId>& ids) const {
  if (std::adjacent_find(ids.begin(), ids.end(), [](ProxyId a, ProxyId b) { return a >= b; }) != ids.end())
    throw std::invalid_argument(std::string(name_) + ": the ids do not ascend; sort them, and use each id once");
}

void Partition::requireBulk(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) const {
  if (ids.size() != boxes.size()) {
    throw std::invalid_argument(std::string(name_) + ": " + std::to_string(ids.size()) + " ids but " +
                                std::to_string(boxes.size()) + " boxes were given; each box needs one id");
  }
  requireAscending(ids);
  for (const Aabb& box : boxes) requireValid(box);
}

void Partition::require(bool holds, const char* invariant) const {
  if (!holds) throw std::logic_error(std::string(name_) + ": this invariant is violated: " + invariant);
}

// ---- the structure, before a search

void Partition::prepare() const {
  if (!stale_ && !unsettled_) return;
  const std::lock_guard<std::mutex> lock(building_);
  // The other searches wait for the lock, and no change runs during a search. So this thread may change the structure.
  Partition& self = const_cast<Partition&>(*this);
  if (stale_) {
    self.rebuild();
  } else if (unsettled_) {
    try {
      self.settle();
    } catch (...) {
      self.stale_ = true;
      throw;
    }
  }
  self.unsettled_ = false;
  self.stale_ = false;
}

/// Computes the exact bounds of the world and builds the structure.
void Partition::rebuild() {
  bool first = true;
  for (ProxyId id = 0; id < stored_.size(); ++id) {
    if (stored_[id] == 0) continue;
    world_.min = first ? boxes_[id].min : world_.min.cwiseMin(boxes_[id].min);
    world_.max = first ? boxes_[id].max : world_.max.cwiseMax(boxes_[id].max);
    first = false;
  }
  if (first) world_ = Aabb{};
  build();
  changes_ = 0;
  built_with_ = count_;
}

// ---- the table, for the partitions

std::size_t Partition::mostTrackedPairs() const {
  const std::size_t bound = std::min(bound_.overlaps, bound_.pairs);
  return bound < PairBound::kNone / 16 ? 8 * (bound + count_) : PairBound::kNone;
}

std::vector<ProxyId> Partition::storedIds() const {
  std::vector<ProxyId> ids;
  ids.reserve(count_);
  for (ProxyId id = 0; id < stored_.size(); ++id) {
    if (stored_[id] != 0) ids.push_back(id);
  }
  return ids;
}

std::vector<Aabb> Partition::storedBoxes() const {
  std::vector<Aabb> boxes;
  boxes.reserve(count_);
  for (ProxyId id = 0; id < stored_.size(); ++id) {
    if (stored_[id] != 0) boxes.push_back(boxes_[id]);
  }
  return boxes;
}

std::size_t Partition::bytes() const {
  prepare();
  return boxes_.capacity() * sizeof(Aabb) + stored_.capacity() + fixed_.capacity() +
         fixed_ids_.capacity() * sizeof(ProxyId) + structureBytes();
}

std::vector<Aabb> Partition::drawing() const {
  checkInvariants();  // also builds the structure
  std::vector<Aabb> regions;
  draw(regions);
  return regions;
}

void Partition::checkInvariants() const {
  prepare();
  std::size_t count = 0;
  for (ProxyId id = 0; id < stored_.size(); ++id) {
    if (stored_[id] == 0) continue;
    ++count;
    require(isValid(boxes_[id]), "each stored box is finite, with min <= max");
    require(
        (world_.min.array() <= boxes_[id].min.array()).all() && (boxes_[id].max.array() <= world_.max.array()).all(),
        "the bounds of the world contain each stored box");
  }
  require(count == count_, "size() is the number of stored boxes");
  checkStructure();
}

}  // namespace book
}  // namespace hgrid
