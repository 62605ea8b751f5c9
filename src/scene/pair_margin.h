// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>

#include "hgrid_proximity/scene/snapshot.h"

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

/// [m] by how much that margin is wider since they are stale. Links of one robot that are equally old do not grow
/// against each other.
inline double widening(const Structure& structure, std::uint32_t first, Staleness a, std::uint32_t second,
                       Staleness b) {
  if (a.cohort != 0 && a.cohort == b.cohort) {
    const std::string &robot_a = structure.bodies[first].robot, &robot_b = structure.bodies[second].robot;
    if (!robot_a.empty() && robot_a == robot_b) return 0.0;
  }
  return a.growth + b.growth;
}

/// [m] the margin with what it is wider.
inline double pairMargin(const Structure& structure, std::uint32_t first, Staleness a, std::uint32_t second,
                         Staleness b) {
  return toldMargin(structure, first, second) + widening(structure, first, a, second, b);
}

}  // namespace hgrid
