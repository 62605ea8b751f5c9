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

/// Questions about a map, each near a random leaf.
///
/// Spheres have a radius of 0.25 m; their centers are up to 0.5 m away from the middle of the leaf along each axis.
/// Segments start at the same points, have a random direction and are 10 m long.
struct MapQuestions {
  std::vector<Sphere> spheres;
  std::vector<Segment> segments;

  MapQuestions(const Map& map, std::size_t count);
  std::size_t size() const { return spheres.size(); }

  /// Returns the indices of the questions, sorted along the Morton curve by their start points. Within blocks of 32 to
  /// 64 cells per axis, the questions are not sorted.
  std::vector<std::uint32_t> inMortonOrder(double resolution) const;
};

/// Marks the questions whose answers are not compared, since rounding in a peer may decide them.
/// For example, OctoMap casts rays in float.
///
/// A question about a sphere is marked if its answer changes when the sphere grows or shrinks by kDoubt. A question
/// about a segment is marked if its answer changes when the segment moves sideways by kDoubt, or when one of its ends
/// moves by kDoubt along the segment.
class MapDoubts {
 public:
  static constexpr double kDoubt = 1e-5;  ///< [m] largest rounding error to expect

  MapDoubts(const StaticGrid& grid, const MapQuestions& questions, MapQuestion kind);

  /// Whether the answer to this question is not compared.
  bool doubts(std::size_t question) const { return doubts_[question]; }
  /// Number of questions whose answers are not compared.
  std::size_t count() const { return count_; }

 private:
  std::vector<bool> doubts_;
  std::size_t count_ = 0;
};

}  // namespace bench
}  // namespace hgrid
