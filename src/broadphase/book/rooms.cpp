// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Cells and portals (Ericson, Real-Time Collision Detection, 2005, section 7.6).
#include "hgrid_proximity/broadphase/rooms.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

namespace hgrid {
namespace {

void require(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument("Building: " + what);
}

/// Whether a box may overlap a room: for no wall of the room is the whole box on the outer side.
bool mayBeIn(const Room& room, const Aabb& box) {
  for (const RoomWall& wall : room.walls) {
    // `least` is the smallest value of normal . p over all points p of the box; `rounding` bounds its terms.
    double least = 0.0, rounding = std::abs(wall.offset);
    for (int axis = 0; axis < 3; ++axis) {
      const double corner = wall.normal[axis] > 0.0 ? double(box.min[axis]) : double(box.max[axis]);
      least += wall.normal[axis] * corner;
      rounding += std::abs(wall.normal[axis] * corner);
    }
    if (least > wall.offset + 1e-14 * rounding) return false;
  }
  return true;
}

/// Whether two ascending lists have a common number.
bool haveCommon(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
    if (a[i] == b[k]) return true;
    a[i] < b[k] ? ++i : ++k;
  }
  return false;
}

}  // namespace

Room Room::ofBox(const std::string& name, const Eigen::AlignedBox3d& box) {
  Room room{name, {}};
  for (int axis = 0; axis < 3; ++axis) {
    room.walls.push_back({Eigen::Vector3d::Unit(axis), box.max()[axis]});
    room.walls.push_back({-Eigen::Vector3d::Unit(axis), -box.min()[axis]});
  }
  return room;
}

Building::Building(std::vector<Room> rooms, std::vector<Portal> portals)
    : rooms_(std::move(rooms)), portals_(std::move(portals)) {
  require(rooms_.size() <= kMostRooms, "there are " + std::to_string(rooms_.size()) + " rooms; at most " +
                                           std::to_string(kMostRooms) + " are allowed");
  std::set<std::string> names;
  for (const Room& room : rooms_) {
    require(names.insert(room.name).second, "two rooms have the name '" + room.name + "'; names must differ");
    require(!room.walls.empty(), "room '" + room.name + "' has no walls; give it at least one");
    for (const RoomWall& wall : room.walls) {
      require(wall.normal.allFinite() && std::isfinite(wall.offset) && wall.normal.squaredNorm() > 0.0,
              "a wall of room '" + room.name + "' is not finite or has the normal 0; correct it");
    }
  }
  for (std::size_t i = 0; i < portals_.size(); ++i) {
    const Portal& portal = portals_[i];
    const std::string which = "portal " + std::to_string(i);
    for (const std::size_t room : portal.rooms)
      require(room < rooms_.size(), which + " leads to room " + std::to_string(room) + ", which does not exist");
    require(portal.rooms[0] != portal.rooms[1], which + " leads from a room to itself; name two different rooms");
    const bool is_open = portal.opening.min().allFinite() && portal.opening.max().allFinite() &&
                         (portal.opening.min().array() <= portal.opening.max().array()).all();
    require(is_open, which + " has an opening with min > max or a coordinate that is not finite; correct it");
  }
}

void Building::roomsOf(const Aabb& box, std::vector<std::uint32_t>& found) const {
  found.clear();
  for (std::uint32_t room = 0; room < rooms_.size(); ++room) {
    if (mayBeIn(rooms_[room], box)) found.push_back(room);
  }
  for (const Portal& portal : portals_) {
    if (!portal.opening.intersects(inDouble(box))) continue;
    for (const std::size_t room : portal.rooms) found.push_back(static_cast<std::uint32_t>(room));
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

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
/// false, and the caller keeps what it has.
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

// Each change has three steps, so a change that throws leaves all as it was. It computes the rooms; it changes the
// broad phase below, which may throw; it stores the rooms, which cannot fail.

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
    if (rooms != box.rooms) throw std::logic_error("RoomLayer: this invariant is violated: a box has its rooms");
  }
  if (stored != below_->size()) throw std::logic_error("RoomLayer: this invariant is violated: each box has rooms");
}

}  // namespace hgrid
