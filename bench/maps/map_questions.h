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
/// Spheres have a radius of 0.25 m. Their centers are up to 0.5 m away from the middle of the leaf along each axis.
/// Segments start at the centers of the spheres, have a random direction and are 10 m long. Small spheres have a radius
/// of 0.03 to 0.15 m, and their centers are up to 0.6 m away from the middle of the leaf, in all directions.
struct MapQuestions {
  std::vector<Sphere> spheres, small;
  std::vector<Segment> segments;

  MapQuestions(const Map& map, std::size_t count);
  std::size_t size() const { return spheres.size(); }
  /// Returns the spheres of a kind of question.
  const std::vector<Sphere>& spheresOf(MapQuestion kind) const { return kind == MapQuestion::small ? small : spheres; }

  /// Returns the indices of the questions, sorted by the Morton codes of their start points. Questions whose start
  /// points lie in the same block of 32 to 64 cells per axis are not sorted.
  std::vector<std::uint32_t> inMortonOrder(double resolution) const;
};

/// Marks the questions whose answers are not compared because the rounding of a peer may decide them. For example,
/// OctoMap casts rays in float.
///
/// A question about a sphere is marked if its answer changes when the sphere grows or shrinks by kDoubt. A question
/// about a segment is marked if its answer changes when the segment moves sideways by kDoubt, or when one of its ends
/// moves by kDoubt along the segment.
class MapDoubts {
 public:
  static constexpr double kDoubt = 1e-5;  ///< [m] greatest rounding error that is expected

  MapDoubts(const StaticGrid& grid, const MapQuestions& questions, MapQuestion kind);

  /// Returns whether the answer to this question is not compared.
  bool doubts(std::size_t question) const { return doubts_[question]; }
  /// Returns the number of questions whose answers are not compared.
  std::size_t count() const { return count_; }

 private:
  std::vector<bool> doubts_;
  std::size_t count_ = 0;
};

}  // namespace bench
}  // namespace hgrid
