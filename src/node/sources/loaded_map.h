// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>
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
  Time stamp{0};    // stamp of the message; 0: it has no stamp, or the map was read from a file
  Moment received;  // when the message arrived or the file was read
};

/// Maps that services loaded from a file or removed, by name. nullopt: removed.
using StoredMaps = std::map<std::string, std::optional<MapParams>>;

/// The recent cells of a cloud, which can be put into the world.
struct LoadedCloud {
  std::string name;       // its body is called cloud/<name>
  double lifetime = 0.0;  // [s] cells are removed if no point hits them for this long
  double range = 0.0;     // [m] largest distance at which the sensor sees; 0: not known
  std::shared_ptr<const MapCells> cells;
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();  // [m] origin of the keys of the cells, in the world frame
  Eigen::Vector3d sensor = Eigen::Vector3d::Zero();  // [m] sensor position at the newest message, in the world frame
  Time stamp{0};                                     // stamp of the newest message
  std::uint64_t too_near = 0;  // number of points of the newest message that are nearer than the sensor can see
  Time blind_stamp{0};         // stamp of the message that `too_near` and `blind` are from
  Sphere blind;                // [m, world frame] where these points may be
  double latency = 0.0;        // [s] age of the newest message when it arrived
  std::chrono::steady_clock::time_point received{};  // when the newest message arrived
};

}  // namespace hgrid
