// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>

#include "hgrid_proximity/adapters/octomap.h"
#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/health/ledger.h"
#include "node/params/params.h"
#include "node/sources/loaded_map.h"
#include "node/sources/self_shapes.h"
#include "node/wire/octomap_message.h"

namespace hgrid {

/// A map that was read. It still contains the cells of the robot itself.
struct ReadMap {
  MapParams params;
  Octomap octomap;
  Time stamp{0};    // stamp of the message; 0: it has no stamp, or the map was read from a file
  Moment received;  // when the message arrived or the file was read
};

/// Reads OctoMaps from the configured folder and from messages. Any thread may use it.
class MapSource {
 public:
  MapSource(const Params& params, const SelfShapes& self_shapes, std::shared_ptr<const NarrowPhase> narrow_phase,
            Ledger& ledger);

  /// Reads the file of a map.
  /// @throws Refusal bad_id if the file name has other characters than letters, digits, . _ -, resource_denied if no
  /// folder is configured or the file is outside of it, and as readOctomapFile()
  ReadMap read(const MapParams& map) const;
  /// Reads the map of a message.
  /// @throws Refusal truncated if a length in the message exceeds its bytes, and as readOctomapData()
  ReadMap read(const MapParams& map, const OctomapMessage& message) const;
  /// Builds the cells of a map. Leaves out the cells of the robot itself if ~map/self_filter is set.
  /// @throws Refusal not_ready if the pose of the robot is not known, limit if memory runs out
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
