// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <vector>

#include "bench/maps/map.h"
#include "bench/maps/map_peer.h"
#include "hgrid_proximity/maps/static_grid.h"

namespace hgrid {
namespace bench {

/// What is asked of a map, in random order, each near some leaf: balls of radius 0.25 m about points up to 0.5 m from
/// it along each axis, and segments of 10 m in any direction from there.
struct MapQuestions {
  std::vector<Sphere> spheres;
  std::vector<Segment> segments;

  MapQuestions(const Map& map, std::size_t count);
  std::size_t size() const { return spheres.size(); }

  /// Their numbers in the order of the Morton curve, in cubes of 32 to 64 cells a side, by where they begin.
  std::vector<std::uint32_t> inMortonOrder(double resolution) const;
};

/// Which questions of a kind are compared: not those whose answer changes if the ball grows or shrinks by kDoubt, or
/// the segment is moved by as much to any side or along itself. For there the rounding of a peer may decide: OctoMap
/// casts rays in float.
class MapDoubts {
 public:
  static constexpr double kDoubt = 1e-5;  ///< [m]

  MapDoubts(const StaticGrid& grid, const MapQuestions& questions, MapQuestion kind);

  bool doubts(std::size_t question) const { return doubts_[question]; }
  std::size_t count() const { return count_; }

 private:
  std::vector<bool> doubts_;
  std::size_t count_ = 0;
};

}  // namespace bench
}  // namespace hgrid
