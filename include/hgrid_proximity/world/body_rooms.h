// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "hgrid_proximity/broadphase/rooms.h"

namespace hgrid {

/// The rooms that each body of a snapshot is in. Two bodies without a common room are separate: they make no pair.
///
/// A body is in each room that one of its boxes is in (see Building). Each box is grown by how far the body may be from
/// its pose: by the growth of an old pose, and by what the horizon adds. A body is also in both rooms of each portal
/// that one of its boxes reaches when it is grown by its share of the margins as well. A body is anywhere, which means
/// in all rooms, if one of its boxes is in no room, if it has no boxes, as a map, if it has a plane, or while it is
/// unplaced.
///
/// Any number of threads may read it.
class BodyRooms {
 public:
  /// Makes bodies that are all anywhere.
  BodyRooms(std::shared_ptr<const Building> building, std::size_t bodies);

  /// Returns the rooms and portals, relative to the same point as the boxes of the bodies.
  const Building& building() const { return *building_; }
  /// Returns whether two bodies have no room in common.
  bool areSeparate(std::uint32_t first, std::uint32_t second) const;
  /// Returns whether a body is anywhere, so that it is separate from no body.
  bool isAnywhere(std::uint32_t body) const;
  /// Returns the indices of the rooms of a body, ascending; all of them if the body is anywhere.
  std::vector<std::uint32_t> roomsOf(std::uint32_t body) const;
  /// Returns the memory [bytes] of this object without the building.
  std::size_t bytes() const { return sizeof(*this) + bits_.capacity() * sizeof(std::uint64_t); }

  /// Returns whether a body has exactly these rooms.
  /// @param rooms  indices, ascending; empty: the body is anywhere
  bool has(std::uint32_t body, const std::vector<std::uint32_t>& rooms) const;
  /// Sets the rooms of a body. @param rooms  as for has()
  void set(std::uint32_t body, const std::vector<std::uint32_t>& rooms);

 private:
  bool bit(std::uint32_t body, std::size_t room) const;

  std::shared_ptr<const Building> building_;
  std::size_t words_;                // number of words for a body
  std::vector<std::uint64_t> bits_;  // a bit for each room, and one that says "anywhere"; then all other bits are set
};

}  // namespace hgrid
