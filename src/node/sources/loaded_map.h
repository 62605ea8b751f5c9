// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/maps/map_cells.h"
#include "node/params/params.h"
#include "node/time/clock_watch.h"

namespace hgrid {

/// A map that was read and can be put into the world.
struct LoadedMap {
  MapParams params;
  std::shared_ptr<const MapCells> cells;
  Time stamp{0};    // of the message; 0: it has none, or the map comes from a file
  Moment received;  // when the message came or the file was read
};

/// The cells that a sensor has seen lately, which can be put into the world.
struct LoadedCloud {
  std::string name;       // the body cloud/name
  double lifetime = 0.0;  // [s]
  double range = 0.0;     // [m] the sensor sees no farther; 0: no bound
  std::shared_ptr<const MapCells> cells;
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();  // [m, world] the origin of their keys
  Eigen::Vector3d sensor = Eigen::Vector3d::Zero();  // [m, world] where the sensor was at the newest message
  Time stamp{0};                                     // of the newest message
  double latency = 0.0;                              // [s] age of that message when it arrived
  std::chrono::steady_clock::time_point received{};
};

}  // namespace hgrid
