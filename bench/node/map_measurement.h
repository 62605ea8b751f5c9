// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>

#include "measurement.h"

namespace hgrid {
namespace bench {

/// The same node in the same world, whose map stays as it is, or is replaced once a second.
struct MapMeasurement {
  Measurement resting, replaced;  ///< their parts have "query_sphere" and "query_segment" too
  std::size_t questions = 0;      ///< of each of the two
  std::size_t message_bytes = 0;
};

/// Starts a node with robots in a building, asks it 200 questions a second, and measures it for `duration` [s] with the
/// map at rest, as long with one that is replaced every second, and so on in turn, so that what else the machine does
/// meets both. Each map that was sent is seen to come into force.
///
/// The maps are prepared, the one process that sends, asks and listens shares the machine with the node: what it takes
/// stands in the measurements.
/// @throws std::runtime_error if the node does not serve the whole world within a minute, leaves a question without an
/// answer, or a map aside
MapMeasurement measureMaps(double duration);

}  // namespace bench
}  // namespace hgrid
