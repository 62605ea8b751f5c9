// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>

#include "hgrid_proximity/adapters/octomap.h"
#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/diagnostics/ledger.h"
#include "node/params/params.h"
#include "node/sources/loaded_map.h"
#include "node/sources/self_shapes.h"
#include "node/wire/octomap_message.h"

namespace hgrid {

/// A map that was read, with all its cells.
struct ReadMap {
  MapParams params;
  Octomap octomap;
  Time stamp{0};    // of the message; 0: a file
  Moment received;  // when the message came or the file was read
};

/// Reads OctoMaps from the configured folder and from messages. Any thread.
class MapSource {
 public:
  MapSource(const Params& params, const SelfShapes& self_shapes, std::shared_ptr<const NarrowPhase> narrow_phase,
            Ledger& ledger);

  /// @throws Refusal naming the map: bad_id (the file's name has other than letters, digits, . _ -), resource_denied
  /// (no folder is configured, or the file leads out of it), and as readOctomapFile()
  ReadMap read(const MapParams& map) const;
  /// Reads the map of a message. @throws Refusal naming the map: truncated (the message lies about its lengths), and
  /// as readOctomapData()
  ReadMap read(const MapParams& map, const OctomapMessage& message) const;
  /// Builds the cells of a map. Leaves out the robot's own if ~map/self_filter says so.
  /// @throws Refusal not_ready if it is not known where the robot was, limit if memory runs out
  LoadedMap finished(ReadMap map) const;

 private:
  OctomapOptions options() const;
  LoadedMap built(ReadMap&& map) const;

  const Params& params_;
  const SelfShapes& self_shapes_;
  std::shared_ptr<const NarrowPhase> narrow_phase_;
  Ledger& ledger_;
};

}  // namespace hgrid
