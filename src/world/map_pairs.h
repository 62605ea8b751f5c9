// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "hgrid_proximity/world/snapshot.h"
#include "world/horizon.h"

namespace hgrid {

/// Finds the pairs of maps (or clouds) with bodies that have shapes. It compares each box with the occupied cells of
/// the map in the frame of the map, so a map can move without a new grid. Two maps make no pair.
///
/// The class stores gaps, so that the gap of a box and a map is not computed again while both rest.
class MapPairs {
 public:
  /// Receives a pair of bodies, its gap [m] and margin [m], and whether the gap is within the margin.
  using Add = std::function<void(std::uint32_t first, std::uint32_t second, double gap, double margin, bool near)>;
  /// Calls `add` for each shape and map that are near, or that may soon be near (see Horizon). A body with several
  /// shapes may cause several calls. The calls are sorted by the name of the map, then by the name of the body.
  /// @param most  maximum number of calls of `add`
  /// @returns whether it has reported all pairs
  bool find(const Snapshot& snapshot, const Horizon& horizon, std::size_t most, const Add& add);
  /// Returns whether find() with the same snapshot and no limit would report this pair. One of the two bodies must be a
  /// map. Ignores the pair filter.
  bool isNear(const Snapshot& snapshot, const Horizon& horizon, std::uint32_t first, std::uint32_t second);
  /// Accepts the tick of the last find(): the next find() compares with its poses. Allocates no memory.
  void accept();

 private:
  struct Gap {
    Aabb box;
    double up_to = -1.0;  // [m] the nearest cell was searched up to this distance; negative: not searched yet
    double gap = 0.0;     // [m] gap of the box and the nearest cell; infinite if no cell was found
  };
  struct OfMap {
    BodyId id;
    std::shared_ptr<const MapCells> cells;
    Pose world_from_map = Pose::Identity(), map_from_world = Pose::Identity();
    Pose map_from_world_last = Pose::Identity();  // map_from_world in the last accepted tick
    bool was_there = false;                       // whether the map had cells in the last accepted tick
    std::vector<Gap> gaps;                        // for each proxy: the last gap that was computed

    /// Returns the inverse pose of the map in the last accepted tick. If the map had no cells in that tick, returns the
    /// inverse pose in this tick.
    const Pose& mapFromWorldBefore() const { return was_there ? map_from_world_last : map_from_world; }
  };
  void renumber(const Structure& structure);
  void recall(const Snapshot& snapshot);
  bool passed(const OfMap& map, ProxyId proxy, const Snapshot& snapshot, const Horizon& horizon, double margin,
              double aside) const;
  bool addShapes(OfMap& map, std::uint32_t number, std::uint32_t body, const Snapshot& snapshot, const Horizon& horizon,
                 std::size_t& left, const Add& add) const;

  std::uint64_t revision_ = 0;
  std::vector<OfMap> maps_;  // in the order of Structure::maps
};

}  // namespace hgrid
