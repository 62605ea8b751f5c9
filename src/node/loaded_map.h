// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "hgrid_proximity/scene/body.h"
#include "hgrid_proximity/scene/map_cells.h"
#include "params.h"

namespace hgrid {

/// A map that was read, ready to be put into the world.
struct LoadedMap {
  MapParams params;
  std::shared_ptr<const MapCells> cells;
};

/// What a sensor has seen lately, ready to be put into the world.
struct LoadedCloud {
  std::string name;  // the body cloud/name
  double lifetime = 0.0;
  std::shared_ptr<const MapCells> cells;
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();  // [m, world] the origin of their keys
  Time stamp{0};                                     // of the newest message
  double latency = 0.0;                              // [s] how old that was when it came
  std::chrono::steady_clock::time_point received{};
};

}  // namespace hgrid
