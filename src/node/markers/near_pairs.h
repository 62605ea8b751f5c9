// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "node/tick/tick.h"

namespace hgrid {

/// A pair as the markers draw it.
struct DrawnPair {
  std::uint32_t first = 0, second = 0;  ///< indices into Structure::bodies
  Eigen::Vector3d on_first = Eigen::Vector3d::Zero(), on_second = Eigen::Vector3d::Zero();  ///< [m, world]
  double distance = 0.0;  ///< [m] a lower bound if the pair was not measured
  bool measured = false;  ///< whether the points and the distance are those of the shapes; false: of the boxes
  std::string status;     ///< what the measurement found, if not that the shapes are apart: "CONTACT"
};

/// The pairs of a tick that are near, as far as is known: their shapes are within their margin, or were not measured.
struct NearPairs {
  std::size_t count = 0;  ///< number of near pairs
  /// The near pairs to draw, at most 2,000: first those whose shapes were measured, then the others, each by distance.
  /// A pair with a map that was not measured is not drawn.
  std::vector<DrawnPair> drawn;
  /// For each body: how near it is to others. 0: at the margin; 1: in contact; nullopt: in no near pair. If a pair was
  /// not measured, its lower bound counts.
  std::vector<std::optional<double>> nearness;
};

/// @param distances  of the tick's snapshot; null: nothing was measured
NearPairs nearPairs(const Tick& tick, const PairDistances* distances);

}  // namespace hgrid
