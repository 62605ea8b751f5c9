// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// How stale a body is, as far as margins are concerned.
struct Staleness {
  double growth = 0.0;  ///< [m]
  std::uint32_t cohort = 0;
};

inline Staleness stalenessOf(const BodyPose& pose) { return {pose.growth, pose.cohort}; }

/// [m] margin of a pair of bodies that are not stale.
inline double toldMargin(const Structure& structure, std::uint32_t first, std::uint32_t second) {
  if (const auto own = structure.pair_margins.of(first, second)) return std::max(structure.least_margin, *own);
  return std::max(structure.margin[first], structure.margin[second]);
}

/// Whether two bodies are links of one robot that are equally old: they have not moved against each other.
inline bool movedTogether(const Structure& structure, std::uint32_t first, std::uint32_t cohort_of_first,
                          std::uint32_t second, std::uint32_t cohort_of_second) {
  if (cohort_of_first == 0 || cohort_of_first != cohort_of_second) return false;
  const std::string &robot_a = structure.bodies[first].robot, &robot_b = structure.bodies[second].robot;
  return !robot_a.empty() && robot_a == robot_b;
}

/// [m] By how much that margin is wider since the bodies are stale.
inline double widening(const Structure& structure, std::uint32_t first, Staleness a, std::uint32_t second,
                       Staleness b) {
  return movedTogether(structure, first, a.cohort, second, b.cohort) ? 0.0 : a.growth + b.growth;
}

/// [m] the margin with what it is wider.
inline double pairMargin(const Structure& structure, std::uint32_t first, Staleness a, std::uint32_t second,
                         Staleness b) {
  return toldMargin(structure, first, second) + widening(structure, first, a, second, b);
}

}  // namespace hgrid
