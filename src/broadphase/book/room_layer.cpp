// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/broadphase/room_layer.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace hgrid {
namespace {

/// Whether two ascending lists have a common number.
bool haveCommon(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
    if (a[i] == b[k]) return true;
    a[i] < b[k] ? ++i : ++k;
  }
  return false;
}

}  // namespace

RoomLayer::RoomLayer(Building building, std::unique_ptr<BroadPhase> below)
    : building_(std::move(building)), below_(std::move(below)) {
  setOverlapFilter({});
}

/// The overlap filter of the broad phase below: first the rooms, then the filter that was set.
std::size_t RoomLayer::keep(const void* layer, ProxyPair* pairs, std::size_t count) {
  const RoomLayer& self = *static_cast<const RoomLayer*>(layer);
  ProxyPair* end = pairs;
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<std::uint32_t>&a = self.boxes_[pairs[i].first].rooms, &b = self.boxes_[pairs[i].second].rooms;
    if (a.empty() || b.empty() || haveCommon(a, b)) *end++ = pairs[i];
  }
  return static_cast<std::size_t>(self.filter_(pairs, end) - pairs);
}

void RoomLayer::setOverlapFilter(const OverlapFilter& filter) {
  filter_ = filter;
  OverlapFilter with_rooms;
  with_rooms.keep = keep;
  with_rooms.context = this;
  below_->setOverlapFilter(with_rooms);
}

RoomLayer::Located RoomLayer::located(const Aabb& box) const {
  Located result{true, box, {}};
  building_.roomsOf(box, result.rooms);
  return result;
}

/// Returns one entry per given box. Only boxes that are new or moved are located. For the others, Located::stored is
/// false, and the caller keeps what it has. The arguments are not checked yet; the broad phase below checks them.
std::vector<RoomLayer::Located> RoomLayer::locatedMoved(const std::vector<ProxyId>& ids,
                                                        const std::vector<Aabb>& boxes) const {
  std::vector<Located> all(std::min(ids.size(), boxes.size()));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool rests = ids[i] < boxes_.size() && boxes_[ids[i]].stored && boxes_[ids[i]].box == boxes[i];
    if (!rests) all[i] = located(boxes[i]);
  }
  return all;
}

/// Makes room for a box with this id.
void RoomLayer::reserve(ProxyId id) {
  if (id >= boxes_.size()) boxes_.resize(id + std::size_t{1});
}

// Each change first does all that may throw: it computes the rooms, reserves memory and changes the broad phase below.
// Then it stores the rooms, which cannot fail. So a change that throws leaves all as it was.

void RoomLayer::insert(ProxyId id, const Aabb& box) {
  Located next = located(box);
  reserve(id);
  below_->insert(id, box);
  boxes_[id] = std::move(next);
}

void RoomLayer::update(ProxyId id, const Aabb& box) {
  Located next = located(box);
  below_->update(id, box);
  boxes_[id] = std::move(next);
}

void RoomLayer::remove(ProxyId id) {
  below_->remove(id);
  boxes_[id] = {};
}

void RoomLayer::clear() {
  below_->clear();
  for (Located& box : boxes_) box = {};
}

void RoomLayer::update(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) {
  std::vector<Located> next = locatedMoved(ids, boxes);
  if (std::is_sorted(ids.begin(), ids.end()) && !ids.empty()) reserve(ids.back());
  below_->update(ids, boxes);
  std::size_t i = 0;  // the ids ascend
  for (ProxyId id = 0; id < boxes_.size(); ++id) {
    if (i == ids.size() || ids[i] != id) {
      boxes_[id] = {};
      continue;
    }
    if (next[i].stored) boxes_[id] = std::move(next[i]);
    ++i;
  }
}

void RoomLayer::move(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) {
  std::vector<Located> next = locatedMoved(ids, boxes);
  below_->move(ids, boxes);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (next[i].stored) boxes_[ids[i]] = std::move(next[i]);
  }
}

const std::vector<std::uint32_t>& RoomLayer::roomsOf(ProxyId id) const {
  if (id >= boxes_.size() || !boxes_[id].stored)
    throw std::invalid_argument("RoomLayer: box " + std::to_string(id) + " is not stored; insert it first");
  return boxes_[id].rooms;
}

void RoomLayer::checkInvariants() const {
  below_->checkInvariants();
  std::size_t stored = 0;
  std::vector<std::uint32_t> rooms;
  for (const Located& box : boxes_) {
    if (!box.stored) continue;
    ++stored;
    building_.roomsOf(box.box, rooms);
    if (rooms != box.rooms)
      throw std::logic_error(
          "RoomLayer: this invariant is violated: the stored rooms of a box are those of the building");
  }
  if (stored != below_->size())
    throw std::logic_error("RoomLayer: this invariant is violated: each box of the broad phase below has an entry");
}

}  // namespace hgrid
