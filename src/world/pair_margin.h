// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// The data of a body that determines how much the margins of its pairs grow.
struct Staleness {
  double growth = 0.0;       ///< [m] BodyPose::growth
  std::uint32_t cohort = 0;  ///< BodyPose::cohort
};

inline Staleness stalenessOf(const BodyPose& pose) { return {pose.growth, pose.cohort}; }

/// Returns the configured margin [m] of a pair: the margin that it has while both bodies are not stale.
inline double configuredMargin(const Structure& structure, std::uint32_t first, std::uint32_t second) {
  if (const auto own = structure.pair_margins.of(first, second)) return *own;
  return std::max(structure.margin[first], structure.margin[second]);
}

/// Returns whether two bodies are links of one robot with poses of the same age. The poses of such links fit together,
/// even if they are old. So their margins do not grow, which would report all links of a robot that is silent for a
/// moment. But its joints may have moved since; the robot is incomplete then (completeness.cpp).
inline bool movedTogether(const Structure& structure, std::uint32_t first, std::uint32_t cohort_of_first,
                          std::uint32_t second, std::uint32_t cohort_of_second) {
  if (cohort_of_first == 0 || cohort_of_first != cohort_of_second) return false;
  const std::string &robot_a = structure.bodies[first].robot, &robot_b = structure.bodies[second].robot;
  return !robot_a.empty() && robot_a == robot_b;
}

/// Returns by how much [m] the margin of a pair grows because its bodies are stale.
inline double widening(const Structure& structure, std::uint32_t first, Staleness a, std::uint32_t second,
                       Staleness b) {
  return movedTogether(structure, first, a.cohort, second, b.cohort) ? 0.0 : a.growth + b.growth;
}

/// Returns the margin [m] of a pair, including its growth.
inline double pairMargin(const Structure& structure, std::uint32_t first, Staleness a, std::uint32_t second,
                         Staleness b) {
  return configuredMargin(structure, first, second) + widening(structure, first, a, second, b);
}

}  // namespace hgrid
