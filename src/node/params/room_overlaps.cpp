// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/params/room_overlaps.h"

#include "hgrid_proximity/broadphase/room_edges.h"

namespace hgrid {
namespace {

constexpr std::size_t kMostNeighbors = 10000;  // largest number of pairs of rooms whose bounds overlap
constexpr double kThickness = 1e-3;            // [m] a thinner overlap is a wall
constexpr double kFarthestRoom = 2e6;          // [m] larger than any coordinate of a room that is not open

/// Returns the space that two rooms have in common.
/// @param inward  [m] by how much each wall is moved inward
Room commonSpace(const Room& a, const Room& b, double inward) {
  Room both{"", a.walls};
  both.walls.insert(both.walls.end(), b.walls.begin(), b.walls.end());
  for (RoomWall& wall : both.walls) wall.offset -= inward;
  return both;
}

}  // namespace

void addOverlaps(const std::vector<Room>& rooms, std::vector<Portal>& doors, std::vector<std::string>& errors) {
  const Eigen::Vector3d far = Eigen::Vector3d::Constant(kFarthestRoom),
                        rounding = Eigen::Vector3d::Constant(kDoorRounding);
  const Eigen::AlignedBox3d all_space(-far, far);
  std::vector<Eigen::AlignedBox3d> bounds;
  for (const Room& room : rooms) bounds.push_back(boundsOf(room, all_space));
  std::size_t neighbors = 0;
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    for (std::size_t k = i + 1; k < rooms.size(); ++k) {
      const Eigen::AlignedBox3d common = bounds[i].intersection(bounds[k]);
      if (!(common.sizes().minCoeff() > kThickness)) continue;
      if (++neighbors > kMostNeighbors) {
        errors.push_back("~rooms has more than " + std::to_string(kMostNeighbors) +
                         " pairs of rooms whose surrounding boxes overlap; divide the space into fewer rooms");
        return;
      }
      if (edgesOf(commonSpace(rooms[i], rooms[k], 0.5 * kThickness), all_space).empty()) continue;
      const Eigen::AlignedBox3d opening = boundsOf(commonSpace(rooms[i], rooms[k], 0.0), all_space);
      doors.push_back({{i, k}, {opening.min() - rounding, opening.max() + rounding}});
    }
  }
}

}  // namespace hgrid
