// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>

#include "hgrid_proximity/adapters/octomap.h"
#include "hgrid_proximity/narrowphase/narrow_phase.h"
#include "hgrid_proximity/scene/map_cells.h"
#include "octomap_message.h"
#include "params.h"

namespace hgrid {

/// A map that was read, ready to be put into the world.
struct LoadedMap {
  MapParams params;
  std::shared_ptr<const MapCells> cells;
};

/// Reads OctoMaps from the configured folder. Any thread.
class MapSource {
 public:
  MapSource(const Params& params, std::shared_ptr<const NarrowPhase> narrow_phase);

  /// @throws Refusal naming the map: bad_id (the file's name has other than letters, digits, . _ -), resource_denied
  /// (no folder is configured, or the file leads out of it), and as readOctomapFile()
  LoadedMap load(const MapParams& map) const;
  /// What a message says of a map. @throws Refusal naming the map: truncated (the message lies about its lengths), and
  /// as readOctomapData()
  LoadedMap load(const MapParams& map, const OctomapMessage& message) const;

 private:
  OctomapOptions options() const;
  std::shared_ptr<const MapCells> cellsOf(const Octomap& octomap) const;

  const Params& params_;
  std::shared_ptr<const NarrowPhase> narrow_phase_;
};

}  // namespace hgrid
