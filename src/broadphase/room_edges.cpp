// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/broadphase/room_edges.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hgrid {
namespace {

constexpr double kParallel = 1e-9;  // sine of the angle below which two walls, or a line and a wall, count as parallel
// [m] Shorter edges are left out. kWallRounding lengthens edges, so a corner of more than three walls may add short
// ones.
constexpr double kShortest = 1e-6;
constexpr double kWallRounding = 1e-6;  // [m] a point this far beyond a wall is still in the room

/// Returns all walls with normals of length 1: first those of the room, then the faces of the box.
std::vector<RoomWall> unitWalls(const Room& room, const Eigen::AlignedBox3d& within) {
  std::vector<RoomWall> walls;
  for (const RoomWall& wall : room.walls) {
    const double length = wall.normal.norm();
    walls.push_back({wall.normal / length, wall.offset / length});
  }
  for (int axis = 0; axis < 3; ++axis) {
    walls.push_back({Eigen::Vector3d::Unit(axis), within.max()[axis]});
    walls.push_back({-Eigen::Vector3d::Unit(axis), -within.min()[axis]});
  }
  return walls;
}

/// The part of the line `start` + t * `direction` from t = `low` to t = `high`.
struct LinePart {
  Eigen::Vector3d start, direction;
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();

  /// Cuts off what is beyond a wall.
  void cut(const RoomWall& wall) {
    const double rise = wall.normal.dot(direction), left = wall.offset + kWallRounding - wall.normal.dot(start);
    if (std::abs(rise) < kParallel) {
      if (left < 0.0) high = -std::numeric_limits<double>::infinity();
    } else if (rise > 0.0) {
      high = std::min(high, left / rise);
    } else {
      low = std::max(low, left / rise);
    }
  }
};

}  // namespace

/// The book has no edges of rooms; drawings and checks need them. Each two walls meet in a line. An edge is the part of
/// the line that no other wall cuts off.
std::vector<RoomEdge> edgesOf(const Room& room, const Eigen::AlignedBox3d& within) {
  const std::vector<RoomWall> walls = unitWalls(room, within);
  std::vector<RoomEdge> edges;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    for (std::size_t j = i + 1; j < walls.size(); ++j) {
      const Eigen::Vector3d cross = walls[i].normal.cross(walls[j].normal);
      const double length = cross.norm();
      if (length < kParallel) continue;
      LinePart line;
      // The point of the line that is nearest to the origin.
      line.start =
          (walls[i].offset * walls[j].normal - walls[j].offset * walls[i].normal).cross(cross) / (length * length);
      line.direction = cross / length;
      for (std::size_t k = 0; k < walls.size() && line.low < line.high; ++k) {
        if (k != i && k != j) line.cut(walls[k]);
      }
      if (!(line.high - line.low >= kShortest)) continue;  // also NaN: nothing is left
      edges.push_back({line.start + line.low * line.direction, line.start + line.high * line.direction});
    }
  }
  return edges;
}

Eigen::AlignedBox3d boundsOf(const Room& room, const Eigen::AlignedBox3d& within) {
  Eigen::AlignedBox3d around;
  for (const RoomEdge& edge : edgesOf(room, within)) around.extend(edge.from).extend(edge.to);
  return around;
}

}  // namespace hgrid
