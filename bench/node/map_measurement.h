// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>

#include "measurement.h"

namespace hgrid {
namespace bench {

/// Measurements of one node in one world: while its map does not change, and while its map is replaced once per second.
struct MapMeasurement {
  Measurement resting, replaced;  ///< their parts also contain "query_sphere" and "query_segment"
  std::size_t questions = 0;      ///< number of queries sent while the map was replaced
  std::size_t message_bytes = 0;  ///< approximate size of one map message
};

/// Starts a node with robots in a building, sends it 200 queries per second, and measures it.
///
/// The node is measured for `duration` [s] while its map does not change. Then it is measured for the same time while
/// the map is replaced every second. Both are repeated in turn, so that other programs on the machine affect both
/// alike. The function checks that the node uses each map that was sent.
///
/// The maps are prepared in advance. This process sends the maps and the queries, and receives what the node publishes.
/// It shares the processors with the node. The measurements contain the processor time that this process used.
/// @throws std::runtime_error if the node does not know the whole world within a minute, does not answer a query, or
/// does not use a map
MapMeasurement measureMaps(double duration);

}  // namespace bench
}  // namespace hgrid
