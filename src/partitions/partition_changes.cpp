// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The changes of Partition. Each one checks its arguments and reserves memory, which may throw. Then it writes the
// table and lets the structure follow, which cannot fail: in the worst case, the structure is stale.
#include <stdexcept>

#include "partitions/partition.h"

namespace hgrid {
namespace book {

/// Makes room in the table for a box with this id. May throw std::bad_alloc; the table is then unchanged.
void Partition::reserve(ProxyId id) {
  const std::size_t end = id + std::size_t{1};
  if (end <= stored_.size()) return;
  // Consecutive ids let the table grow by half of its size. A single large id gets no more than it needs.
  const std::size_t room = std::max(end, std::min(2 * stored_.size(), end + end / 2));
  boxes_.reserve(room);
  fixed_.reserve(room);
  stored_.reserve(room);
  auto fixed = std::lower_bound(fixed_ids_.begin(), fixed_ids_.end(), static_cast<ProxyId>(fixed_.size()));
  boxes_.resize(end);  // within the capacity, so nothing can fail from here on
  fixed_.resize(end, 0);
  stored_.resize(end, 0);
  // setFixed() may have named ids that only now are in the table.
  for (; fixed != fixed_ids_.end() && *fixed < end; ++fixed) fixed_[*fixed] = 1;
}

/// Calls `follow`, which changes the structure, and notes what the next search has to do.
template <class Follow>
void Partition::follow(Follow&& follow) noexcept {
  if (stale_) return;
  ++changes_;
  // After many changes, the structure is built again, so that its cells and the bounds of the world fit the boxes.
  if (changes_ > 4 * built_with_ + 64) {
    stale_ = true;
    return;
  }
  try {
    const Followed followed = follow();
    if (followed == Followed::no) stale_ = true;
    if (followed == Followed::settle) unsettled_ = true;
  } catch (...) {
    stale_ = true;  // out of memory: the structure may be half changed
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
  std::size_t changed = 0, kept = 0;  // number of boxes that are new or moved; of ids that are stored already
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const bool known = isStored(ids[i]);
    kept += known ? 1 : 0;
    changed += known && boxes_[ids[i]] == boxes[i] ? 0 : 1;
  }
  const bool same_ids = kept == ids.size() && kept == count_;
  const std::size_t gone = count_ - kept;
  // If most boxes change, building is faster. rebuildsWhenMostMove() makes an exception for boxes that only move.
  if (2 * (changed + gone) > ids.size() && (rebuildsWhenMostMove() || !same_ids)) stale_ = true;
  replaceAll(ids, boxes);
}

/// Stores exactly these boxes, one change after another. The arguments are valid and room is reserved.
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
  if (tracksPairs()) stale_ = true;  // mostTrackedPairs() depends on the bound
}

}  // namespace book
}  // namespace hgrid
