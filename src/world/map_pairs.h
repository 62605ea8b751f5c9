// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "hgrid_proximity/world/snapshot.h"
#include "world/horizon.h"

namespace hgrid {

/// Finds the pairs of maps with bodies that have shapes: each box is held against the map's occupied cells, in the
/// map's frame, so that a map that is moved need not be made anew. Two maps make no pair.
///
/// Remembers gaps: what stands still beside a map that stands still is not asked again.
class MapPairs {
 public:
  /// A pair, its gap and margin [m], and whether it is near or may soon be.
  using Add = std::function<void(std::uint32_t first, std::uint32_t second, double gap, double margin, bool near)>;
  /// Calls `add` for each shape and map that are near or, by the horizon, may soon be. So a pair of bodies may come
  /// several times. Maps come in the order of their names, with each the bodies in the order of theirs.
  /// @param most  calls of `add` at most
  /// @returns whether that was all
  bool find(const Snapshot& snapshot, const Horizon& horizon, std::size_t most, const Add& add);
  /// Whether find() with the same snapshot and no limit adds a pair, one of which is a map. The filter is not asked.
  bool isNear(const Snapshot& snapshot, const Horizon& horizon, std::uint32_t first, std::uint32_t second);
  /// Makes the tick of the last find() the last tick. Allocates nothing.
  void accept();

 private:
  struct Gap {
    Aabb box;
    double up_to = -1.0;  // [m] how far was looked
    double gap = 0.0;     // [m]
  };
  struct OfMap {
    std::shared_ptr<const MapCells> cells;
    Pose world_from_map = Pose::Identity(), map_from_world = Pose::Identity();
    Pose map_from_world_last = Pose::Identity();  // of the last tick
    bool was_there = false;                       // in the last tick, with cells
    std::vector<Gap> gaps;                        // by proxy

    /// Pose of the last tick; of this one if there were no cells then.
    const Pose& mapFromWorldBefore() const { return was_there ? map_from_world_last : map_from_world; }
  };
  void recall(const Snapshot& snapshot);
  bool passed(const OfMap& map, ProxyId proxy, const Snapshot& snapshot, const Horizon& horizon, double margin) const;
  bool addShapes(OfMap& map, std::uint32_t number, std::uint32_t body, const Snapshot& snapshot, const Horizon& horizon,
                 std::size_t& left, const Add& add) const;

  std::uint64_t revision_ = 0;
  std::vector<OfMap> maps_;  // of the structure
};

}  // namespace hgrid
