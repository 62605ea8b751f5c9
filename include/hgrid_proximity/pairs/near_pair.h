// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <limits>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// Bits that say why a pair is selected although its gap exceeds its margin, or what is unusual about the pair.
enum PairFlags : std::uint8_t {
  kHorizonFlag = 1,   ///< the two bodies can meet within the horizon, or they passed each other since the last tick
  kTeleportFlag = 2,  ///< one of the bodies moved farther since the last tick than its max_speed allows
  kAssumedFlag = 4,   ///< NoContact::assumed
};

/// For how long two bodies do not meet.
struct NoContact {
  /// [s] NaN if the speed of one of the bodies is not limited; infinite if neither body can move.
  double before = std::numeric_limits<double>::quiet_NaN();
  /// Whether Body::max_speed limits the speed of a body that has no Body::speed_bound. Then the time is an expectation.
  /// Otherwise it is guaranteed.
  bool assumed = false;
};

/// A pair of bodies whose boxes are within their margin, or may soon be.
struct NearPair {
  std::uint32_t first = 0;   ///< index into Structure::bodies, first < second
  std::uint32_t second = 0;  ///< index into Structure::bodies
  double gap = 0.0;          ///< [m] least distance of their boxes
  double margin = 0.0;       ///< [m] margin that selected the pair, including the growth for stale bodies
  Time since{0};             ///< stamp of the tick that first selected the pair; every tick since then selected it
  std::uint8_t flags = 0;    ///< bits of PairFlags
};

}  // namespace hgrid
