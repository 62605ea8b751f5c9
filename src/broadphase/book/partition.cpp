// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/book/partition.h"

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

// ---- changes: the table first, then the structure

/// Makes room in the table for a box with this id. Nothing else of a change can fail.
void Partition::reserve(ProxyId id) {
  const std::size_t end = id + std::size_t{1};
  if (end <= stored_.size()) return;
  const std::size_t room = std::max(end, std::min(2 * stored_.size(), end + end / 2));
  boxes_.reserve(room);
  fixed_.reserve(room);
  stored_.reserve(room);
  auto fixed = std::lower_bound(fixed_ids_.begin(), fixed_ids_.end(), static_cast<ProxyId>(fixed_.size()));
  boxes_.resize(end);  // allocates nothing any more
  fixed_.resize(end, 0);
  stored_.resize(end, 0);
  for (; fixed != fixed_ids_.end() && *fixed < end; ++fixed) fixed_[*fixed] = 1;
}

template <class Follow>
void Partition::follow(Follow&& follow) noexcept {
  if (stale_) return;
  ++changes_;
  // The structure is made again now and then: its cells should fit the boxes that are there now.
  if (changes_ > 4 * built_with_ + 64) {
    stale_ = true;
    return;
  }
  try {
    const Followed followed = follow();
    if (followed == Followed::no) stale_ = true;
    if (followed == Followed::settle) unsettled_ = true;
  } catch (...) {
    stale_ = true;  // out of memory: the structure may be half changed, so the next search builds it again
  }
}

void Partition::add(ProxyId id, const Aabb& box) noexcept {
  boxes_[id] = box;
  stored_[id] = 1;
  ++count_;
  world_.min = world_.min.cwiseMin(box.min);
  world_.max = world_.max.cwiseMax(box.max);
  follow([&] { return added(id); });
}

void Partition::erase(ProxyId id) noexcept {
  follow([&] { return removed(id, boxes_[id]); });
  stored_[id] = 0;
  --count_;
}

void Partition::shift(ProxyId id, const Aabb& box) noexcept {
  const Aabb from = boxes_[id];
  if (from == box) return;
  boxes_[id] = box;
  world_.min = world_.min.cwiseMin(box.min);
  world_.max = world_.max.cwiseMax(box.max);
  follow([&] { return moved(id, from); });
}

void Partition::insert(ProxyId id, const Aabb& box) {
  requireValid(box);
  if (isStored(id)) {
    throw std::invalid_argument(std::string(name_) + ": box " + std::to_string(id) +
                                " is already stored; change it with update()");
  }
  reserve(id);
  add(id, box);
}

void Partition::update(ProxyId id, const Aabb& box) {
  requireValid(box);
  requireStored(id);
  shift(id, box);
}

void Partition::remove(ProxyId id) {
  requireStored(id);
  erase(id);
}

void Partition::clear() {
  std::fill(stored_.begin(), stored_.end(), char{0});
  count_ = 0;
  stale_ = true;
}

void Partition::update(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) {
  requireBulk(ids, boxes);
  if (!ids.empty()) reserve(ids.back());
  std::size_t changed = 0, kept = 0;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const bool known = isStored(ids[i]);
    kept += known ? 1 : 0;
    changed += known && boxes_[ids[i]] == boxes[i] ? 0 : 1;
  }
  const bool same_ids = kept == ids.size() && kept == count_;
  const std::size_t gone = count_ - kept;
  if (2 * (changed + gone) > ids.size() && (rebuildsWhenMostMove() || !same_ids)) stale_ = true;
  replaceAll(ids, boxes);
}

/// Stores exactly these boxes, one change after another.
void Partition::replaceAll(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) noexcept {
  std::size_t next = 0;
  for (ProxyId id = 0; id < stored_.size(); ++id) {
    const bool wanted = next < ids.size() && ids[next] == id;
    if (!wanted) {
      if (stored_[id] != 0) erase(id);
      continue;
    }
    stored_[id] != 0 ? shift(id, boxes[next]) : add(id, boxes[next]);
    ++next;
  }
}

void Partition::move(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) {
  requireBulk(ids, boxes);
  for (const ProxyId id : ids) requireStored(id);
  if (2 * ids.size() > count_ && rebuildsWhenMostMove()) stale_ = true;
  for (std::size_t i = 0; i < ids.size(); ++i) shift(ids[i], boxes[i]);
}

void Partition::setFixed(const std::vector<ProxyId>& ids) {
  requireAscending(ids);
  if (ids == fixed_ids_) return;
  std::vector<ProxyId> next = ids;
  std::fill(fixed_.begin(), fixed_.end(), char{0});
  for (const ProxyId id : next) {
    if (id < fixed_.size()) fixed_[id] = 1;
  }
  fixed_ids_.swap(next);
  if (tracksPairs()) stale_ = true;
}

void Partition::setPairBound(const PairBound& bound) {
  bound_ = bound;
  if (tracksPairs()) stale_ = true;  // a partition that tracks pairs tracks no more than the bound needs
}

// ---- the structure, before a search

void Partition::prepare() const {
  if (!stale_ && !unsettled_) return;
  const std::lock_guard<std::mutex> lock(building_);
  Partition& self = const_cast<Partition&>(*this);  // the lock makes this thread the only one that changes it
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
  checkInvariants();
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
