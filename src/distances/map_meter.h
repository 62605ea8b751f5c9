// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/distances/pair_distance.h"

namespace hgrid {

/// How a map and another body lie relative to each other.
struct MapProximity {
  std::uint32_t shape = 0;      ///< index of the shape of the body that is nearest to the map
  Proximity proximity;          ///< proximity of this shape and the nearest cell; "first" is the first body of the pair
  Contact contact;              ///< their contact; all NaN if they are apart
  std::vector<NearCell> cells;  ///< the cells nearest to the body, nearest first
};

/// Measures the distance of a map and another body. One of the two bodies must be a map. Both must have poses.
/// @param up_to  [m] a larger distance is returned as infinite
MapProximity measureMap(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                        std::uint32_t second, double up_to);

/// Finds at most `most` contacts of a map and another body, in any order.
std::vector<PairContact> contactsWithMap(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                                         std::uint32_t second, std::size_t most);

}  // namespace hgrid
