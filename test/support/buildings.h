// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>

#include "hgrid_proximity/broadphase/rooms.h"

namespace hgrid {
namespace test {

inline Eigen::AlignedBox3d block(double x0, double y0, double z0, double x1, double y1, double z1) {
  return {Eigen::Vector3d(x0, y0, z0), Eigen::Vector3d(x1, y1, z1)};
}

/// Returns two rooms, "west" and "east", from y = -4 to 4 and z = -4 to 4. The wall between them is from x = -0.25 to
/// 0.25 [m]. It has a door from y = -0.5 to 0.5 and z = -1 to 1.
inline std::shared_ptr<const Building> twoRooms() {
  const std::vector<Room> rooms = {Room::ofBox("west", block(-8, -4, -4, -0.25, 4, 4)),
                                   Room::ofBox("east", block(0.25, -4, -4, 8, 4, 4))};
  return std::make_shared<const Building>(rooms,
                                          std::vector<Portal>{{{0, 1}, block(-0.25, -0.5, -1.0, 0.25, 0.5, 1.0)}});
}

}  // namespace test
}  // namespace hgrid
