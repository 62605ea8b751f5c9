// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <optional>

namespace hgrid {
namespace bench {

/// How long the node needs to check the paths of four Pandas again after an obstacle has moved.
struct GuardMeasurement {
  std::size_t moves = 0;  ///< number of moves of the obstacle
  double free_ms = 0.0;   ///< [ms] median time while all paths are free: from the tick that has the move to ~conflicts
  double conflict_ms = 0.0;  ///< [ms] the same while the obstacle is in the way of one arm
};

/// Measures ~conflicts: the arms follow paths of 10 s with a point every 0.1 s, and an obstacle moves into the way of
/// one of them and away again. Returns nullopt if the robot descriptions are not found (see realRobots()).
/// @param duration  [s] how long to measure
/// @throws std::runtime_error if the node does not answer, or if a verdict is not the one that the obstacle causes
std::optional<GuardMeasurement> measureGuard(double duration);

}  // namespace bench
}  // namespace hgrid
