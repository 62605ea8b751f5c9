// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <vector>

#include "hgrid_proximity/distances/pair_distance.h"

namespace hgrid {

/// A pair of shapes of two bodies.
struct ShapePair {
  double gap;                   ///< [m] distance of the boxes of the two shapes
  std::uint32_t first, second;  ///< index of each shape among the shapes of its body
};

/// The nearest shapes of two bodies, and how they lie relative to each other.
struct NearestShapes {
  std::uint32_t first = 0, second = 0;
  Proximity proximity;
  Contact contact;              ///< their contact; all NaN if they are apart
  std::vector<NearCell> cells;  ///< nearest cells, if one of the bodies is a map
};

/// Finds the nearest shapes of two bodies of a snapshot and measures their distance.
/// @param up_to        [m] a larger distance is returned as infinite
/// @param shape_pairs  a buffer, so that repeated calls allocate no memory
NearestShapes nearestShapes(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                            std::uint32_t second, double up_to, std::vector<ShapePair>& shape_pairs);

}  // namespace hgrid
