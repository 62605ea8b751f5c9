// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/distances/pair_meter.h"

namespace hgrid {

/// How a map and another body lie to each other, told of the map's nearest cells.
struct MapProximity {
  std::uint32_t shape = 0;  ///< the body's nearest one
  Proximity proximity;      ///< of it and the nearest cell, first the one that stands first in the pair
  std::vector<NearCell> cells;
};

/// Measures the shapes of one body of a pair against the cells of the other, a map. Both must have poses.
/// @param up_to  [m] beyond this distance it is infinite
MapProximity measureMap(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                        std::uint32_t second, double up_to);

/// Places where the two are in contact, at most so many, in any order.
std::vector<PairContact> contactsWithMap(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                                         std::uint32_t second, std::size_t most);

}  // namespace hgrid
