// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The part of Scene::commit() that finds the rooms of the bodies.
#include <algorithm>

#include "world/scene_state.h"

namespace hgrid {

std::shared_ptr<const Building> buildingFrom(const std::shared_ptr<const Building>& world,
                                             const Eigen::Vector3d& origin) {
  if (!world || world->rooms().empty()) return nullptr;
  std::vector<Room> rooms = world->rooms();
  for (Room& room : rooms) {
    for (RoomWall& wall : room.walls) wall.offset -= wall.normal.dot(origin);
  }
  std::vector<Portal> portals = world->portals();
  for (Portal& portal : portals) portal.opening.translate(-origin);
  return std::make_shared<const Building>(std::move(rooms), std::move(portals));
}

/// Finds the rooms that a body is in. An empty list means that the body is anywhere, see BodyRooms.
void Scene::State::listRooms(const Snapshot& snapshot, std::uint32_t body) {
  body_rooms.clear();
  const std::uint32_t begin = structure->first_proxy[body], end = structure->first_proxy[body + 1];
  if (snapshot.poses_[body].state == Freshness::unplaced || structure->hasPlane(body)) return;
  const double can_be_away = snapshot.poses_[body].growth + horizon.reachOf(body);
  for (ProxyId proxy = begin; proxy < end; ++proxy) {
    const std::uint32_t position = position_of[proxy];
    building->roomsOf(grown(grown_from[position].box, can_be_away), box_rooms);
    if (box_rooms.empty()) return body_rooms.clear();
    body_rooms.insert(body_rooms.end(), box_rooms.begin(), box_rooms.end());
    // If the shortest way from one body to another one leads through a door, it is within the margin of one of them.
    for (const Portal& door : building->portals()) {
      if (door.opening.intersects(inDouble(grown_boxes[position])))
        body_rooms.insert(body_rooms.end(), door.rooms.begin(), door.rooms.end());
    }
  }
  std::sort(body_rooms.begin(), body_rooms.end());
  body_rooms.erase(std::unique(body_rooms.begin(), body_rooms.end()), body_rooms.end());
}

/// Whether this commit, or a failed one after the last accepted commit, grew a box of the body anew. If not, the rooms
/// of the body are the same.
bool Scene::State::isRegrown(const Snapshot& snapshot, std::uint32_t body) const {
  if (snapshot.poses_[body].state == Freshness::unplaced) return false;
  for (ProxyId proxy = structure->first_proxy[body]; proxy < structure->first_proxy[body + 1]; ++proxy) {
    if (!structure->isPlane(proxy) && grown_in[position_of[proxy]] > commits) return true;
  }
  return false;
}

/// Finds the rooms of the bodies whose grown boxes changed. Snapshots share the rooms until a body changes its rooms.
void Scene::State::findRooms(Snapshot& snapshot) {
  if (!building) return;
  const auto bodies = static_cast<std::uint32_t>(structure->bodies.size());
  const bool same_bodies = rooms && rooms_revision == structure->revision && rooms_unplaced == unplaced;
  std::shared_ptr<BodyRooms> next;
  if (!same_bodies) next = std::make_shared<BodyRooms>(building, bodies);
  const auto look = [&](std::uint32_t body) {
    listRooms(snapshot, body);
    if ((next ? *next : *rooms).has(body, body_rooms)) return;
    if (!next) next = std::make_shared<BodyRooms>(*rooms);
    next->set(body, body_rooms);
  };
  if (!same_bodies || horizon.on()) {
    for (std::uint32_t body = 0; body < bodies; ++body) {
      if (!same_bodies || isRegrown(snapshot, body)) look(body);
    }
  } else {
    for (const std::uint32_t slot : changes.now()) {
      const std::uint32_t body = body_of_slot[slot];
      if (body != Structure::kNone && isRegrown(snapshot, body)) look(body);
    }
  }
  if (next) rooms = std::move(next);
  rooms_revision = structure->revision;
  rooms_unplaced = unplaced;
  snapshot.rooms_ = rooms;
}

}  // namespace hgrid
